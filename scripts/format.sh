#!/usr/bin/env bash
# Formats the C++ sources; with --check only says which are not formatted.
set -euo pipefail
cd "$(dirname "$0")/.."

arguments=(-i)
[ "${1:-}" = --check ] && arguments=(--dry-run --Werror)
find bench c_interface common device_bridge examples precompute python replay ros_bridge scene server simulation tests trace viewer -name '*.cpp' -print0 -o -name '*.hpp' -print0 |
  xargs -0 clang-format-14 "${arguments[@]}"
