#!/usr/bin/env bash
# Other engines beside irdm: bench/engines/run.sh
# Two soft cubes pressed together, and the gallery's peg, in irdm, MuJoCo, Jolt (npm) and Bullet (libbullet-dev);
# each engine that is missing is left out, with a line that names it. Times are processor time of a step. The tables
# go to the terminal; out/engines holds what is installed and written.
set -euo pipefail
cd "$(dirname "$0")/../.."
preset=${IRDM_BENCH_PRESET:-release}
here=bench/engines
out=out/engines
bin=build/$preset/bin
export OMP_NUM_THREADS=1
mkdir -p "$out"
scripts/build.sh "$preset" bench_engines
"$bin/bench_engines" --scenes "$out/scenes.json"
rm -f "$out/rows"

left_out() { echo "left out: $1" >&2; }

engine() {  # COMMAND...
  "$@" >>"$out/rows" || left_out "$* failed"
}

engine "$bin/bench_engines"
if pkg-config --exists bullet 2>/dev/null; then
  # Its headers are old: no warnings of them.
  read -ra flags <<<"$(pkg-config --cflags --libs bullet)"
  g++ -std=c++20 -O2 -w -I. "$here/bullet.cpp" "${flags[@]}" -o "$out/bullet"
  engine "$out/bullet" "$out/scenes.json"
else
  left_out "Bullet; apt-get install libbullet-dev"
fi
if command -v npm >/dev/null; then
  cp "$here"/{package.json,package-lock.json,.npmrc,*.mjs} "$out"
  if (cd "$out" && npm ci --silent); then
    engine node "$out/jolt.mjs" "$out/scenes.json"
    engine node "$out/mujoco.mjs" "$out/scenes.json"
  else
    left_out "Jolt and MuJoCo: npm could not install them"
  fi
else
  left_out "Jolt and MuJoCo; apt-get install npm"
fi

table() {  # SCENE HEADER
  printf '\n%s\n%s\n' "$2" "| --- | --- | --- | --- | --- | --- |"
  sed -n "s/^$1 //p" "$out/rows"
}
table press "| cubes | dt, ms | step, us | approach | error of force | penetration, mm |"
table peg "| peg | dt, ms | step, us | peak | at the end | penetration, mm |"
