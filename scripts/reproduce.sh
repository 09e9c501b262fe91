#!/usr/bin/env bash
# Makes docs/reproduction.md and its figures: the paper's table and figures, and what it could not show. Precomputes,
# plays the gallery's swing and tap in lockstep, replays, makes references by finite elements, compares and draws.
#   scripts/reproduce.sh [--small] [--work FOLDER] [--docs FOLDER] [--preset PRESET]
#     --small: a cube of 6 cells an edge instead of the paper's 12, shorter motions; the page goes to the work folder
#     --work: for models, traces and runs (out/reproduction, with --small out/reproduction-small)
#     --docs: for reproduction.md and images/reproduction (docs)
#     --preset: the build whose programs are used (release); IRDM_PROGRAMS names a folder of finished ones instead
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release cells=12 own_cells=6 work="" docs="" columns=8 substep=0.0005
declare -A end=([swing]=9 [tap]=9) # s, of the motions: as they are
while [ $# -gt 0 ]; do
  case $1 in
    --small) cells=6 own_cells=3 columns=2 substep=0.001 end=([swing]=3.08 [tap]=1.04) ;;
    --work) work=${2:?reproduce: --work needs a folder}; shift ;;
    --docs) docs=${2:?reproduce: --docs needs a folder}; shift ;;
    --preset) preset=${2:?reproduce: --preset needs a name}; shift ;;
    *) sed -n '4,8s/^# *//p' "$0" >&2; exit 2 ;;
  esac
  shift
done
small=""
[ $cells = 12 ] || small=-small
work=${work:-out/reproduction$small}
if [ -n "$small" ]; then docs=${docs:-$work/docs}; else docs=${docs:-docs}; fi
mkdir -p "$work"/{configs/{models,scenes,bridges,scripts},scripts,models} "$docs/images/reproduction"
work=$(realpath "$work")
python="/usr/bin/python3 -B"

fail() {
  echo "reproduce: $1" >&2
  [ -z "${2:-}" ] || tail -n 20 "$2" >&2
  exit 1
}
say() { echo "reproduce: $SECONDS s: $1"; }

if [ -z "${IRDM_PROGRAMS:-}" ]; then
  scripts/setup.sh
  scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge irdm-replay || fail "the build failed"
  IRDM_PROGRAMS=$PWD/build/$preset/bin
fi
IRDM_PROGRAMS=$(realpath "$IRDM_PROGRAMS")
export IRDM_PROGRAMS
$python -c 'import h5py, matplotlib, numpy' 2>/dev/null || fail "needs python3-h5py and python3-matplotlib; see scripts/setup.sh"

# A model's configuration: model NAME CELLS [SED]. What was there and is the same keeps its date, and so its model.
model() {
  local file=$work/configs/models/$1.toml
  sed -e "s/cells = \[.*\]/cells = [$2, $2, $2]/" -e "${3:-}" configs/models/paper-cube.toml >"$file.new"
  cmp -s "$file.new" "$file" || mv "$file.new" "$file"
  rm -f "$file.new"
}
# A scene of the gallery with other models, touched by a fingertip: scene NAME GALLERY MODEL [LINE of the last object].
scene() {
  local file=$work/configs/scenes/$1.toml
  sed -e "s/soft-cube/$3/" "configs/scenes/$2.toml" >"$file"
  grep -q '^\[\[stylus\]\]' "$file" || sed -i 's/^\[\[object\]\]/[[stylus]]\n\n&/' "$file"
  sed -i 's/^\[\[stylus\]\]/&\nradius = 0.015/' "$file"
  [ -z "${4:-}" ] || echo "$4" >>"$file"
  cp "configs/bridges/$2.toml" "$work/configs/bridges/$1.toml"
}
play() { # NAME
  IRDM_DATA=$work scripts/irdm-play "$1" --lockstep --once --no-frames --out "$work" \
    >"$work/$1.log" 2>&1 || fail "playing $1 failed" "$work/$1.log"
  replay "$1" run
}
replay() { # NAME RUN [OPTION ...]: the run file NAME/RUN.h5
  local trace=$work/$1/trace.h5 run=$work/$1/$2
  shift 2
  rm -f "$run.h5"
  "$IRDM_PROGRAMS/irdm-replay" "$trace" -o "$run.h5" "$@" >"$run.log" 2>&1 || fail "a replay failed" "$run.log"
}
compare() { # A B JSON [OPTION ...], in the work folder
  rm -f "$work/$3"
  "$IRDM_PROGRAMS/irdm-replay" compare "$work/$1" "$work/$2" --json "$work/$3" "${@:4}" >"$work/$3.log" 2>&1 ||
    fail "a comparison failed" "$work/$3.log"
}
# By finite elements, from forces: reference NAME. On one core, since two run at a time.
reference() {
  OMP_NUM_THREADS=1 replay "$1" fem --reference fem --substep $substep
  compare "$1/run.h5" "$1/fem.h5" "$1/fem.json"
}
# A held point can be led along the same path, so that forces can be compared; takes several times as long.
led_reference() {
  OMP_NUM_THREADS=1 replay swing-modes fem --reference fem --from inputs --substep $substep
  mkdir -p "$work/swing-fem"
  compare swing-modes/run.h5 swing-modes/fem.h5 swing-fem/compare.json
}
beside() { # COMMAND: runs in the background, in a process group of its own, until `wait $other`
  set -m
  "$@" &
  set +m
  other=$!
  trap 'kill -- -$other 2>/dev/null || true' EXIT
}

