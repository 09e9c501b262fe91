#!/usr/bin/env bash
# Builds and runs the benchmarks: bench/run.sh [LARGEST CUBE OF THE FORCE STEP, cells an edge; 58 unless given]
# The tables go to the terminal and to out/bench/report.md, their numbers, with what the machine is, to
# out/bench/*.json, and the plots over the size of the object to out/bench/scaling.png.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${IRDM_BENCH_PRESET:-release}
scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge irdm-replay benchmarks
bin=build/$preset/bin
export IRDM_BENCH_JSON=out/bench
mkdir -p "$IRDM_BENCH_JSON"
model=out/bench/paper-cube.h5
[ -f "$model" ] || "$bin/irdm-precompute" configs/models/paper-cube.toml -o "$model" >out/bench/paper-cube.log

part() {  # TITLE COMMAND...
  echo
  echo "## $1"
  echo
  "${@:2}"
}

{
  part "Machine" "$bin/bench_machine"
  part "Deformation" "$bin/bench_deformation"
  part "Force step" "$bin/bench_force_step" "${1:-58}"
  part "Implicit finite elements" "$bin/bench_implicit_fem"
  part "Round trip" "$bin/bench_round_trip" "$model"
  part "Contacts" "$bin/bench_contact_step"
  part "Contact solved at the bridge" "$bin/bench_predict_horizon"
  part "Viewers" "$bin/bench_viewer_load" "$model"
  part "Reconnects" "$bin/bench_reconnect"
  part "Scaling" bench/scaling.py out/bench "$bin"
} | tee out/bench/report.md
