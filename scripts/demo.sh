#!/usr/bin/env bash
# The main job from nothing: sets up, builds, precomputes the paper's cube (kept for the next time), plays
# ten scripted seconds in real time with server and bridge as two processes, and shows what came of it.
# Then it keeps the cube on a soft tether until Ctrl-C, to be pushed with the mouse in a browser. The first time this can
# be done while the bridge is built, too.
#   scripts/demo.sh [--dense] [--once]
#     --dense: the paper's own engine on the cube's smaller sibling
#     --once: ends after the ten seconds
set -euo pipefail
cd "$(dirname "$0")/.."

model=paper-cube scene=paper-cube
once=no
for option in "$@"; do
  case "$option" in
    --dense) model=small-cube scene=small-cube-dense ;;
    --once) once=yes ;;
    *) echo "usage: scripts/demo.sh [--dense] [--once]" >&2; exit 2 ;;
  esac
done
bin=build/release/bin
out=out/demo
mkdir -p "$out"
server=

fail() {
  echo "demo: $1" >&2
  [ -z "${2:-}" ] || cat "$2" >&2
  exit 1
}
stop_server() { [ -z "$server" ] || kill "$server" 2>/dev/null || true; }
trap stop_server EXIT

scripts/setup.sh --demo
scripts/build.sh release irdm-precompute irdm-server

# The model is made again when its configuration is newer.
config=configs/models/$model.toml
if [ ! -f "$out/$model.h5" ] || [ "$config" -nt "$out/$model.h5" ]; then
  echo "demo: precomputing $model"
  "$bin/irdm-precompute" "$config" -o "$out/$model.h5" || fail "precomputation failed"
else
  echo "demo: $out/$model.h5 is there from the last time"
fi

# The address that a server prints for bridges or, as `page`, for browsers, when it is there.
printed() { sed -n "s/^listening on \\($2\\)/\\1/p" "$out/$1.log"; }

# start_live: a server of the cube on a tether; its page is `page`.
start_live() {
  true >"$out/live.log"
  # The object is the last table of the scene.
  { cat "configs/scenes/$scene.toml"; echo 'tether = { stiffness = 4.0, angular_stiffness = 0.01 }';
    echo 'damping = { linear = 1.0, angular = 1.0 }'; keep_port; } >"$out/live.toml"
  "$bin/irdm-server" "$out/live.toml" --recordings "$out/recordings" >"$out/live.log" 2>&1 &
  server=$!
  until page=$(printed live http) && [ -n "$page" ]; do
    kill -0 "$server" 2>/dev/null || fail "the server did not start" "$out/live.log"
    sleep 0.1
  done
}

# The page stays where it is, so that a browser finds the next server by itself.
keep_port() { [ -z "${page:-}" ] || printf '[viewer]\nport = %s\n' "$(sed 's/.*:\([0-9]*\).*/\1/' <<<"$page")"; }

build_bridge() { nice -n 19 scripts/build.sh release irdm-bridge; }

page=
if [ $once = no ] && [ ! -x "$bin/irdm-bridge" ]; then
  start_live
  echo "demo: the cube is at $page, to be pushed with the mouse; the bridge is being built"
  build_bridge
  kill -TERM "$server"
  wait "$server" || fail "the server failed" "$out/live.log"
  server=
else
  build_bridge
fi

{ cat "configs/scenes/$scene.toml"; keep_port; } >"$out/scene.toml"
rm -f "$out/trace.h5" "$out/force.png"
# What the last time left there names ports that are gone.
true >"$out/server.log"
true >"$out/live.log"

"$bin/irdm-server" "$out/scene.toml" --record "$out/trace.h5" >"$out/server.log" 2>&1 &
server=$!
until address=$(printed server '[^h]') && [ -n "$address" ]; do
  kill -0 "$server" 2>/dev/null || fail "the server did not start" "$out/server.log"
  sleep 0.1
done
page=$(printed server http)
echo "demo: ten seconds in real time: press, tap, grab, swing, let go${page:+; to be watched at $page}"
"$bin/irdm-bridge" configs/bridges/demo.toml --server "$address" >"$out/bridge.log" 2>&1 ||
  fail "the bridge failed" "$out/bridge.log"
kill -TERM "$server"
wait "$server" || fail "the server failed" "$out/server.log"
server=

echo
echo "server"
grep -v -E '^\[|^listening' "$out/server.log" | sed 's/^/  /'
echo "bridge"
grep -v -E '^\[' "$out/bridge.log" | sed 's/^/  /'
/usr/bin/python3 scripts/plot_force.py "$out/trace.h5" "$out/force.png" || fail "the plot failed"
echo
echo "trace    $out/trace.h5"
echo "picture  $out/force.png"
[ $once = no ] || exit 0

echo
start_live
trap 'kill -TERM "$server" 2>/dev/null || true' INT TERM
echo "demo: push the cube with the mouse at $page; Ctrl-C ends it"
# A signal ends the first wait, the server the second one.
wait "$server" || wait "$server" || fail "the server failed" "$out/live.log"
server=
