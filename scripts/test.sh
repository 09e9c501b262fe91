#!/usr/bin/env bash
# Sets up, builds and runs the tests that are quick: a stranger's check. Says every 15 seconds how far it has come; all
# that tests print is in build/PRESET-tests.log.
#   scripts/test.sh [--all | --exhaustive]
#     --all: what continuous integration runs. First the quick tests under the address and undefined-behaviour sanitizers
#            and under the thread sanitizer, and the fuzzers; then all tests, the slow ones, too, with warnings as errors,
#            MPI and SLEPc (preset ci); checks the formatting
#     --exhaustive: the tests that repeat others with more cases, finer meshes or longer runs (label "exhaustive")
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/progress.sh

all=no
preset=release
chosen=(--label-exclude 'slow|exhaustive')
case "${1:-}" in
  "") ;;
  --all) all=yes preset=ci chosen=(--label-exclude exhaustive) ;;
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
  echo "test: waits for the build of preset $1, after $SECONDS s"
  wait "${job[$1]}" || status=$?
  unset "job[$1]"
  cat "$ahead/$1"
  return $status
}

# run_tests PRESET OPTION...: says what failed and ctest's summary. Returns ctest's status.
run_tests() {
  local preset=$1 status=0 log=build/$1-tests.log
  echo "test: preset $preset, after $SECONDS s (log: $log)"
  follow "test" "$log" '^ *([0-9]+)\/([0-9]+) Test .*' ctest --preset "$@" || status=$?
  # Blocks of the tests that failed, and all from the summary on.
  awk '/^ *[0-9]+\/[0-9]+ Test /{show = /\*\*\*(Failed|Exception|Timeout)|Not Run/} /^[0-9]+% tests passed/{show = 1} show' "$log"
  return $status
}

if [ $all = yes ]; then
  echo "test: sets up; builds and runs the quick tests under two sanitizers, fuzzes, then runs all tests: $(about 3600) here"
  scripts/setup.sh --all
  echo "format: checking"
  scripts/format.sh --check
else
  echo "test: sets up, builds all programs and tests, runs those that are quick: $(about 1100) here"
  scripts/setup.sh
fi
echo "includes: checking"
scripts/check_includes.py
if [ $all = yes ]; then
  # Tests labelled "slow" measure or play for long and find nothing new under a sanitizer.
  scripts/build.sh asan
  build_ahead tsan
  build_ahead ci tsan
  run_tests asan --label-exclude 'slow|exhaustive' --parallel 2
  echo "test: fuzzers, after $SECONDS s"
  IRDM_FUZZ_SEED=1 IRDM_FUZZ_AT_ONCE=$((2 * $(nproc))) scripts/fuzz.sh 5
  finish tsan
  run_tests tsan --label-exclude 'slow|exhaustive' --parallel 2
  finish ci
else
  scripts/build.sh $preset
fi
# Under sanitizers some tests cannot run; here all must that the machine and its packages allow.
run_tests $preset "${chosen[@]}" --parallel 4 --output-junit tests.xml --test-output-size-passed 1000000
scripts/check_left_out.py build/$preset/tests.xml $([ $all = yes ] || echo --quick)
