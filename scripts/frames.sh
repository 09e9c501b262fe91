#!/usr/bin/env bash
# Makes pictures of a recorded run with the look of the live viewer: its page in headless Chromium, frame by frame.
# Needs chromium, nodejs and the page's packages (scripts/setup.sh); a video needs ffmpeg besides.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

usage() {
  cat <<'END'
usage: scripts/frames.sh [OPTIONS] SCENE.toml TRACE.h5 FOLDER
Writes FOLDER/frame_00000.png and so on; FOLDER must be new or empty. The scene and its models are those of the trace.
  --rate HZ             pictures for a second of the run (25)
  --from S, --to S      the part of the run that is shown (all of it)
  --size WxH            of a picture, in pixels (1280x720)
  --camera AZ,EL        where it is seen from: degrees round the vertical from the z axis towards x, and above the horizon
                        (29,20)
  --still               the camera stays where it is, and does not go along
  --exaggeration F      of the deformation, 0 to 20 (1)
  --rigid               the rigid body as a wireframe
  --colour WHAT         none | displacement | velocity | compliance (none)
  --dark                the page's dark colours
  --page                all of the page, with its panel
  --video FILE.mp4      a video, too; needs ffmpeg
  --preset PRESET       the build whose programs are used (release)
END
}
fail() {
  echo "frames: $1" >&2
  exit 1
}

preset=release video="" options=() places=()
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) usage; exit 0 ;;
    --preset | --video | --rate | --from | --to | --size | --camera | --exaggeration | --colour)
      [ -n "${2:-}" ] || { usage >&2; exit 2; }
      case $1 in
        --preset) preset=$2 ;;
        --video) video=$2 ;;
        --rate) rate=$2; options+=("$1=$2") ;;
        *) options+=("$1=$2") ;;
      esac
      shift
      ;;
    --still | --rigid | --dark | --page) options+=("$1") ;;
    -*) usage >&2; exit 2 ;;
    *) places+=("$1") ;;
  esac
  shift
done
[ ${#places[@]} -eq 3 ] || { usage >&2; exit 2; }

export IRDM_SERVER=${IRDM_SERVER:-$root/build/$preset/bin/irdm-server}
export CHROMIUM=${CHROMIUM:-$(command -v chromium || true)}
[ -x "$IRDM_SERVER" ] || fail "there is no $IRDM_SERVER; build it by scripts/build.sh $preset irdm-server"
[ -n "$CHROMIUM" ] || fail "there is no chromium, which draws the page; install Debian's chromium"
command -v node >/dev/null || fail "there is no node, which drives Chromium; install Debian's nodejs"
[ -d "$root/server/viewer/page/node_modules/playwright-core" ] ||
  fail "there is no playwright-core, which drives Chromium; run scripts/setup.sh"
if [ -n "$video" ]; then
  command -v ffmpeg >/dev/null || fail "there is no ffmpeg, which --video needs; install Debian's ffmpeg, or leave --video out"
  [ ! -e "$video" ] || fail "$video exists already"
fi

node "$root/server/viewer/page/browser/frames.mjs" "${options[@]}" "${places[@]}"
[ -n "$video" ] || exit 0
ffmpeg -loglevel error -framerate "${rate:-25}" -i "${places[2]}/frame_%05d.png" \
  -vf "pad=ceil(iw/2)*2:ceil(ih/2)*2" -c:v libx264 -pix_fmt yuv420p "$video" || fail "ffmpeg could not make $video"
echo "frames: video $video"
