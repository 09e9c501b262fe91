#!/usr/bin/env bash
# Man pages of programs and of their subcommands, made from --help by help2man.
#   man_pages.sh FOLDER VERSION PROGRAM...
set -euo pipefail

folder=$1 version=$2
shift 2
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(date +%s)} LC_ALL=C
rm -rf "$folder"
mkdir -p "$folder"

# page NAME COMMAND: its first sentence is the name's line.
page() {
  local name=$1 command=$2 help line
  help=$($command --help)
  line=$(sed -n '/[^[:space:]]/{s/\.$//;p;q}' <<<"$help")
  # Subcommands have no --version of their own.
  help2man --no-info --section=1 --manual=irdm --source="irdm $version" --version-string="$version" \
    --name="$line" --include="$(dirname "$0")/man_sections.h2m" --output="$folder/$name.1" "$command"
  # Of "irdm-precompute check" help2man makes two words, of which man knows nothing.
  sed -i -e "s/^\.TH .* \"1\" /.TH ${name^^} \"1\" /" -e "/^\.SH NAME/{n;s/^.* \\\\-/$name \\\\-/}" "$folder/$name.1"
  gzip -9n "$folder/$name.1"
}

for program in "$@"; do
  name=$(basename "$program")
  page "$name" "$program"
  # "  merge      Joins slices ..." below "Subcommands:"
  for subcommand in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p'); do
    page "$name-$subcommand" "$program $subcommand"
  done
done
