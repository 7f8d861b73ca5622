# The stages of `plugin/run test` and `plugin/run check`, sourced by plugin/run, whose functions they call.
# shellcheck shell=bash disable=SC2154

test_stages=(release panel)
check_stages=(format thorough packages asan fuzz tsan usb tidy paraview other-release)

declare -a table=()      # a line a stage, printed at the end
declare -a incomplete=() # stages that this machine cannot run, and why

# What a stage takes on a slow machine of two cores. In CI, which ends a gate after 90 minutes, a stage that no longer fits is named as incomplete.
declare -A slow_s=([packages]=500 [asan]=1200 [fuzz]=250 [tsan]=1000 [usb]=600 [paraview]=600)
# The other release has 420 s more: a minute before CI would end all.
longest_wait_s=420
seconds_left() { echo $((${PALPATE_ENDS:-9999999999} - $(date +%s))); }

# run_ctest PRESET ARGUMENT...: prints what failed in full and of what passed the last line alone.
run_ctest() {
  local build=build
  case "$1" in asan | tsan) build=build/$1 ;; esac
  local log=$build/ctest.log status=0
  ctest --preset "$1" -j"$(nproc)" --no-tests=error "${@:2}" 2>&1 | tee "$log" |
    awk '/^ +Start +[0-9]+:/ || /Test +#[0-9]+: .* Passed +[0-9.]+ sec/ { next } /^ *$/ { if (blank++) next } /[^ ]/ { blank = 0 } { print; fflush() }' ||
    status=$?
  # An entry is a suite: the programs themselves count the tests.
  counted="$(sed -n 's/^[0-9]*% tests passed, [0-9]* tests* failed out of \([0-9]*\)$/\1 suites/p' "$log" | tail -n 1), $(
    awk '/^\[=+\] .* ran\. / { tests += $2 } /^\[  SKIPPED \] [0-9]+ test/ { skipped += $4 }
      END { printf "%d tests, %d skipped", tests, skipped }' "$build/Testing/Temporary/LastTest.log")"
  return "$status"
}

# The one version of clang-format and clang-tidy, or a line that this release does not have it.
has_style_checks() {
  case "$(system_name)" in
    "debian 13"*)
      counted="not checked: Debian 13 has no clang-format-$style and clang-tidy-$style"
      return 1 ;;
  esac
}
stage_format() {
  if has_style_checks; then git ls-files '*.h' '*.cpp' | xargs "clang-format-$style" --dry-run --Werror; fi
}
# The whole product, the plug-in too if ParaView is installed.
build_release() {
  local paraview=OFF
  ! is_installed "${paraview_packages[0]}" || paraview=ON
  configure_and_build release -DPALPATE_TESTS=ON -DPALPATE_PARAVIEW=$paraview -DPALPATE_TEST_FILES="${PALPATE_TEST_FILES:-}"
}
# The tests of all but the panel that are quick.
stage_release() { build_release && run_ctest release -E '^(paraview|shared\.)' -LE '^thorough$'; }
# Those that take long or wait, and each public header by itself.
stage_thorough() {
  build_release && cmake --build --preset release --target all_verify_interface_header_sets -- --quiet &&
    run_ctest release -L '^thorough$'
}
# What needs the real series, which are never copied into the project.
stage_shared() {
  configure_and_build release -DPALPATE_TESTS=ON
  local data
  data=$(sed -n 's/^PALPATE_SHARED_DATA:PATH=//p' build/CMakeCache.txt)
  [ -d "$data" ] || refuse "the stage shared needs the real series, and $data is no folder; name theirs with
  cmake --preset release -DPALPATE_SHARED_DATA=FOLDER"
  run_ctest release -R '^shared\.'
}
# What computes for long is left to the release build: it reads no bytes, or those that other tests read, too.
numeric='(device\.(EachDevice|RandomFaults)|io\.(FractionsFelt|PlacesWithinTheBound|PlanesAlone)|results\.(ReadBack|UnevenSlices))'
stage_asan() {
  configure_and_build asan && LSAN_OPTIONS="suppressions=$PWD/.ci/leaks:print_suppressions=0" run_ctest asan -E "^(shared|arrows)|^($numeric)"
}
stage_tsan() {
  configure_and_build tsan && TSAN_OPTIONS="suppressions=$PWD/.ci/races:die_after_fork=0" run_ctest tsan -E '^shared\.'
}
# Each of the fuzzers for 30 s, in the sanitizers' build.
stage_fuzz() {
  configure asan &&
    cmake --build --preset asan --target fuzz_reader fuzz_scene fuzz_solve fuzz_recording fuzz_openigtlink palpate palpate-testdata write_seeds -- --quiet &&
    plugin/testing/fuzz build/asan 30
}
# tidy_files ARGUMENT...: clang-tidy over the product, ParaView's part too where its packages are.
tidy_files() {
  local paraview=OFF
  ! is_installed "${paraview_packages[0]}" || paraview=ON
  configure asan -B build/tidy -DPALPATE_TESTS=OFF -DPALPATE_PARAVIEW=$paraview &&
    nice python3 -B plugin/testing/tidy.py "clang-tidy-$style" build/tidy "$@"
}
# The folders that changed since the commit in .ci/tidied, at which every file was read without a finding.
stage_tidy() {
  if has_style_checks; then tidy_files --since "$(cat .ci/tidied)"; fi
}
stage_tidy_all() {
  if has_style_checks; then tidy_files && git rev-parse HEAD >.ci/tidied; fi
}

