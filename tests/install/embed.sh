#!/usr/bin/env bash
# embed.sh TREE CMAKE BUILD COMPILER MODEL: the example builds against the installed tree, and what it prints is right: the
# impulse that its stylus gave is the momentum that the free object has.
set -euo pipefail
tree=$1 cmake=$2 build=$3 compiler=$4 model=$5

rm -rf "$build"
"$cmake" -S "$tree/share/irdm/examples/embed" -B "$build" -DCMAKE_PREFIX_PATH="$tree" \
  -DCMAKE_CXX_COMPILER="$compiler" >/dev/null
"$cmake" --build "$build" >/dev/null
output=$("$build/embed" "$model")
echo "$output"
awk '
  $2 == "s" && $3 > largest { largest = $3 }
  /^impulse/ { impulse = $2; momentum = $4 }
  END { exit !(largest > 0.05 && impulse < -1e-3 && (impulse - momentum) ^ 2 < (1e-6 * impulse) ^ 2) }' <<<"$output" ||
  { echo "impulse and momentum differ, or no force was felt" >&2; exit 1; }
