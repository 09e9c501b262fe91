#!/usr/bin/env bash
# Installs what irdm needs: Debian's packages (scripts/packages.txt), and the npm packages that the viewer's page
# is built from, as its lock file says. Does nothing when all is there. dpkg does not wait for the disk after each file
# (--force-unsafe-io): if the machine loses power meanwhile, packages may have to be installed again.
#   scripts/setup.sh [--build | --demo | --run | --all]
#     --build: to compile the programs; --demo: for scripts/demo.sh; --run: all but what only tests need;
#     without: for scripts/test.sh; --all: for scripts/test.sh --all
set -euo pipefail
cd "$(dirname "$0")"

case "${1:-}" in
  --build) groups='build' ;;
  --demo) groups='build|page|plot' ;;
  --run) groups='build|page|plot|gallery|bind' ;;
  "") groups='build|page|plot|gallery|bind|tests' ;;
  --all) groups='[a-z]+' ;;
  *) echo "usage: scripts/setup.sh [--build | --demo | --run | --all]" >&2; exit 2 ;;
esac
mapfile -t packages < <(sed -nE "s/^([a-z0-9.+-]+) ($groups)\$/\1/p" packages.txt)

# install_packages NAME...
install_packages() {
  local missing=() as_root=() package status
  for package in "$@"; do
    # A nodejs that is not Debian's brings its own npm, and Debian's cannot be installed beside it.
    [ "$package" = npm ] && command -v npm >/dev/null && continue
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root or install sudo" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "setup: installing ${missing[*]}"
  # Lists that are less than an hour old are new enough.
  find /var/lib/apt/lists -maxdepth 1 -name '*Packages*' -mmin -60 2>/dev/null | grep -q . ||
    "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends -o Dpkg::Options::=--force-unsafe-io "${missing[@]}" >/dev/null
}

install_page_packages() {
  cd ../viewer/page
  if [ node_modules/.package-lock.json -nt package-lock.json ]; then
    echo "setup: the page's npm packages are installed"
    return
  fi
  echo "setup: installing the page's npm packages"
  # Node trusts a list of its own; here also whom the machine trusts (a proxy that looks into TLS, say).
  authorities=/etc/ssl/certs/ca-certificates.crt
  if [ -r "$authorities" ]; then export NODE_EXTRA_CA_CERTS=${NODE_EXTRA_CA_CERTS:-$authorities}; fi
  npm ci --no-audit --no-fund --loglevel=error
}

# What npm needs comes first: it downloads while the others are unpacked.
case " ${packages[*]} " in
  *" npm "*)
    install_packages ca-certificates nodejs npm
    install_page_packages &
    page=$!
    install_packages "${packages[@]}"
    wait $page
    ;;
  *) install_packages "${packages[@]}" ;;
esac
echo "setup: all ${#packages[@]} packages are installed"
