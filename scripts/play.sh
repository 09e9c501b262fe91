#!/usr/bin/env bash
# Plays a scene of configs/scenes with its scripted styluses, in real time or in lockstep: makes the models that are
# missing, starts server and bridge, records a trace and draws the force on each stylus, all in out/SCENE.
#   scripts/play.sh SCENE [--lockstep] [--preset PRESET]    without SCENE: lists them
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  echo "usage: scripts/play.sh SCENE [--lockstep] [--preset PRESET]; scenes:" >&2
  for file in configs/scenes/*.toml; do
    echo "  $(basename "$file" .toml)  $(sed -n '1s/^# *//p' "$file")" >&2
  done
  exit 2
}
fail() {
  echo "play: $1" >&2
  [ -z "${2:-}" ] || cat "$2" >&2
  exit 1
}

scene="" lockstep="" preset=release
while [ $# -gt 0 ]; do
  case $1 in
    --lockstep) lockstep=--lockstep ;;
    --preset)
      [ -n "${2:-}" ] || usage
      preset=$2
      shift
      ;;
    -*) usage ;;
    *) [ -z "$scene" ] || usage; scene=$1 ;;
  esac
  shift
done
[ -n "$scene" ] || usage
[ -f "configs/scenes/$scene.toml" ] || { echo "play: there is no configs/scenes/$scene.toml" >&2; usage; }

# The bridges of a scene: NAME.toml and, for further ones, NAME-2.toml and so on; some go by another name.
case $scene in
  liver) bridges=(configs/bridges/palpate.toml) ;;
  paper-cube | small-cube-dense) bridges=(configs/bridges/demo.toml) ;;
  *) bridges=(configs/bridges/"$scene"{,-[2-4]}.toml) ;;
esac
for bridge in "${bridges[@]}"; do
  [ -f "$bridge" ] || [[ $bridge == *']'* ]] || fail "there is no $bridge to play $scene"
done

bin=build/$preset/bin
out=out/$scene
models=out/models
mkdir -p "$out" "$models"
scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge || fail "the build failed; see scripts/setup.sh"

# The models that the scene names, each made again when its configuration is newer.
mapfile -t names < <(sed -n 's/^model *= *"\(.*\)\.h5".*/\1/p' "configs/scenes/$scene.toml" | sort -u)
for name in "${names[@]}"; do
  config=configs/models/$name.toml
  [ -f "$config" ] || fail "there is no $config to make the model from"
  if [ ! -f "$models/$name.h5" ] || [ "$config" -nt "$models/$name.h5" ]; then
    echo "play: precomputing $name"
    "$bin/irdm-precompute" "$config" -o "$models/$name.h5" >"$models/$name.log" 2>&1 ||
      fail "precomputation failed" "$models/$name.log"
  fi
  ln -sfn "../models/$name.h5" "$out/$name.h5"
done
cp "configs/scenes/$scene.toml" "$out/scene.toml"
true >"$out/server.log"
rm -f "$out"/trace.h5 "$out"/force-*.png

pids=()
stop() { [ ${#pids[@]} -eq 0 ] || kill "${pids[@]}" 2>/dev/null || true; }
trap stop EXIT
"$bin/irdm-server" "$out/scene.toml" --record "$out/trace.h5" $lockstep >"$out/server.log" 2>&1 &
server=$!
pids+=("$server")
until address=$(sed -n 's/^listening on \([^h]\)/\1/p' "$out/server.log") && [ -n "$address" ]; do
  kill -0 "$server" 2>/dev/null || fail "the server did not start" "$out/server.log"
  sleep 0.1
done
if [ -n "$lockstep" ]; then echo "play: $scene in lockstep"; else echo "play: $scene in real time"; fi
players=()
for bridge in "${bridges[@]}"; do
  [ -f "$bridge" ] || continue
  log=$out/$(basename "$bridge" .toml).log
  "$bin/irdm-bridge" "$bridge" --server "$address" >"$log" 2>&1 &
  players+=("$!:$log")
  pids+=("$!")
done
for player in "${players[@]}"; do
  wait "${player%%:*}" || fail "the bridge failed" "${player#*:}"
done
[ -n "$lockstep" ] || kill -TERM "$server"
wait "$server" || fail "the server failed" "$out/server.log"
pids=()

grep -v -E '^\[|^listening' "$out/server.log" | sed 's/^/  /'
echo "trace    $out/trace.h5"
styluses=$(/usr/bin/python3 -c 'import h5py, sys; print(len(h5py.File(sys.argv[1])["/stylus"]))' "$out/trace.h5" 2>/dev/null) || {
  echo "play: no picture without python3-h5py and python3-matplotlib" >&2
  exit 0
}
for ((s = 0; s < styluses; s++)); do
  /usr/bin/python3 scripts/plot_force.py "$out/trace.h5" "$out/force-$s.png" "$s" || fail "the plot failed"
  echo "picture  $out/force-$s.png"
done