# Two programs a core: a scenario waits for half of its time.
paraview_tests() {
  install "${paraview_packages[@]}" "${gui_test_packages[@]}"
  configure_and_build release -DPALPATE_TESTS=ON -DPALPATE_PARAVIEW=ON && run_ctest release -R '^paraview' -j$((2 * $(nproc))) "$@"
}
stage_panel() { paraview_tests -L '^first$'; }     # the first five minutes of the guide
# All the others. What is left of the time decides whether every one, every second or every fourth is run; which ones, the commit.
stage_paraview() {
  local left every=1 share=()
  left=$(seconds_left)
  [ "$left" -ge 2000 ] || every=2
  [ "$left" -ge 1100 ] || every=4
  if [ "$every" -gt 1 ]; then
    share=(-I "$((1 + 16#$(git rev-parse HEAD | tail -c 5) % every)),,$every")
    incomplete+=("paraview: one program of $every: $left s were left")
  fi
  paraview_tests -LE '^first$' "${share[@]}"
}
stage_pressed() { paraview_tests -R '^paraview\.panel\.four_clicks$'; }

# In a virtual machine: about 80 s, and 72 MB to download where that is not done.
stage_usb() {
  install "${guest_packages[@]}"
  build_release &&
    cmake --build --preset release --target device_guest device_client palpate_guardian -- --quiet &&
    device/testing/guest/boot build
}

# Whether a bare root can be entered here: root in a container may not be allowed to mount.
can_mount() {
  local folder
  folder=$(mktemp -d)
  local able=1
  if [ "$(id -u)" -eq 0 ] && mount --bind /proc "$folder" 2>/dev/null; then umount "$folder" && able=0; fi
  rmdir "$folder"
  return "$able"
}

# All packages at once, for a bare root.
stage_set_up() { install "${paraview_packages[@]}" "${gui_test_packages[@]}" "${packaging_packages[@]}"; }

# The packages as users meet them.
stage_package() {
  install "${paraview_packages[@]}" "${packaging_packages[@]}"
  plugin/packaging/package.sh >/dev/null
}
stage_packages() {
  stage_package || return 1
  if can_mount; then plugin/packaging/test_package.sh; else incomplete+=("packages: made, not installed: no bare root can be entered here"); fi
}

