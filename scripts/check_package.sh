#!/usr/bin/env bash
# Tries the Debian packages on a clean Debian 12: makes a root with debootstrap, installs them there, plays the
# demonstration from the installed files, builds the embedding example, removes everything and looks for what is left.
# Needs root, debootstrap and Debian's mirror; takes a few minutes and 1.5 GB. Changes nothing outside its root.
#   scripts/check_package.sh [--keep] [FOLDER]
#     FOLDER: where scripts/package.sh left the packages (default: out/package)
#     IRDM_DEBIAN_MIRROR: address of the mirror; unless set, debootstrap takes its own
#     --keep: the clean root stays for the next time, in /var/tmp/irdm-debian-12
set -euo pipefail
cd "$(dirname "$0")/.."

keep=no folder=out/package
while [ $# -gt 0 ]; do
  case $1 in
    --keep) keep=yes ;;
    -*) echo "usage: scripts/check_package.sh [--keep] [FOLDER]" >&2; exit 2 ;;
    *) folder=$1 ;;
  esac
  shift
done
say() { echo "check_package: $1"; }
fail() { echo "check_package: error: $1" >&2; exit 1; }

[ "$(id -u)" -eq 0 ] || fail "mounts and chroot need root"
command -v debootstrap >/dev/null || fail "there is no debootstrap; apt-get install debootstrap"
packages=("$folder"/irdm_*.deb "$folder"/irdm-dev_*.deb "$folder"/python3-irdm_*.deb)
[ ${#packages[@]} -eq 3 ] && [ -f "${packages[0]}" ] && [ -f "${packages[1]}" ] && [ -f "${packages[2]}" ] ||
  fail "there are no packages in $folder; make them with scripts/package.sh"

clean=/var/tmp/irdm-debian-12
work=$(mktemp -d /var/tmp/irdm-package.XXXXXX)
root=$work/root
finish() {
  for place in dev proc sys; do
    mountpoint -q "$root/$place" && umount "$root/$place"
  done
  # Never into what could still be mounted.
  rm -rf --one-file-system "$work"
  [ $keep = yes ] || rm -rf --one-file-system "$clean"
}
trap finish EXIT

if [ ! -f "$clean/.complete" ]; then
  say "making a minimal Debian 12"
  rm -rf --one-file-system "$clean"
  debootstrap --variant=minbase bookworm "$clean" ${IRDM_DEBIAN_MIRROR:+"$IRDM_DEBIAN_MIRROR"} >"$work/debootstrap.log" ||
    { tail -5 "$work/debootstrap.log" >&2; fail "debootstrap failed"; }
  touch "$clean/.complete"
fi
cp -a "$clean" "$root"
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
as_nobody() { chroot --userspec=65534:65534 "$root" env -i PATH=/usr/bin:/bin HOME=/tmp LC_ALL=C.UTF-8 "$@"; }
quietly() { "$@" >"$work/log" 2>&1 || { tail -20 "$work/log" >&2; fail "failed: $*"; }; }

# Everything but what apt and dpkg keep for themselves, and what /tmp is for.
state() {
  inside find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /run -o -path /tmp -o -path /var/tmp \
    -o -path /var/cache -o -path /var/log -o -path /var/lib/apt -o -path /var/lib/dpkg \) -prune \
    -o -printf '%M %u:%g %p %l\n' | sort
  inside find /etc -xdev -type f -exec sha256sum {} + | sort -k2
  inside find /var/lib/dpkg/info /var/lib/dpkg/alternatives | sort
  inside dpkg-query -W -f '${Package} ${db:Status-Abbrev} ${Version}\n'
}

say "installing what the packages depend on"
quietly inside apt-get update -q
for package in "${packages[@]}"; do
  depends=$(dpkg-deb -f "$package" Depends | sed 's/irdm (= [^)]*), //')
  echo "  $(basename "$package"): $depends"
  quietly inside apt-get satisfy -y -q --no-install-recommends "$depends"
done
quietly inside apt-get install -y -q --no-install-recommends g++ cmake make man-db pkg-config
state >"$work/before"

say "installing the packages"
cp "${packages[@]}" "$root/tmp/"
quietly inside sh -c 'dpkg -i /tmp/*.deb'
inside sh -c 'dpkg -L irdm irdm-dev python3-irdm | grep -c .' | sed 's/$/ files and folders/; s/^/  /'
for program in irdm-precompute irdm-server irdm-bridge irdm-replay irdm-ros-bridge irdm-play; do
  echo "  $(as_nobody $program --version)"
  inside test -f "/usr/share/man/man1/$program.1.gz" || fail "$program has no man page"
done

say "playing the demonstration from the installed files, as nobody, in real time"
as_nobody sh -c 'cd /tmp && irdm-play paper-cube --once --out /tmp/play' | sed 's/^/  /' || fail "the demonstration failed"
as_nobody irdm-replay /tmp/play/paper-cube/trace.h5 --rate 10 --csv /tmp/play/run.csv >/dev/null
echo "  replayed: $(wc -l <"$root/tmp/play/run.csv") lines"

say "building the embedding example from the installed files"
quietly as_nobody cmake -S /usr/share/irdm/examples/embed -B /tmp/embed
quietly as_nobody cmake --build /tmp/embed
as_nobody /tmp/embed/embed /tmp/play/models/paper-cube.h5 | tail -1 | sed 's/^/  /'

say "a step from Python, and the C example"
as_nobody python3 -c 'import irdm; print(irdm.Simulation({"object": [{"model": "/tmp/play/models/paper-cube.h5"}]}).step().time)' |
  sed 's/^/  /' || fail "Python failed"
quietly as_nobody sh -c 'cc /usr/share/irdm/examples/c/press.c -o /tmp/press $(pkg-config --cflags --libs irdm)'

say "purging the packages"
rm -rf "$root"/tmp/*
quietly inside apt-get purge -y -q irdm irdm-dev python3-irdm
state >"$work/after"
if ! diff "$work/before" "$work/after" >"$work/diff"; then
  cat "$work/diff" >&2
  fail "the lines above are what the packages left"
fi
say "nothing is left ($(grep -c . "$work/before") lines compared)"
