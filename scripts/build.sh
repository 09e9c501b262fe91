#!/usr/bin/env bash
# Configures and builds one preset of CMakePresets.json: scripts/build.sh PRESET [TARGET ...]
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:?usage: scripts/build.sh PRESET [TARGET ...]}
shift
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "build: preset $preset"
cmake --preset "$preset" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
cmake --build --preset "$preset" ${@:+--target "$@"} >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
grep -E 'warning:' "$log" || true
