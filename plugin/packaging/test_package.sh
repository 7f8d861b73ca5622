#!/usr/bin/env bash
# Tests the packages as a user meets them: plugin/packaging/test_package.sh [FOLDER] (default build-package/deb).
# In a bare root of the release that this runs on the files alone are installed; then what they promise is tried.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. plugin/packaging/bare_root.sh
packages=$(realpath "${1:-build-package/deb}")
# shellcheck disable=SC1091
release=${PALPATE_RELEASE:-$(. /etc/os-release; echo "$VERSION_CODENAME")}

lintian --allow-root --fail-on error --tag-display-limit 3 "$packages"/*.deb
for list in "$packages"/../packages/*/usr/share/doc/*/*.spdx.json; do python3 -m json.tool "$list" >/dev/null; done
desktop-file-validate plugin/packaging/palpate.desktop

root=$(mktemp -d)/root
trap 'drop_root "$root"' EXIT
make_root "$release" "$root" || exit 77 # no bare root can be made here
mkdir "$root/root/packages"
cp "$packages"/*.deb "$root/root/packages/"
cp -r .cmake/outside "$root/root/outside"
cp plugin/packaging/in_root_test.sh plugin/packaging/plugin_loads.py "$root/root/"
in_root "$root" bash /root/in_root_test.sh
echo "packages: all passed in a bare $release"
