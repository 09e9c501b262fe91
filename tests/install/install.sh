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
