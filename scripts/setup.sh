#!/usr/bin/env bash
# Installs what irdm needs: Debian's packages (scripts/packages.txt), and the npm packages that the viewer's page
# is built from, as its lock file says. Does nothing when all is there.
#   scripts/setup.sh [--run]    --run: without what only the tests need
set -euo pipefail
cd "$(dirname "$0")"

case "${1:-}" in
  "") unwanted='^(#|$)' ;;
  --run) unwanted='^(#|$)| tests$' ;;
  *) echo "usage: scripts/setup.sh [--run]" >&2; exit 2 ;;
esac

install_packages() {
  local packages missing=() as_root=() package status
  mapfile -t packages < <(grep -Ev "$unwanted" packages.txt | cut -d ' ' -f 1)
  for package in "${packages[@]}"; do
    # A nodejs that is not Debian's brings its own npm, and Debian's cannot be installed beside it.
    [ "$package" = npm ] && command -v npm >/dev/null && continue
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then
    echo "setup: all ${#packages[@]} packages are installed"
    return
  fi
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: run as root or install sudo" >&2; exit 1; }
    as_root=(sudo)
  fi
  echo "setup: installing ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
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

install_packages
install_page_packages
echo "setup: done"
