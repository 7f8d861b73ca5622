#!/usr/bin/env bash
# Makes an OCI image of the command line from its Debian package, and tries it: plugin/packaging/image.sh [FOLDER]
# (default build-package/deb). Needs mmdebstrap and buildah; as root, or as a user with a range in /etc/subuid.
# The image lies in buildah's storage (podman shares it) and in build-package/palpate-VERSION.oci.tar, which docker reads, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
packages=$(realpath "${1:-build-package/deb}")
file=$(ls "$packages"/palpate_*.deb)
version=$(dpkg-deb -f "$file" Version | sed 's/+deb[0-9]*$//')
out=$packages/../palpate-$version.oci.tar
mirror=${PALPATE_MIRROR:-http://deb.debian.org/debian}
# shellcheck disable=SC1091
release=${PALPATE_RELEASE:-$(. /etc/os-release; echo "$VERSION_CODENAME")}
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH
export BUILDAH_ISOLATION=${BUILDAH_ISOLATION:-chroot} # a container in which the image is tried needs no more
store=(--storage-driver "${PALPATE_STORAGE_DRIVER:-vfs}")

scratch=$(mktemp -d)
container=
drop() {
  [ -z "$container" ] || buildah "${store[@]}" rm "$container" >/dev/null
  rm -rf "$scratch"
}
trap drop EXIT

mmdebstrap --quiet --variant=minbase --dpkgopt='path-exclude=/usr/share/locale/*' \
  --setup-hook='mkdir -p "$1/packages" && cp "'"$file"'" "$1/packages/palpate.deb" && cp /etc/hosts "$1/etc/hosts" 2>/dev/null || true' \
  --customize-hook='chroot "$1" apt-get -q install -y --no-install-recommends /packages/palpate.deb >/dev/null' \
  --customize-hook='rm -r "$1/packages"; : >"$1/etc/hosts"; mkdir -p "$1/data"' \
  "$release" "$scratch/root.tar" "$mirror"

container=$(buildah "${store[@]}" from scratch)
buildah "${store[@]}" add "$container" "$scratch/root.tar" / >/dev/null
buildah "${store[@]}" config --entrypoint '["palpate"]' --cmd '' --workingdir /data --env LC_ALL=C.UTF-8 \
  --label "org.opencontainers.image.title=palpate" --label "org.opencontainers.image.version=$version" \
  --label "org.opencontainers.image.licenses=Apache-2.0" --label "org.opencontainers.image.revision=$(git rev-parse HEAD)" "$container"
buildah "${store[@]}" commit --quiet --timestamp "$SOURCE_DATE_EPOCH" "$container" "localhost/palpate:$version" >/dev/null
buildah "${store[@]}" rm "$container" >/dev/null
container=

# What a user of it does first.
container=$(buildah "${store[@]}" from "localhost/palpate:$version")
run() { buildah "${store[@]}" run "$container" -- "$@"; }
run palpate --version
run palpate-testdata phantom slab --size 32,32,32 -o /data/phantom >/dev/null
run palpate probe /data/phantom --scene ct-skin-and-bone -o /data/session >/dev/null
run palpate replay /data/session/recording.h5 /data/phantom
rm -f "$out"
buildah "${store[@]}" push --quiet "localhost/palpate:$version" "oci-archive:$out:palpate:$version"
echo "image: localhost/palpate:$version, $(du -m "$out" | cut -f 1) MB in $(realpath "$out")"
