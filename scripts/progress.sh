# Sourced by the scripts that a person waits for: says every 15 seconds how far a command has come.

# machine_slowness: how many times slower one core is than the one that the scripts' times were taken on, in tenths.
# A loop of the shell, the fastest of five: what else the machine does for a moment is not its speed.
machine_slowness() {
  local i round started took least=
  for round in 1 2 3 4 5; do
    started=${EPOCHREALTIME/[.,]/}
    for ((i = 0; i < 20000; i++)); do :; done
    took=$((${EPOCHREALTIME/[.,]/} - started))
    if [ -z "$least" ] || [ $took -lt $least ]; then least=$took; fi
  done
  echo $((least * 10 / IRDM_REFERENCE_LOOP + 1))
}
IRDM_REFERENCE_LOOP=30000  # microseconds

# about SECONDS: a time on this machine, for people.
about() {
  : "${slowness:=$(machine_slowness)}"
  local seconds=$(($1 * slowness / 10))
  if [ "$seconds" -lt 90 ]; then echo "about $(((seconds + 9) / 10 * 10)) s"; else echo "about $(((seconds + 59) / 60)) min"; fi
}

# follow LABEL LOG PATTERN COMMAND...: runs COMMAND with its output in LOG. PATTERN is a regular expression of the words
# "DONE/ALL" that the command counts its steps with, DONE and ALL being its two groups for sed. Returns its status.
follow() {
  local label=$1 log=$2 pattern=$3 started=$SECONDS said=$SECONDS status=0 process count left
  shift 3
  "$@" >"$log" 2>&1 &
  process=$!
  trap "kill $process 2>/dev/null" TERM
  while kill -0 $process 2>/dev/null; do
    sleep 0.5
    [ $((SECONDS - said)) -ge 15 ] || continue
    said=$SECONDS
    count=$(tail -c 20000 "$log" | tr '\r' '\n' | sed -nE "s,$pattern,\\1 \\2,p" | tail -n 1)
    set -- $count
    left=
    if [ $# -eq 2 ] && [ "$1" -gt 0 ] && [ $((SECONDS - started)) -ge 20 ]; then
      left=", some $(((SECONDS - started) * ($2 - $1) / $1)) s left"
    fi
    echo "$label: ${count:+$1 of $2, }$((SECONDS - started)) s$left"
  done
  wait $process || status=$?
  trap - TERM
  return $status
}
