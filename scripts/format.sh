#!/usr/bin/env bash
# Formats the C++ sources; with --check only says which are not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[ "${1:-}" = --check ] && arguments=(--dry-run --Werror)
git ls-files -z --cached --others --exclude-standard '*.cpp' '*.hpp' |
  xargs -0 clang-format-14 "${arguments[@]}"
