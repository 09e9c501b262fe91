#!/usr/bin/env bash
# Applies the small changes of tests/mutations.txt one after the other to a copy of the sources and says which of them
# the tests see. The copy and its build are in build/mutations; the sources here are never changed.
#   scripts/mutate.sh [--limit SECONDS] [NAME...]    a test program has 600 s; names as in the list, or with a *
# Ends with 0 when at least 95 % were killed and all could be built. Half an hour on two processors, and a build.
set -euo pipefail
cd "$(dirname "$0")/.."
exec python3 scripts/mutate.py "$@"
