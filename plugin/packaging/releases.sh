# Which packages Palpate needs, by Debian release. Sourced by plugin/run.
# shellcheck shell=bash disable=SC2034

# system_name: "debian 12" and the like, from /etc/os-release.
system_name() {
  local system="unknown"
  # shellcheck disable=SC1091
  [ -r /etc/os-release ] && system=$(. /etc/os-release; printf '%s %s' "${ID:-unknown}" "${VERSION_ID:-}")
  printf '%s' "$system"
}

# `demo` and `build` need the first list alone; the core builds and passes its tests without ParaView and Qt.
core_packages=(g++ cmake ninja-build pkg-config ccache
  libglm-dev libdcmtk-dev libopenjp2-7-dev libcharls-dev libopencv-core-dev libopencv-imgproc-dev libopencv-photo-dev libeigen3-dev
  libcli11-dev nlohmann-json3-dev libfmt-dev libhdf5-dev libcairo2-dev fonts-dejavu-core libarchive-dev libpugixml-dev libxxhash-dev libpolyclipping-dev zlib1g-dev
  libusb-1.0-0-dev libhidapi-dev libsystemd-dev libboost-dev libssl-dev)
test_packages=(python3 git locales libgtest-dev libgmock-dev libbenchmark-dev libnlopt-dev libnlopt-cxx-dev umockdev dbus-daemon
  orthanc dcmtk dicom3tools openssl libopenigtlink-dev openigtlink-examples python3-pydicom python3-nibabel)
paraview_packages=(paraview paraview-dev python3-paraview libopenmpi-dev libglew-dev libfreetype-dev)
gui_test_packages=(xvfb xauth libgl1-mesa-dri xdotool imagemagick)
guest_packages=(qemu-system-x86 busybox-static cpio) # boot a guest; its kernel is downloaded, never installed
data_packages=(invesalius-examples) # GPL-2, a real head: converted at run time, never copied into the project
packaging_packages=(dpkg-dev fakeroot lintian python3 desktop-file-utils appstream mmdebstrap)
image_packages=(mmdebstrap buildah)
docs_packages=(doxygen)

# clang-format and clang-tidy: one version for all releases, since each version has findings of its own. Debian 13 does not have
# it: there the two stages say so, and check nothing.
style=14

known_system=yes
case "$(system_name)" in
  "debian 12"*)
    clang=14
    other_release=trixie
    test_packages+=("clang-tidy-$style" "clang-format-$style" plastimatch) # plastimatch: reads and writes volumes by ITK, to compare
    paraview_packages+=(qtbase5-dev libqt5svg5-dev qttools5-dev qttools5-dev-tools libqt5opengl5-dev) ;;
  "debian 13"*)
    clang=19
    other_release=bookworm
    core_packages+=(libtiff-dev) # DCMTK's CMake package names it
    paraview_packages+=(qt6-svg-plugins qt6-base-dev qt6-svg-dev qt6-tools-dev qt6-l10n-tools qt6-5compat-dev libdouble-conversion-dev python3-dev) ;;
  *)
    known_system=no
    clang=14 ;;
esac
test_packages+=("clang-$clang" "libclang-rt-$clang-dev")
fuzz_packages=("clang-$clang" "libclang-rt-$clang-dev" "llvm-$clang" dpkg-dev gpgv dcmtk)
