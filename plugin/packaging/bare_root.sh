# A bare root of a Debian release, to be sourced: make_root RELEASE FOLDER, in_root FOLDER COMMAND.., drop_root FOLDER.
# shellcheck shell=bash

[ "$(id -u)" -eq 0 ] || { echo "a bare root of Debian is made and entered by root alone: sudo $0" >&2; exit 2; }
mirror=${PALPATE_MIRROR:-http://deb.debian.org/debian}

mount_root() { # /dev, /proc, /sys, then FOLDER FROM TO
  local part
  for part in proc sys dev; do mount --bind "/$part" "$1/$part" || return 1; done
}

# A root as the mirror has it today is kept for a day: the packages are tried in a second one.
make_root() {
  local release=$1 root=$2 kept=${XDG_CACHE_HOME:-$HOME/.cache}/palpate/roots
  mkdir -p "$root" "$kept"
  if [ -z "$(find "$kept/$release.tar" -mmin -1440 2>/dev/null)" ]; then
    mmdebstrap --quiet --variant=minbase --include=ca-certificates "$release" "$kept/$release.$$.tar" "$mirror" || return 1
    mv "$kept/$release.$$.tar" "$kept/$release.tar"
  fi
  tar -C "$root" --numeric-owner -xpf "$kept/$release.tar" || return 1
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe" # it is thrown away
  cp /etc/resolv.conf /etc/hosts "$root/etc/"
  mount_root "$root"
}

in_root() {
  local root=$1
  shift
  env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$root" "$@"
}

# Unmounts what lies below it, and deletes it only when nothing does any more: /dev lies there.
drop_root() {
  local place
  while read -r place; do umount "$place" || return 1; done < <(awk -v root="$1/" 'index($2, root) == 1 { print $2 }' /proc/mounts | sort -r)
  rm -rf --one-file-system "$1"
}
