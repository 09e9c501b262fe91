#!/usr/bin/env bash
# Installs what irdm needs: Debian's packages (scripts/packages.txt), and the npm packages that the viewer's page
# is built from, as its lock file says. Does nothing when all is there. dpkg does not wait for the disk after each file
# (--force-unsafe-io): if the machine loses power meanwhile, packages may have to be installed again.
#   scripts/setup.sh [--run | --demo]    --run: without what only the tests need; --demo: for scripts/demo.sh only
set -euo pipefail
cd "$(dirname "$0")"

case "${1:-}" in
  "") unwanted='^(#|$)' ;;
  --run) unwanted='^(#|$)| tests$' ;;
  --demo) unwanted='^(#|$)| (tests|gallery)$' ;;
  *) echo "usage: scripts/setup.sh [--run | --demo]" >&2; exit 2 ;;
esac
# What npm needs comes first: it downloads while the others are unpacked.
for_npm='^(ca-certificates|nodejs|npm)$'
mapfile -t packages < <(grep -Ev "$unwanted" packages.txt | cut -d ' ' -f 1)

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

mapfile -t first < <(printf '%s\n' "${packages[@]}" | grep -E "$for_npm")
mapfile -t others < <(printf '%s\n' "${packages[@]}" | grep -Ev "$for_npm")
install_packages "${first[@]}"
install_page_packages &
install_packages "${others[@]}"
wait $!
echo "setup: all ${#packages[@]} packages are installed"
