#!/usr/bin/env bash
# Gives every parser bytes of the fuzzer's choice (docs/contributing.md), as many parsers at a time as there are processors,
# and fails when one does not stand them. What was found worth keeping, and what brought a parser down, is in out/fuzz.
#   scripts/fuzz.sh [SECONDS [PARSER ...]]    SECONDS for each parser, 60 unless given
# IRDM_FUZZ_SEED=N makes every run begin with the same inputs; else no two do. IRDM_FUZZ_AT_ONCE=N: so many at a time.
#   scripts/fuzz.sh --keep [PARSER ...]       adds to the seeds what reaches more of the program than they do
#   scripts/fuzz.sh --coverage                which lines of the decoders the seeds reach; fails below 95 %
set -euo pipefail
cd "$(dirname "$0")/.."

lists=build/asan/tests/fuzz
# A corpus of short inputs is small; a contact model has 4072 bytes.
longest_kept=4200
# A disk would be waited for at every input.
[ ! -w /dev/shm ] || export TMPDIR=/dev/shm
# For leaks inside HDF5.
export LSAN_OPTIONS=suppressions=$PWD/tests/support/leaks.supp:print_suppressions=0

usage() {
  sed -n 's/^#   //p' "$0" >&2
  exit 2
}

build() {
  scripts/build.sh asan fuzzer write_fuzz_seeds
  build/asan/bin/write_fuzz_seeds "$lists/seeds"
}

all_parsers() {
  for list in "$lists"/*.seeds; do basename "$list" .seeds; done
}

# Options that every use of a parser's fuzzer needs.
set_options() {
  local dictionary
  dictionary=$(cat "$lists/$1.dictionary")
  options=(-timeout=10 -rss_limit_mb=2048 -artifact_prefix="out/fuzz/$1/")
  [ -z "$dictionary" ] || options+=(-dict="$dictionary")
}

fuzz() {
  local seconds=$1 parser=$2 out=out/fuzz/$2 runs options seeds
  [ -f "$lists/$parser.seeds" ] || { echo "fuzz: there is no parser $parser" >&2; return 1; }
  mkdir -p "$out/corpus"
  mapfile -t seeds <"$lists/$parser.seeds"
  set_options "$parser"
  touch "$out/began"
  if IRDM_FUZZ_HARNESS=$parser build/asan/bin/fuzzer "${options[@]}" -max_total_time="$seconds" -max_len=8192 -seed="${IRDM_FUZZ_SEED:-0}" \
      -print_final_stats=1 \
      "$out/corpus" "${seeds[@]}" >"$out/log" 2>&1; then
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/log")
    echo "fuzz: $parser stood $runs inputs; $(find "$out/corpus" -type f | wc -l) kept"
  else
    {
      echo "fuzz: $parser FAILED; $out/log ends:"
      tail -n 50 "$out/log" | grep -v '^#[0-9]'
      find "$out" -maxdepth 1 -newer "$out/began" -name '*-*' -printf 'fuzz: the input, %f, by base64:\n' -exec base64 {} \;
    } >&2
    return 1
  fi
}

keep() {
  local parser=$1 kept=tests/fuzz/seeds/$1 options seeds before
  before=$(mktemp -d)
  mapfile -t seeds <"$lists/$parser.seeds"
  find "${seeds[@]}" -type f -exec sh -c 'cp "$1" "$2/$(sha1sum <"$1" | cut -c1-40)"' sh {} "$before" \;
  ls "$before" >"$before.list"
  set_options "$parser"
  IRDM_FUZZ_HARNESS=$parser build/asan/bin/fuzzer "${options[@]}" -merge=1 -use_counters=0 -max_len=$longest_kept \
    "$before" "out/fuzz/$parser/corpus" >"out/fuzz/$parser/log" 2>&1
  mkdir -p "$kept"
  ls "$before" | grep -vxFf "$before.list" | while read -r file; do cp "$before/$file" "$kept/"; done || true
  rm -r "$before" "$before.list"
  echo "fuzz: $parser has $(find "$kept" -type f | wc -l) seeds of its own, $(du -sb "$kept" | cut -f1) bytes"
}

case "${1:-60}" in
  --coverage)
    [ $# -eq 1 ] || usage
    exec scripts/fuzz_coverage.sh
    ;;
  --keep) action=(keep) ;;
  *[!0-9]*) usage ;;
  *) action=(fuzz "${1:-60}") ;;
esac
shift || true
build
export lists longest_kept
export -f fuzz keep set_options
# Strings of a shell each: functions are inherited, arrays are not.
{ [ $# -gt 0 ] && printf '%s\n' "$@" || all_parsers; } |
  xargs -P "${IRDM_FUZZ_AT_ONCE:-$(nproc)}" -I{} bash -euo pipefail -c "${action[*]} {}"
