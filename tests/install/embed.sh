#!/usr/bin/env bash
# embed.sh TREE CMAKE BUILD COMPILER MODEL: the examples build against the installed tree, and what they find is right: the
# impulse that the stylus gave is the momentum that the free object has, and the trace of a scene can be replayed to the bit.
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

cp "$model" "$build/small-cube.h5"
sed -e 's/^engine = .*/engine = "modal"/' -e 's/^name = .*/&\nangular_velocity = [1, 2, 3]/' \
  "$tree/share/irdm/configs/scenes/small-cube-dense.toml" >"$build/scene.toml"
"$build/scene" "$build/scene.toml" "$build/trace.h5"
replayed=$("$tree/bin/irdm-replay" "$build/trace.h5" --from inputs --rate 10 --csv "$build/run.csv")
[[ $replayed == *"500 steps"*"velocity 0 m/s, angular velocity 0 rad/s"* ]] || { echo "$replayed" >&2; exit 1; }
