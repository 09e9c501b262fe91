#!/usr/bin/env bash
# Configures and builds one preset of CMakePresets.json: scripts/build.sh PRESET [-D...] [TARGET ...]
# The compiler's output is in build/PRESET.log; warnings are repeated.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/progress.sh

preset=${1:?usage: scripts/build.sh PRESET [-D...] [TARGET ...]}
shift
settings=() targets=()
for word in "$@"; do
  case $word in
    -D*) settings+=("$word") ;;
    *) targets+=("$word") ;;
  esac
done
mkdir -p build
log=build/$preset.log
fail() {
  grep -E -A 20 'error|FAILED' "$log" >&2 || tail -n 40 "$log" >&2
  echo "build: preset $preset failed; all of it: $log" >&2
  exit 1
}
echo "build: preset $preset${targets[*]:+: ${targets[*]}} (log: $log)"
# Configured again when the settings or the presets are others than the last time; ninja looks after the rest.
stamp=build/$preset/.settings
if [ ! "$stamp" -nt CMakePresets.json ] || [ "$(cat "$stamp")" != "${settings[*]}" ]; then
  rm -f "$stamp"
  cmake --preset "$preset" ${settings[@]+"${settings[@]}"} >"$log" 2>&1 || fail
  echo "${settings[*]}" >"$stamp"
fi
follow "build" "$log" '^\[([0-9]+)/([0-9]+)\].*' \
  cmake --build --preset "$preset" --parallel "$(nproc)" ${targets[@]+--target "${targets[@]}"} || fail
grep -E 'warning:' "$log" || true