# The motions, to their end or cut short.
for motion in swing tap; do
  awk -F, -v OFS=, -v end="${end[$motion]}" '!/^[0-9]/ || $1 < end { print; last = $0; next } { cut = 1 }
    END { if (cut) { $0 = last; $1 = end; print } }' "configs/scripts/$motion.csv" >"$work/configs/scripts/$motion.csv"
done
ln -sfn "$PWD/scripts/plot_force.py" "$work/scripts/plot_force.py"
model cube "$cells"
model cube-stiff "$cells" 's/^youngs_modulus = 2000.0/youngs_modulus = 20000.0/'
model cube-quadratic $((cells / 2)) 's/^order = 1/order = 2/'
model cube-1khz "$cells" 's/^dt = .*/dt = 0.001/; s/^steps = .*/steps = 1000/'
model own "$own_cells" 's/^storage = .*/storage = "both"/'
model own-1 "$own_cells"
model own-2 "$own_cells"

say "by the paper's own method, $columns columns"
"$IRDM_PROGRAMS/irdm-precompute" "$work/configs/models/cube.toml" -o "$work/models/stepped.columns" \
  --method time-stepping --storage dense --columns 0:"$columns" >"$work/models/stepped.log" 2>&1 ||
  fail "time stepping failed" "$work/models/stepped.log"

say "the cube, swung and tapped; a stiff one, tapped; a smaller one"
for motion in swing tap; do
  scene $motion $motion cube
  play $motion
done
scene tap-stiff tap cube-stiff
play tap-stiff
for motion in swing tap; do
  scene $motion-modes $motion own
  play $motion-modes
done
"$IRDM_PROGRAMS/irdm-precompute" check "$work/models/cube.h5" >"$work/models/check.log" 2>&1 || true # coarse meshes fail

say "finite elements; those of the swing beside all that follows"
swing_references() {
  reference swing
  led_reference
}
beside swing_references
reference tap
reference tap-stiff

say "what else there is: elements, inertial loading, 1 kHz"
for motion in swing tap; do
  scene $motion-quadratic $motion cube-quadratic
  scene $motion-inertial $motion cube "inertial_loading = true"
  scene $motion-1khz $motion cube-1khz
  for variant in quadratic inertial 1khz; do
    play $motion-$variant
    compare $motion/run.h5 $motion-$variant/run.h5 $motion-$variant/compare.json
  done
done

say "a delayed link"
for motion in swing tap; do
  for mode in hold predict; do
    for ms in 2 10; do # one way; the server has each tip so much later, and what jitter rounds up to
      variant=$motion-$mode-$ms
      scene $variant $motion cube
      printf '%s\n' "" "[bridge]" "mode = \"$mode\"" "[bridge.link]" "delay = $(printf '0.%03d' $ms)" \
        "jitter = 0.001" "seed = 1" >>"$work/configs/bridges/$variant.toml"
      play $variant
      compare $motion/run.h5 $variant/run.h5 $variant/compare.json --lag "$(printf '0.%03d' $((ms + 2)))"
    done
  done
done

say "the smaller cube: compressed R"
errors=(0.1 0.02)
for i in 1 2; do
  compressed=$work/models/own-$i.h5
  if [ ! -f "$compressed" ] || [ "$work/models/own.h5" -nt "$compressed" ]; then
    rm -f "$compressed"
    "$IRDM_PROGRAMS/irdm-precompute" compress "$work/models/own.h5" -o "$compressed" --error "${errors[i - 1]}" \
      --fir-steps 16 >"$work/models/compress-$i.log" 2>&1 || fail "compression failed" "$work/models/compress-$i.log"
  fi
  for motion in swing tap; do
    scene $motion-own-$i $motion own-$i 'engine = "compressed"'
    play $motion-own-$i
    compare $motion-modes/run.h5 $motion-own-$i/run.h5 $motion-own-$i/compare.json
  done
done

say "the rest of the finite elements"
wait "$other" || exit 1
trap - EXIT

say "page and figures"
$python scripts/reproduce/make_page.py "$work" "$docs"
say "done: $docs/reproduction.md"
