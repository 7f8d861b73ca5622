#!/usr/bin/env bash
# The rules of stages.sh, on stages that are made here and take a second: what fails fails the run; what would begin too late is named, and the run
# does not say that all passed; the other release is waited for, until CI would end all.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
stages=$PWD/plugin/testing/stages.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# run SECONDS_LEFT OTHER_RELEASE STAGE...: the exit code goes to `code`, what is printed to `said`.
run() {
  local left=$1
  code=0
  said=$(cd "$folder" && env ${left:+"PALPATE_ENDS=$(($(date +%s) + left))"} OTHER="$2" STAGES="$stages" \
    bash -c 'set -euo pipefail
      . "$STAGES"
      say() { echo "== $*"; }
      refuse() { echo "$*"; exit 2; }
      check_system() { :; }; install() { :; }; can_mount() { :; }; is_green() { false; }; keep_green() { :; }
      core_packages=() test_packages=() data_packages=() PALPATE_ONE_RELEASE=1
      nice() { bash -c "$OTHER"; }
      stage_format() { counted="looked at"; }
      stage_usb() { counted="plugged in"; }
      stage_tsan() { return 1; }
      git() { echo 8d0b265f503; }
      paraview_tests() { echo "asked: $*"; }
      run_stages "$@"' stages "${@:3}" 2>&1) || code=$?
}
fail() { printf 'FAILED: %s\n%s (exit %s)\n' "$1" "$said" "$code"; exit 1; }
says() { [[ "$said" == *"$1"* ]] || fail "not said: $1"; }
says_not() { [[ "$said" != *"$1"* ]] || fail "said: $1"; }
ends_with() { [ "$code" -eq "$1" ] || fail "exit code $code, not $1"; }

passes='sleep 1; echo "other-release   9 s  trixie"'
run "" "$passes" format usb other-release
ends_with 0; says "looked at"; says "plugged in"; says "9 s  trixie"; says "== all stages passed"; says_not incomplete

run 2000 "$passes" format usb other-release # in time
ends_with 0; says "plugged in"; says "== all stages passed"

run 100 "$passes" format usb other-release # usb takes longer
ends_with 0; says "looked at"; says_not "plugged in"; says "incomplete: usb"; says "9 s  trixie"; says "== what was run passed"; says_not "all stages passed"

run 0 'sleep 3; echo "other-release   9 s  trixie"' format other-release # it is waited for
ends_with 0; says "9 s  trixie"

run -418 'exec sleep 30' format other-release # but not until CI ends all
ends_with 0; says "incomplete: other-release: not ended in time"; says "== what was run passed"

run 0 'echo broken; exit 3' format other-release
ends_with 1; says broken; says_not passed

run 3000 "$passes" paraview # all of the panel's programs, or what there is time for
ends_with 0; says "asked: -LE ^first$"; says_not "-I"; says "== all stages passed"
run 1500 "$passes" paraview
ends_with 0; says "-I 2,,2"; says "incomplete: paraview: one program of 2"; says "== what was run passed"
run 900 "$passes" paraview
ends_with 0; says "-I 4,,4"; says "one program of 4"
run 300 "$passes" paraview
ends_with 0; says_not "asked"; says "incomplete: paraview: not begun"

run "" "$passes" format tsan usb
[ "$code" -ne 0 ] || fail "a stage failed"
says_not "plugged in"; says_not passed
echo "passed"
