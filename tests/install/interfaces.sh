#!/usr/bin/env bash
# interfaces.sh TREE CC MODEL PYTHON: the C example and the Python package, from the installed files, press the same
# cube; what the stylus gave it is the momentum that it has, and both say the same.
set -euo pipefail
tree=$1 cc=$2 model=$3 python=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$model" "$work/cube.h5"
cat >"$work/scene.toml" <<'EOF'
[[object]]
model = "cube.h5"
[[stylus]]
radius = 0.02
coupling_stiffness = 500
EOF
export LD_LIBRARY_PATH=$tree/lib PKG_CONFIG_PATH=$tree/lib/pkgconfig

read -ra flags < <(pkg-config --cflags --libs irdm)
"$cc" -std=c99 -Wall -Wextra -Wpedantic -Werror "$tree/share/irdm/examples/c/press.c" -o "$work/press" "${flags[@]}"
"$work/press" "$work/scene.toml" | tee "$work/c.txt"
# No other symbol leaves the library.
others=$(nm -D --defined-only "$tree/lib/libirdm.so.1" | awk '{ print $3 }' | grep -v '^irdm_' || true)
[ -z "$others" ] || { echo "libirdm.so has the symbols $others" >&2; exit 1; }
! "$work/press" "$work/nowhere.toml" 2>"$work/error" && grep -q '^press: error: .*nowhere.toml' "$work/error"

# The same as a stylus of a server: in lockstep the same forces; in real time it ends well.
"$cc" -std=c99 -Wall -Wextra -Wpedantic -Werror "$tree/share/irdm/examples/c/stylus.c" -o "$work/stylus" "${flags[@]}"
serve() {
  exec {server}< <(cd "$work" && exec "$tree/bin/irdm-server" scene.toml --port 0 --no-viewer "$@")
  server_pid=$!
  while read -r -u "$server" line; do
    [[ $line != "listening on "* ]] || { address=${line##* }; return; }
  done
  echo "irdm-server did not begin" >&2
  exit 1
}
serve --lockstep
"$work/stylus" "$address" lockstep | tee "$work/lockstep.txt"
wait "$server_pid"
diff <(awk '/ s /{ print $3 }' "$work/c.txt") <(awk '{ print $2 }' "$work/lockstep.txt")
serve
"$work/stylus" "$address" | tee "$work/real_time.txt"
kill "$server_pid"
wait "$server_pid"
[ "$(wc -l <"$work/real_time.txt")" = 8 ]
! "$work/stylus" "${address%:*}:1" 2>"$work/error" && grep -q '^stylus: error: .*:1: ' "$work/error"

cd "$work"
env -u LD_LIBRARY_PATH PYTHONPATH="$tree/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 "$python" - <<'EOF'
import irdm

assert {line.name: line.verdict for line in irdm.check("cube.h5")}["checksum"] == "ok"
mass = irdm.Model.open("cube.h5").mass
simulation = irdm.Simulation("scene.toml")
impulse = 0.0
for k in range(400):
    step = simulation.step([[0.0, 0.075 - min(0.0001 * k, 0.02), 0.0]])
    impulse -= step.styluses["force"][0, 1] * simulation.dt
velocity = step.objects["velocity"][0, 1]
said = open("c.txt").read().splitlines()[-1]
assert said == f"impulse {impulse:.9f} N s, velocity {velocity:.9f} m/s", (said, impulse, velocity)
assert impulse < -1e-3 and abs(impulse - mass * velocity) < 1e-12
EOF
