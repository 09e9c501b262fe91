#!/usr/bin/env bash
# The main job from nothing: sets up, builds, precomputes the paper's cube (kept for the next time), plays
# ten scripted seconds in real time with server and bridge as two processes, and shows what came of it.
# Then it keeps the cube on a soft tether until Ctrl-C, to be pushed with the mouse in a browser. The first time this can
# be done while the bridge is built, too. Packages that compiling does not need are installed while it goes on.
#   scripts/demo.sh [--dense] [--once]
#     --dense: the paper's own engine on the cube's smaller sibling
#     --once: ends after the ten seconds
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/progress.sh

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
others= precomputing= building=
stop_children() {
  local child
  for child in $server $others $precomputing $building; do kill "$child" 2>/dev/null || true; done
}
trap stop_children EXIT

# The first time only what these three programs need is configured. A build folder that was configured for all stays so.
lean=(-DIRDM_BUILD_TESTS=OFF -DIRDM_BUILD_BENCH=OFF -DIRDM_BUILD_PYTHON=OFF -DIRDM_WITH_ROS_BRIDGE=OFF)
settings=build/release/.settings
if [ -f $settings ] && [ -z "$(cat $settings)" ]; then lean=(); fi
build() { scripts/build.sh release ${lean[@]+"${lean[@]}"} "$@"; }

config=configs/models/$model.toml
# The model is made again when its configuration is newer.
start_precompute() {
  if [ -f "$out/$model.h5" ] && [ ! "$config" -nt "$out/$model.h5" ]; then
    echo "demo: $out/$model.h5 is there from the last time"
    return
  fi
  echo "demo: precomputing $model (log: $out/precompute.log)"
  "$bin/irdm-precompute" "$config" -o "$out/$model.h5" >"$out/precompute.log" 2>&1 &
  precomputing=$!
}
finish_precompute() {
  [ -n "$precomputing" ] || return 0
  wait $precomputing || fail "precomputation failed" "$out/precompute.log"
  precomputing=
  cat "$out/precompute.log"
}

# until_built PROGRAM: waits while the build goes on; its own messages say what fails.
until_built() {
  until [ -x "$bin/$1" ]; do
    kill -0 $building 2>/dev/null || [ -x "$bin/$1" ] || fail "$1 was not built"
    sleep 0.5
  done
}

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


page=
if [ -x "$bin/irdm-bridge" ]; then
  scripts/setup.sh --demo
  if [ ${#lean[@]} -gt 0 ]; then lean+=(-DIRDM_BUILD_PAGE=ON); fi
  build irdm-precompute irdm-server irdm-bridge
  start_precompute
  finish_precompute
else
  echo "demo: installs packages, builds three programs, computes the cube, plays ten seconds: $(about 600) here"
  scripts/setup.sh --build
  # What only the page and the plot need is installed while programs are compiled, and the model is computed while the
  # server is built.
  scripts/setup.sh --demo >"$out/setup.log" 2>&1 &
  others=$!
  build -DIRDM_BUILD_PAGE=OFF irdm-precompute irdm-server irdm-bridge &
  building=$!
  until_built irdm-precompute
  start_precompute
  until_built irdm-server
  wait $others || fail "the setup failed" "$out/setup.log"
  others=
  node viewer/page/build.mjs --out build/release/share/irdm/viewer >"$out/page.log" 2>&1 ||
    fail "the page was not built" "$out/page.log"
  finish_precompute
  if [ $once = no ]; then
    start_live
    echo "demo: the cube is at $page, to be pushed with the mouse, after $SECONDS s; next the bridge is built"
  fi
  wait $building || fail "the bridge was not built"
  building=
  if [ $once = no ]; then
    kill -TERM "$server"
    wait "$server" || fail "the server failed" "$out/live.log"
    server=
  fi
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
