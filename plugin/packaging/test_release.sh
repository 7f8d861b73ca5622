#!/usr/bin/env bash
# The tests in a bare root of a Debian release: plugin/packaging/test_release.sh trixie|bookworm [STAGE..] (default: --core).
# The commit is built, not the working tree. PALPATE_CCACHE_FOLDER names a ccache to share; PALPATE_KEEP_ROOT keeps the root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
case "${1:-}" in trixie | bookworm) ;; *) echo "test_release.sh: name a release, trixie or bookworm" >&2; exit 2 ;; esac
. plugin/packaging/bare_root.sh
release=$1
shift
[ $# -gt 0 ] || set -- --core

root=$(mktemp -d)/root
[ -n "${PALPATE_KEEP_ROOT:-}" ] || trap 'drop_root "$root"' EXIT
began=$SECONDS
make_root "$release" "$root"
git clone -q --no-hardlinks . "$root/root/palpate"
if [ -n "${PALPATE_CCACHE_FOLDER:-}" ]; then
  mkdir -p "$root/root/.cache/ccache"
  mount --bind "$PALPATE_CCACHE_FOLDER" "$root/root/.cache/ccache"
fi
echo "bare $release: $((SECONDS - began)) s, in $root"
began=$SECONDS
in_root "$root" /root/palpate/plugin/run test "$@"
echo "$release, plugin/run test $*: $((SECONDS - began)) s"
