#!/usr/bin/env bash
# Builds and runs the benchmarks: bench/run.sh [GB of memory that dense models may take, 3 unless given]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/build.sh release
echo "## Force step"
build/release/bin/bench_force_step "${1:-3}"
echo
echo "## Contacts"
build/release/bin/bench_contact_step
echo
echo "## Contact solved at the bridge"
build/release/bin/bench_foresee
echo
echo "## Deformation"
build/release/bin/bench_deformation
echo
echo "## Viewers"
mkdir -p out/bench
[ -f out/bench/paper-cube.h5 ] ||
  build/release/bin/irdm-precompute configs/models/paper-cube.toml -o out/bench/paper-cube.h5 >out/bench/paper-cube.log
build/release/bin/bench_viewer_load out/bench/paper-cube.h5
echo
echo "## Reconnects"
build/release/bin/bench_reconnect
