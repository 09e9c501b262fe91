#!/usr/bin/env bash
# csharp.sh TREE CC MODEL: the C# example says what the C example says, both from the installed files.
set -euo pipefail
command -v mcs >/dev/null || { echo "test left out: no mcs"; exit 0; }
tree=$1 cc=$2 model=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$model" "$work/cube.h5"
cat >"$work/scene.toml" <<'END'
[[object]]
model = "cube.h5"
[[stylus]]
radius = 0.02
coupling_stiffness = 500
END
export LD_LIBRARY_PATH=$tree/lib PKG_CONFIG_PATH=$tree/lib/pkgconfig

read -ra flags < <(pkg-config --cflags --libs irdm)
"$cc" -std=c99 "$tree/share/irdm/examples/c/press.c" -o "$work/press" "${flags[@]}"
"$work/press" "$work/scene.toml" >"$work/c.txt"
mcs -warnaserror -out:"$work/Press.exe" "$tree/share/irdm/examples/csharp/Press.cs"
mono "$work/Press.exe" "$work/scene.toml" | tee "$work/csharp.txt"
diff <(sed 's/  *[0-9]* contacts$//' "$work/c.txt") "$work/csharp.txt"
