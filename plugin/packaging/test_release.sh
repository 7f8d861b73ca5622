#!/usr/bin/env bash
# Palpate on a Debian release, in a bare root: plugin/packaging/test_release.sh trixie|bookworm [COMMAND...]
# Everything is built, the core's tests pass, ParaView presses on a scan on a virtual display, and the packages made there are
# installed alone in a second root. With COMMAND it runs `plugin/run COMMAND...` in the first root instead.
# The commit is built, not the working tree, with this machine's ccache. PALPATE_KEEP_ROOT keeps the root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
case "${1:-}" in trixie | bookworm) ;; *) echo "test_release.sh: name a release, trixie or bookworm" >&2; exit 2 ;; esac
. plugin/packaging/bare_root.sh
release=$1
shift

root=$(mktemp -d)/root
[ -n "${PALPATE_KEEP_ROOT:-}" ] || trap 'drop_root "$root"' EXIT
began=$SECONDS
say() { echo "$release: $* in $((SECONDS - began)) s"; began=$SECONDS; }
make_root "$release" "$root"
git clone -q --no-hardlinks . "$root/root/palpate"
cache=$(ccache -k cache_dir 2>/dev/null) || cache=$HOME/.cache/ccache
mkdir -p "$cache" "$root/root/.cache/ccache"
mount --bind "$cache" "$root/root/.cache/ccache"
say "a bare root"
if [ $# -gt 0 ]; then
  in_root "$root" env CI="${CI:-}" /root/palpate/plugin/run "$@"
  say "plugin/run $*"
  exit
fi
# Tests of what Debian's libraries take part in: solver, modes and device are tested with the release that this is not.
in_root "$root" env CI="${CI:-}" PALPATE_ONE_RELEASE=1 PALPATE_TEST_FILES='^(io|testdata|plugin/[a-oq-z]*)/' \
  /root/palpate/plugin/run check set-up release pressed package
say "built, tested and packaged"
PALPATE_RELEASE=$release plugin/packaging/test_package.sh "$root/root/palpate/build-package/deb"
say "packages installed alone"
