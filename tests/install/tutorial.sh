#!/usr/bin/env bash
# tutorial.sh TREE: what docs/tutorial.md says, from the installed files: a mesh becomes an object that is pressed and
# held. In lockstep, and with linear elements, which are ten times as fast to compute.
set -euo pipefail
tree=$1
command -v gmsh >/dev/null || { echo "test left out: no gmsh"; exit 0; }
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server" 2>/dev/null || true; rm -rf "$work"' EXIT
cp "$tree"/share/irdm/examples/tutorial/* "$work"
cd "$work"

gmsh -2 ring.geo -o ring.stl >/dev/null
sed -i 's/^order = 2/order = 1/' ring.toml
"$tree/bin/irdm-precompute" ring.toml -o ring.h5 >model.log 2>&1 || { cat model.log >&2; exit 1; }
"$tree/bin/irdm-server" scene.toml --lockstep --no-viewer --record trace.h5 >log 2>&1 &
server=$!
until address=$(sed -n 's/^listening on //p' log) && [ -n "$address" ]; do
  kill -0 "$server" || { cat log >&2; exit 1; }
  sleep 0.1
done
"$tree/bin/irdm-bridge" bridge.toml --server "$address" >bridge.log 2>&1 || { cat bridge.log >&2; exit 1; }
wait "$server"
server=
"$tree/bin/irdm-replay" trace.h5 --csv run.csv >/dev/null
mass=$(sed -n 's/^  mass *\([0-9.]*\) kg/\1/p' model.log)
# Momentum along y during the press, step by step: what the stylus gives goes into the ring's motion, its tether (40 N/m)
# and its damping (2 1/s).
awk -F, -v mass="$mass" -v dt=0.002 '
  NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
  {
    contact = $column["stylus0_contact"]
    velocity = $column["ring_velocity_y_m_s"]
    if ($column["time_s"] < 2) {
      if (contact == 1) ++touched
      given += $column["stylus0_force_y_N"] * dt
      taken -= (40 * $column["ring_position_y_m"] + 2 * mass * velocity) * dt
      last = -mass * velocity
    }
    if (contact == 2) ++held
  }
  END {
    taken += last
    printf "given %.5f N s, taken %.5f N s, touched in %d, held in %d steps\n", given, taken, touched, held
    exit !(touched > 500 && held > 1000 && given > 0.02 && (given - taken) ^ 2 < (0.01 * given) ^ 2)
  }' run.csv
