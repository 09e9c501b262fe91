#!/usr/bin/env bash
# Sets up, builds and tests everything: formatting, warnings as errors, the tests under the address and
# undefined-behaviour sanitizers and under the thread sanitizer, the fuzzers, and last the whole suite as it ships.
#   scripts/test.sh [--quick]    --quick: without the sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

quick=no
case "${1:-}" in
  "") ;;
  --quick) quick=yes ;;
  *) echo "usage: scripts/test.sh [--quick]" >&2; exit 2 ;;
esac

scripts/setup.sh
echo "format: checking"
scripts/format.sh --check
scripts/build.sh ci
if [ $quick = no ]; then
  # Tests labelled "slow" measure or play for long and find nothing new under a sanitizer.
  for preset in asan tsan; do
    scripts/build.sh "$preset"
    echo "test: preset $preset"
    ctest --preset "$preset" --label-exclude slow --parallel 2
    [ "$preset" != asan ] || IRDM_FUZZ_SEED=1 scripts/fuzz.sh 10
  done
fi
echo "test: preset ci"
ctest --preset ci --parallel 2
