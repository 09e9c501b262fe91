#!/usr/bin/env bash
# Sets up, builds and runs the suite as it ships; checks the formatting.
#   scripts/test.sh [--all | --exhaustive]
#     --all: first the tests under the address and undefined-behaviour sanitizers and under the thread sanitizer, and the
#            fuzzers; then the suite with warnings as errors, MPI and SLEPc (preset ci)
#     --exhaustive: instead of the suite the tests that repeat others of it very often (label "exhaustive")
set -euo pipefail
cd "$(dirname "$0")/.."

all=no
preset=release
chosen=(--label-exclude exhaustive)
case "${1:-}" in
  "") ;;
  --all) all=yes ;;
  --exhaustive) chosen=(--label-regex exhaustive) ;;
  *) echo "usage: scripts/test.sh [--all | --exhaustive]" >&2; exit 2 ;;
esac

# The next builds go on while tests wait for something and fuzzers have their time; they never take a processor from one.
# They have a process group of their own, which ends with this script, however it ends.
# build_ahead PRESET [PRESET that it comes after]
ahead=$(mktemp -d)
declare -A job
build_ahead() {
  set -m
  {
    if [ $# -gt 1 ]; then tail --pid="${job[$2]}" -f /dev/null; fi
    nice -n 19 scripts/build.sh "$1"
  } >"$ahead/$1" 2>&1 &
  set +m
  job[$1]=$!
}
trap 'for group in "${job[@]}"; do kill -- "-$group" 2>/dev/null || true; done; rm -r "$ahead"' EXIT

finish() {
  local status=0
  wait "${job[$1]}" || status=$?
  unset "job[$1]"
  cat "$ahead/$1"
  return $status
}

run_tests() {
  echo "test: preset $1, after $SECONDS s"
  ctest --preset "$@"
}

scripts/setup.sh
echo "format: checking"
scripts/format.sh --check
echo "includes: checking"
scripts/check_includes.py
if [ $all = yes ]; then
  preset=ci
  # Tests labelled "slow" measure or play for long and find nothing new under a sanitizer.
  scripts/build.sh asan
  build_ahead tsan
  build_ahead ci tsan
  run_tests asan --label-exclude 'slow|exhaustive' --parallel 2
  echo "test: fuzzers, after $SECONDS s"
  IRDM_FUZZ_SEED=1 IRDM_FUZZ_AT_ONCE=$((2 * $(nproc))) scripts/fuzz.sh 10
  finish tsan
  run_tests tsan --label-exclude 'slow|exhaustive' --parallel 2
  finish ci
else
  scripts/build.sh release
fi
# Under sanitizers some tests cannot run; here all must that the machine allows.
run_tests $preset "${chosen[@]}" --parallel 4 --output-junit tests.xml
scripts/check_left_out.py build/$preset/tests.xml
