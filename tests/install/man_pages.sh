#!/usr/bin/env bash
# man_pages.sh TREE: every program and subcommand has a man page, and it names every option of --help.
set -euo pipefail
tree=$1
pages=$tree/share/man/man1
[ -d "$pages" ] || { echo "test left out: no help2man"; exit 0; }

check() {
  local page=$pages/$1.1.gz options option text
  shift
  [ -f "$page" ] || { echo "there is no $page" >&2; exit 1; }
  # What `whatis` goes by.
  zcat "$page" | grep -A1 '^\.SH NAME' | grep -q "^$(basename "$page" .1.gz) " || { echo "$page has another name" >&2; exit 1; }
  text=$(zcat "$page" | sed 's/\\-/-/g; s/\\f[BRI]//g')
  options=$("$@" --help | sed -n '/^Options:/,/^$/s/^  \(-[^ ]*\).*/\1/p' | tr ',' '\n')
  for option in $options; do
    grep -qF -e "$option" <<<"$text" || { echo "$page lacks $option" >&2; exit 1; }
  done
}

for program in "$tree"/bin/*; do
  name=$(basename "$program")
  check "$name" "$program"
  for command in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'); do
    check "$name-$command" "$program" "$command"
  done
done
