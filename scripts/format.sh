#!/usr/bin/env bash
# Formats the C++ sources with clang-format 14, Debian 12's; with --check only says which are not formatted. Other
# versions format otherwise: with one of them the check is skipped with a line.
set -euo pipefail
cd "$(dirname "$0")/.."

version=14
program=$(command -v "clang-format-$version" || command -v clang-format || true)
arguments=(-i)
if [ "${1:-}" = --check ]; then
  arguments=(--dry-run --Werror)
  if [ -z "$program" ] || ! "$program" --version | grep -q "version $version\."; then
    echo "format: not checked, clang-format $version is not here"
    exit 0
  fi
fi
[ -n "$program" ] || { echo "format: no clang-format; install clang-format $version" >&2; exit 1; }
find bench c_interface common device_bridge examples precompute python replay ros_bridge scene server simulation tests trace viewer -name '*.cpp' -print0 -o -name '*.hpp' -print0 |
  xargs -0 "$program" "${arguments[@]}"