# The release that this is not, in a bare root of its own.
stage_other_release() {
  can_mount || {
    incomplete+=("other-release: no bare root can be entered here (it needs root and the right to mount)")
    return 0
  }
  install mmdebstrap
  plugin/packaging/test_release.sh "$other_release" >build/other-release.log 2>&1 || { tail -n 80 build/other-release.log; return 1; }
  counted="$other_release: $(awk '/^(set-up|release|pressed|package) +[0-9]+ s/ { printf "%s %s s, ", $1, $2 }' build/other-release.log)installed alone"
}

# Green runs by tree: outside of CI a stage is not run again on what it passed.
green=${XDG_CACHE_HOME:-$HOME/.cache}/palpate/green
mark_of() { printf '%s/%s-%s' "$green" "$(git rev-parse 'HEAD^{tree}')" "$1"; }
is_green() { [ -z "${CI:-}" ] && [ -z "$(git status --porcelain)" ] && [ -e "$(mark_of "$1")" ]; }
keep_green() {
  # Not with a limit of time: a part of a stage may have been left out.
  if [ -n "${PALPATE_ENDS:-}" ] || [ -n "$(git status --porcelain)" ]; then return 0; fi
  mkdir -p "$green"
  touch "$(mark_of "$1")"
}

# run_stage NAME: in the table's line is what the stage counted.
run_stage() {
  local stage=$1 began=$SECONDS
  counted=""
  if is_green "$stage"; then
    table+=("$(printf '%-14s %6s   %s' "$stage" - "passed before on these files")")
    return 0
  fi
  if [ "$(seconds_left)" -lt "${slow_s[$stage]:-0}" ]; then
    incomplete+=("$stage: not begun with $(seconds_left) s left")
    return 0
  fi
  say "stage $stage"
  "stage_${stage//-/_}"
  keep_green "$stage"
  table+=("$(printf '%-14s %5d s  %s' "$stage" $((SECONDS - began)) "$counted")")
  say "${table[-1]}"
}

# run_stages NAME...: one after the other. The other release begins first, beside them, with what they leave of the processors.
run_stages() {
  check_system
  local stage beside=""
  for stage in "$@"; do
    declare -F "stage_${stage//-/_}" >/dev/null || refuse "no stage '$stage'; there are: ${test_stages[*]} ${check_stages[*]} shared tidy-all"
  done
  install "${core_packages[@]}" "${test_packages[@]}"
  (install "${data_packages[@]}") || say "without ${data_packages[*]}: tests of the real head skip"
  mkdir -p build
  if [ $# -gt 1 ] && [[ " $* " == *" other-release "* ]] && can_mount && ! is_green other-release; then
    install mmdebstrap
    nice -n 10 plugin/run check other-release >build/other-release.out 2>&1 &
    beside=$!
    trap "kill $beside 2>/dev/null || true" EXIT
  fi
  for stage in "$@"; do
    if [ "$stage" = other-release ] && [ -n "$beside" ]; then
      while kill -0 "$beside" 2>/dev/null && [ "$(seconds_left)" -gt -"$longest_wait_s" ]; do sleep 1; done
      if kill -0 "$beside" 2>/dev/null; then
        incomplete+=("other-release: not ended in time")
        continue
      fi
      wait "$beside" || { cat build/other-release.out; exit 1; }
      trap - EXIT
      table+=("$(grep '^other-release ' build/other-release.out | tail -n 1)")
    else
      run_stage "$stage"
    fi
  done
  say "stages and their seconds"
  printf '%s\n' "${table[@]}"
  if [ ${#incomplete[@]} -gt 0 ]; then
    printf 'incomplete: %s\n' "${incomplete[@]}"
    [ "${PALPATE_ONE_RELEASE:-}" = 1 ] || { say "not all stages were run (PALPATE_ONE_RELEASE=1 accepts that)"; exit 3; }
  fi
  if [ ${#incomplete[@]} -gt 0 ]; then say "what was run passed"; else say "all stages passed"; fi
}
