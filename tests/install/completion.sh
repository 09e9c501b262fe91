#!/usr/bin/env bash
# completion.sh TREE: bash is offered the options that --help lists, the subcommands, and the values of a choice.
set -euo pipefail
tree=$1
PATH=$tree/bin:$PATH

offered() {  # the words so far, the last one being completed
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _irdm "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
  printf '%s\n' "${COMPREPLY[@]}" | sort
}
expect() {  # what is expected, then the words
  local wanted=$1 found
  shift
  found=$(offered "$@")
  [ "$found" = "$(sort <<<"$wanted")" ] || { echo "$*: offered"; echo "$found"; echo "but not"; echo "$wanted"; exit 1; } >&2
}
# Another way to read the help than the completion's own: every word of it that looks like a long option at the
# beginning of a line.
long_options() { "$@" --help | awk '/^  -/ { n = split($1, all, ","); print all[n] }'; }

for program in "$tree"/bin/*; do
  name=$(basename "$program")
  source "$tree/share/bash-completion/completions/$name"
  expect "$(long_options "$name")" "$name" --
done
subcommands=$(irdm-precompute --help | awk 'listed && NF { print $1 } /^Subcommands:/ { listed = 1 }')
[[ $subcommands == *compress* ]]
expect "$subcommands" irdm-precompute ""
expect "$(long_options irdm-precompute compress)" irdm-precompute compress --
expect "$(printf '%s\n' modal time-stepping)" irdm-precompute --method ""
expect forces irdm-replay --from f
expect "$(printf '%s\n' paper-cube peg pinch press)" irdm-play p
expect "" irdm-server scen
