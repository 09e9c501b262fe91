#!/usr/bin/env bash
# How small dense R gets and how far off its forces then are (docs/theory.md):
#   bench/compression.sh [CELLS [OPTIONS OF irdm-precompute compress]]
# The cube of configs/models/small-cube.toml with CELLS linear cells an edge: 9 unless given (4.3 GB, some 20
# minutes).
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${IRDM_BENCH_PRESET:-release}
scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge irdm-replay benchmarks
bin=build/$preset/bin
cells=${1:-9}
shift || true
out=out/bench/compression
mkdir -p "$out"
model=$out/cube-$cells
sed -e "s/cells = .*/cells = [$cells, $cells, $cells] }\norder = 1/" -e 's/storage = .*/storage = "dense"/' \
  configs/models/small-cube.toml >"$model.toml"
[ -f "$model.h5" ] || "$bin/irdm-precompute" "$model.toml" -o "$model.h5"
"$bin/irdm-precompute" compress "$model.h5" -o "$model-small.h5" "$@"
"$bin/bench_compression" "$model.h5" "$model-small.h5" compressed
