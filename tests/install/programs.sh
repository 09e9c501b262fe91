#!/usr/bin/env bash
# programs.sh TREE: the installed programs find their page and their configurations from where they are.
set -euo pipefail
tree=$1
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$work"' EXIT

scenes=$("$tree/bin/irdm-play" --help | sed -n '/^Scenes:/,$p')
grep -q '^  pinch ' <<<"$scenes" || { echo "irdm-play does not know the scene pinch: $scenes" >&2; exit 1; }

cp "$tree/share/irdm/configs/scenes/press.toml" "$work/scene.toml"
sed 's/cells = .*/cells = [2, 2, 2] }/' "$tree/share/irdm/configs/models/soft-cube.toml" >"$work/model.toml"
"$tree/bin/irdm-precompute" "$work/model.toml" -o "$work/soft-cube.h5" >/dev/null 2>&1
cd "$work"
"$tree/bin/irdm-server" scene.toml >log 2>&1 &
server=$!
until page=$(sed -n 's/^listening on \(http\)/\1/p' log) && [ -n "$page" ]; do
  kill -0 "$server" || { cat log >&2; exit 1; }
  sleep 0.1
done
text=$(/usr/bin/python3 -c 'import sys, urllib.request as u; print(u.urlopen(sys.argv[1]).read().decode())' "$page")
if [ ! -d "$tree/share/irdm/viewer" ]; then
  echo "test left out: the page was not built"
elif [[ $text != *'<script'* ]]; then
  echo "that is not the page: $text" >&2
  exit 1
fi
