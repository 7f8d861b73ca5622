#!/usr/bin/env bash
# Makes the Debian packages of the release that this runs on: plugin/packaging/package.sh [FOLDER] (default build-package/deb).
# The same commit and the same installed libraries give the same bytes. Called by `plugin/run package`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. plugin/packaging/releases.sh
tree=$PWD/${PALPATE_PACKAGE_BUILD:-build-package}
out=$(realpath -m "${1:-$tree/deb}")

commit=$(git rev-parse --short=10 HEAD)
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH TZ=UTC0
day=$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)
architecture=$(dpkg --print-architecture)
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
maintainer="The Palpate developers <palpate@users.noreply.github.com>"

umask 022
cmake -S . -B "$tree" -Wno-dev -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=g++ -DCMAKE_INSTALL_PREFIX=/usr -DPALPATE_TESTS=OFF \
  -DPALPATE_PARAVIEW=ON -DPALPATE_WERROR="${PALPATE_WERROR:-OFF}" -DCMAKE_CXX_FLAGS= \
  -DCMAKE_EXE_LINKER_FLAGS="-Wl,-z,relro,-z,now" -DCMAKE_MODULE_LINKER_FLAGS="-Wl,-z,relro,-z,now" \
  -DCMAKE_SHARED_LINKER_FLAGS="-Wl,-z,relro,-z,now" >/dev/null
cmake --build "$tree" -- --quiet
export LC_ALL=C.UTF-8 # now: ccache would take it for another compilation
version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$tree/CMakeCache.txt")
# shellcheck disable=SC1091
suffix=$(. /etc/os-release; echo "deb$VERSION_ID")
full=$version+$suffix

work=$tree/packages
rm -rf "$work" "$out"
mkdir -p "$work" "$out"
DESTDIR=$work/all cmake --install "$tree" --strip >/dev/null

# move PACKAGE PATH...: from what is installed into a package's tree.
move() {
  local package=$1 path
  shift
  for path in "$@"; do
    mkdir -p "$work/$package/$(dirname "$path")"
    mv "$work/all/$path" "$work/$package/$path"
  done
}
lib=usr/lib/$triplet
rm -f "$work/all/$lib"/libPalpateServerCS.a # ParaView's Python wrapping at build time alone
find "$work/all" -name '*-hierarchy.txt' -delete
find "$work/all" -depth -type d -empty -delete
move libpalpate-dev usr/include $lib/cmake
for archive in "$work/all/$lib"/*.a; do
  strip --strip-debug --enable-deterministic-archives "$archive"
  move libpalpate-dev "$lib/$(basename "$archive")"
done
plugins=$(cd "$work/all" && ls -d $lib/paraview-*/plugins)
move palpate-paraview "$plugins"
move palpate usr/bin usr/libexec usr/share/palpate
find "$work/all" -depth -type d -empty -delete
[ ! -e "$work/all" ] || { echo "package.sh: no package takes:" >&2; find "$work/all" -type f >&2; exit 1; }

# The program: udev's rules where udev reads them, pages and completions from --help.
root=$work/palpate
install -D -m 644 "$root/usr/share/palpate/60-palpate.rules" "$root/usr/lib/udev/rules.d/60-palpate.rules"
ln -sf ../../lib/udev/rules.d/60-palpate.rules "$root/usr/share/palpate/60-palpate.rules"
sed -i '/^# Install: /d' "$root/usr/lib/udev/rules.d/60-palpate.rules"
mkdir -p "$work/bin"
ln -sf "$tree"/bin/palpate* "$work/bin/"
python3 plugin/packaging/help_pages.py "$work/bin" "$version" "$day" "$work/pages"
rm -f "$work"/pages/man/palpate-bench* "$work"/pages/*/*palpate-bench # a program of developers
mkdir -p "$root/usr/share/man/man1"
install -m 644 "$work"/pages/man/*.1 "$root/usr/share/man/man1/"
install -D -m 644 -t "$root/usr/share/bash-completion/completions" "$work"/pages/bash/*
install -D -m 644 -t "$root/usr/share/zsh/vendor-completions" "$work"/pages/zsh/*
gzip -9n "$root"/usr/share/man/man1/*

# The plug-in: named in a file that Debian's ParaView reads at its start, so that nobody sets anything up.
root=$work/palpate-paraview
xml=$(cd "$root" && ls usr/lib/*/paraview-*/plugins/palpate.xml)
paraview=$(basename "$(dirname "$(dirname "$xml")")")
case "$paraview" in
  paraview-5.11) # a list of such files, which it looks for beside the program; Debian 12 has none
    mkdir -p "$root/usr/bin"
    realpath -m --relative-to=/usr/bin "/$xml" >"$root/usr/bin/paraview.conf" ;;
  *) # Debian 13 has that list; it names this file, which no package of Debian has, for others
    mkdir -p "$root/usr/share/paraview"
    sed -E "s,name=\"([A-Za-z]+)\",name=\"\1\" filename=\"/$(dirname "$xml")/\1/\1.so\"," "$root/$xml" >"$root/usr/share/paraview/plugins" ;;
