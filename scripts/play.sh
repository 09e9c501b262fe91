#!/usr/bin/env bash
# Builds what irdm-play (beside this file) needs, and plays a scene of configs/scenes with it, in out/SCENE.
#   scripts/play.sh SCENE [--lockstep] [--once] [--no-frames] [--out FOLDER] [--preset PRESET]  none: a list
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release plays=no arguments=()
while [ $# -gt 0 ]; do
  case $1 in
    --preset) preset=${2:?play: --preset needs a name}; shift ;;
    *)
      [ ! -f "configs/scenes/$1.toml" ] || plays=yes
      arguments+=("$1")
      ;;
  esac
  shift
done
export IRDM_PROGRAMS=$PWD/build/$preset/bin IRDM_DATA=$PWD
if [ $plays = yes ]; then
  command -v gmsh >/dev/null || scripts/setup.sh --run
  scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge irdm-replay ||
    { echo "play: the build failed; see scripts/setup.sh" >&2; exit 1; }
fi
exec scripts/irdm-play "${arguments[@]}"
