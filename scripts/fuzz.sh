#!/usr/bin/env bash
# Gives every parser bytes of the fuzzer's choice (docs/fuzzing.md) and fails when one does not stand them. What was
# found worth keeping, and what brought a parser down, is in out/fuzz.
#   scripts/fuzz.sh [SECONDS [PARSER ...]]    SECONDS for each parser, 60 unless given
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
[[ $seconds =~ ^[0-9]+$ ]] || { echo "usage: scripts/fuzz.sh [SECONDS [PARSER ...]]" >&2; exit 2; }
shift || true
lists=build/fuzz/tests/fuzz
scripts/build.sh fuzz fuzzers
build/fuzz/bin/write_fuzz_seeds "$lists/seeds"

parsers=("$@")
if [ ${#parsers[@]} -eq 0 ]; then
  for list in "$lists"/*.seeds; do parsers+=("$(basename "$list" .seeds)"); done
fi
found=0
for parser in "${parsers[@]}"; do
  [ -f "$lists/$parser.seeds" ] || { echo "fuzz: there is no parser $parser" >&2; exit 2; }
  out=out/fuzz/$parser
  mkdir -p "$out/corpus"
  mapfile -t seeds <"$lists/$parser.seeds"
  options=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=8192 -artifact_prefix="$out/" -print_final_stats=1)
  dictionary=$(cat "$lists/$parser.dictionary")
  [ -z "$dictionary" ] || options+=(-dict="$dictionary")
  if build/fuzz/bin/fuzz_"$parser" "${options[@]}" "$out/corpus" "${seeds[@]}" >"$out/log" 2>&1; then
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/log")
    echo "fuzz: $parser stood $runs inputs; $(find "$out/corpus" -type f | wc -l) kept"
  else
    echo "fuzz: $parser FAILED: $(grep -m1 -E 'ERROR|runtime error|it does not hold|Test unit written' "$out/log")" >&2
    echo "fuzz: $(grep -m1 'Test unit written' "$out/log" || echo "see $out/log")" >&2
    found=1
  fi
done
exit $found
