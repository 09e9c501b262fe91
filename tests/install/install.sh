#!/usr/bin/env bash
# install.sh CMAKE BUILD TREE: installs, and moves what came of it to TREE.
set -euo pipefail
cmake=$1 build=$2 tree=$3

rm -rf "$tree" "$tree.first"
"$cmake" --install "$build" --prefix "$tree.first" >/dev/null
mv "$tree.first" "$tree"
# The source folder, in which the build folder is, may not be named in what is installed as text.
if grep -rIl -e "$(cd "$(dirname "$0")/../.." && pwd)" "$tree"; then
  echo "the files above name a folder of this machine" >&2
  exit 1
fi

# Of a folder in which nothing is built: one message that says so.
(cd "$(dirname "$0")/../.." && "$cmake" --preset release -B "$tree.empty" -DIRDM_BUILD_TESTS=OFF >/dev/null)
if "$cmake" --install "$tree.empty" --prefix "$tree.first" >"$tree.log" 2>&1; then
  echo "nothing is built, and it was installed" >&2
  exit 1
fi
tr '\n' ' ' <"$tree.log" | tr -s ' ' | grep -q "irdm: not built: irdm-precompute, irdm-server, irdm-bridge, irdm-replay; build everything first" ||
  { cat "$tree.log" >&2; exit 1; }
rm -rf "$tree.empty" "$tree.first"
