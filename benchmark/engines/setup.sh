#!/usr/bin/env bash
# Makes the adapters of other engines in out/benchmark: benchmark/engines/setup.sh
# Bullet (libbullet-dev), MuJoCo and Jolt (npm); what is missing is left out, with a line that names it.
set -euo pipefail
cd "$(dirname "$0")/../.."
here=benchmark/engines
out=out/benchmark
mkdir -p "$out"
left_out() { echo "left out: $1" >&2; }

if pkg-config --exists bullet-float64 2>/dev/null; then
  # Its headers are old: no warnings of them.
  read -ra flags <<<"$(pkg-config --cflags --libs bullet-float64)"
  g++ -std=c++20 -O2 -w "$here/bullet.cpp" "${flags[@]}" -o "$out/bullet"
else
  left_out "Bullet; apt-get install libbullet-dev"
fi
if command -v npm >/dev/null; then
  cp "$here"/{package.json,package-lock.json,.npmrc,*.mjs} "$out"
  (cd "$out" && npm ci --silent) || left_out "Jolt and MuJoCo: npm could not install them"
else
  left_out "Jolt and MuJoCo; apt-get install npm"
fi
