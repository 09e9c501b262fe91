#!/usr/bin/env bash
# Makes the Debian packages irdm, irdm-dev and python3-irdm: builds a preset without tests and benchmarks, and packs it.
#   scripts/package.sh [PRESET] [FOLDER]    PRESET: release unless given; FOLDER for the packages: out/package
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release} folder=${2:-out/package}
scripts/build.sh "$preset" irdm_packaged
mkdir -p "$folder"
rm -f "$folder"/irdm_*.deb "$folder"/irdm-dev_*.deb "$folder"/python3-irdm_*.deb
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cpack --config "build/$preset/CPackConfig.cmake" -G DEB -B "$folder" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
rm -rf "$folder/_CPack_Packages"
ls "$folder"/*.deb
