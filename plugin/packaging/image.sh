#!/usr/bin/env bash
# An OCI image with the command line, from the packages: plugin/packaging/image.sh [FILE] (default build-package/palpate.oci.tar).
# For systems without Debian:  podman load -i FILE;  podman run --rm -v SCANS:/scans palpate info /scans
# Then it is run once: the demo on a phantom. As root; for containers inside containers: PALPATE_BUILDAH="--storage-driver vfs".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
. plugin/packaging/bare_root.sh
file=$(realpath -m "${1:-build-package/palpate.oci.tar}")
# shellcheck disable=SC1091
release=$(. /etc/os-release; echo "$VERSION_CODENAME")
read -r -a buildah <<<"buildah ${PALPATE_BUILDAH:---storage-driver vfs}"

container=$("${buildah[@]}" from scratch)
trap '"${buildah[@]}" rm "$container" >/dev/null' EXIT
root=$("${buildah[@]}" mount "$container")
mmdebstrap --quiet --variant=minbase --include=ca-certificates "$release" - "$mirror" | tar -x -C "$root" --exclude='./dev/*'
cp build-package/deb/palpate_*.deb "$root/tmp/"
run() { "${buildah[@]}" run --isolation chroot "$container" -- "$@"; }
run sh -c 'apt-get -q update && DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends /tmp/palpate_*.deb &&
  rm -rf /tmp/*.deb /var/lib/apt/lists /var/cache/apt/*' >/dev/null
"${buildah[@]}" config --entrypoint '["palpate"]' --cmd -- '--help' --workingdir /scans --label org.opencontainers.image.title=palpate \
  --label org.opencontainers.image.licenses=Apache-2.0 "$container"

echo "in the image:"
run sh -c 'cd /tmp && palpate --version && palpate-testdata phantom slab --size 32,32,32 -o phantom >/dev/null &&
  palpate probe phantom --scene ct-skin-and-bone -o session >/dev/null && palpate replay session/recording.h5 phantom && rm -rf phantom session'
rm -f "$file"
"${buildah[@]}" commit --quiet "$container" "oci-archive:$file:palpate" >/dev/null
ls -l "$file"