esac
install -D -m 644 plugin/packaging/palpate.desktop "$root/usr/share/applications/palpate.desktop"
install -D -m 644 plugin/packaging/palpate.svg "$root/usr/share/icons/hicolor/scalable/apps/palpate.svg"
mkdir -p "$root/usr/share/metainfo"
sed "s/@VERSION@/$version/; s/@DATE@/$day/" plugin/packaging/palpate.metainfo.xml >"$root/usr/share/metainfo/org.palpate.palpate.metainfo.xml"

# depends PACKAGE: the shared libraries' packages.
depends() {
  local files
  mapfile -t files < <(find "$work/$1" -type f -exec sh -c 'head -c 4 "$1" | grep -q ELF' _ {} \; -print)
  mkdir -p "$work/control/debian"
  printf 'Source: palpate\n\nPackage: %s\nArchitecture: %s\n' "$1" "$architecture" >"$work/control/debian/control"
  (cd "$work/control" && dpkg-shlibdeps --ignore-missing-info -O -l"$work/palpate-paraview/$plugins/Palpate" "${files[@]/#/-e}" 2>"$work/shlibdeps.log") |
    sed -n 's/^shlibs:Depends=//p'
}

# finish PACKAGE SECTION DEPENDS SUMMARY < description: what every package has, then the package.
finish() {
  local package=$1 section=$2 needs=$3 summary=$4 doc=$work/$1/usr/share/doc/$1 description
  description=$(sed 's/^$/./; s/^/ /')
  mkdir -p "$doc" "$work/$package/DEBIAN"
  { printf 'palpate (%s) unstable; urgency=medium\n\n  * Version %s, commit %s; see plugin/docs/changelog.md there.\n\n -- %s  %s\n' \
      "$full" "$version" "$commit" "$maintainer" "$(date -u -R -d "@$SOURCE_DATE_EPOCH")"; } | gzip -9n >"$doc/changelog.gz"
  cat >"$doc/copyright" <<'TEXT'
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: palpate

Files: *
Copyright: The Palpate developers
License: Apache-2.0
 On Debian systems the text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
 .
 The programs contain code of the headers of GLM, JSON for Modern C++ (MIT)
 and CLI11 (BSD-3-Clause); licenses.md says all, and palpate.spdx.json.
TEXT
  install -m 644 plugin/docs/licenses.md "$doc/licenses.md"
  python3 plugin/packaging/sbom.py "$package" "$full" "$commit" "$SOURCE_DATE_EPOCH" plugin/docs/licenses.md "$work/$package" \
    >"$doc/$package.spdx.json"
  find "$work/$package" -type f -not -path '*/DEBIAN/*' -exec chmod u=rw,go=r {} +
  if [ "$package" = palpate ]; then chmod 755 "$work"/palpate/usr/bin/* "$work"/palpate/usr/libexec/palpate/*; fi
  find "$work/$package" -type d -exec chmod 755 {} +
  (cd "$work/$package" && find usr -type f -print0 | sort -z | xargs -0 md5sum) >"$work/$package/DEBIAN/md5sums"
  cat >"$work/$package/DEBIAN/control" <<TEXT
Package: $package
Source: palpate
Version: $full
Architecture: $architecture
Maintainer: $maintainer
Installed-Size: $(du -k -s --apparent-size "$work/$package/usr" | cut -f 1)
Depends: $needs
Section: $section
Priority: optional
Description: $summary
$description
TEXT
  find "$work/$package" -depth -print0 | xargs -0 touch -h -d "@$SOURCE_DATE_EPOCH"
  dpkg-deb --root-owner-group -Zxz --build "$work/$package" "$out" >/dev/null
}

needs_palpate=$(depends palpate) needs_paraview=$(depends palpate-paraview)
finish palpate science "$needs_palpate, fonts-dejavu-core" "feel a CT or MR scan with a haptic stylus" <<'TEXT'
Palpate turns the tissue boundaries of a CT or MR series into forces on a
haptic stylus. This package has the command line, a writer of phantoms, the
guardian that brings a stylus's force to zero, and the rules that let the
user at the machine open a stylus.

Research software, not a medical device.
TEXT
icons= # Debian 13's ParaView shows its own only with these
[ "$suffix" = deb12 ] || icons=", qt6-svg-plugins"
finish palpate-paraview science "palpate (= $full), paraview, python3-paraview$icons, $needs_paraview" "feel a CT or MR scan in ParaView" <<'TEXT'
The plug-in that lets ParaView open DICOM series as a clinician reads them,
and feel them with a haptic stylus or the mouse. ParaView loads it by itself.

Research software, not a medical device.
TEXT
finish libpalpate-dev libdevel "libglm-dev, libfmt-dev, libdcmtk-dev, libopenjp2-7-dev, libcharls-dev, libarchive-dev, libpolyclipping-dev, libopencv-core-dev, libopencv-imgproc-dev, libopencv-photo-dev, nlohmann-json3-dev, libusb-1.0-0-dev, libhidapi-dev, libssl-dev$(
  [ "$suffix" = deb12 ] || echo ", libjpeg-dev, libpng-dev, libtiff-dev")" "headers and static libraries of Palpate" <<'TEXT'
The force balance, the reader of DICOM series, the haptic modes and the
stylus drivers of Palpate as libraries, with their CMake package:
find_package(palpate COMPONENTS solver io modes device).
TEXT
python3 plugin/packaging/slicer_zip.py "$out/slicer-palpate.zip" # for Slicer on any system: no package
ls -l "$out"
