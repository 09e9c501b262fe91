#!/usr/bin/env bash
# Runs the two commands of README in a clean root of a Debian release, as on a new machine: scripts/demo.sh, then
# scripts/test.sh, both timed. Needs root, debootstrap, git and Debian's mirror; takes half an hour and 6 GB. Changes
# nothing outside its folder. What the scripts print is in out/release.
#   scripts/check_release.sh bookworm|trixie [COMMAND...]
#     COMMAND: in place of the two, for instance: scripts/test.sh --all
#     IRDM_DEBIAN_MIRROR: address of the mirror; unless set, debootstrap takes its own
set -euo pipefail
cd "$(dirname "$0")/.."

release=${1:-}
case "$release" in
  bookworm | trixie) shift ;;
  *) echo "usage: scripts/check_release.sh bookworm|trixie [COMMAND...]" >&2; exit 2 ;;
esac
fail() { echo "check_release: error: $1" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || fail "mounts and chroot need root"
command -v debootstrap >/dev/null || fail "there is no debootstrap; apt-get install debootstrap"

out=$PWD/out/release
mkdir -p "$out"
root=$(mktemp -d "/var/tmp/irdm-$release.XXXXXX")
# Mounts are private to this shell's children, and gone with them.
trap 'rm -rf --one-file-system "$root"' EXIT
echo "check_release: making a minimal $release in $root"
debootstrap --variant=minbase "$release" "$root" ${IRDM_DEBIAN_MIRROR:+"$IRDM_DEBIAN_MIRROR"} >"$out/debootstrap.log" ||
  { tail -n 5 "$out/debootstrap.log" >&2; fail "debootstrap failed"; }
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
# Whom this machine trusts, the root trusts: a proxy that looks into TLS, say.
mkdir -p "$root/usr/local/share/ca-certificates"
cp -a /usr/local/share/ca-certificates/. "$root/usr/local/share/ca-certificates/" 2>/dev/null || true
git clone -q --no-hardlinks . "$root/srv/irdm"

inside() {
  unshare --mount --pid --fork bash -c '
    root=$1; shift
    mount --make-rprivate /
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount --rbind /dev "$root/dev"
    exec chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
      ${OPENBLAS_CORETYPE:+OPENBLAS_CORETYPE=$OPENBLAS_CORETYPE} bash -c "cd /srv/irdm; time $*"' _ "$root" "$@"
}
echo "check_release: $(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' "$root/etc/os-release"), $(nproc) cores," \
  "$(openssl speed -seconds 1 sha256 2>/dev/null | sed -n 's/^sha256 .* //p') of SHA-256 a second"
if [ $# -gt 0 ]; then
  inside "$@"
else
  for command in "scripts/demo.sh --once" scripts/test.sh; do
    log=$out/$release-$(basename "${command%% *}" .sh).log
    echo "check_release: $command (log: $log)"
    inside "$command" >"$log" 2>&1 || { tail -n 40 "$log" >&2; fail "$command failed in $release"; }
    tail -n 12 "$log"
  done
fi
