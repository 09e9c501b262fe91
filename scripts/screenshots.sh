#!/usr/bin/env bash
# Makes the pictures of README and tutorial in docs/images: irdm-server and irdm-bridge with a scripted stylus, the page in
# headless Chromium, on a desktop and on a phone, light and dark; the cube's run as a moving picture. Best on a machine
# that has nothing else to do: it draws in software, for several minutes.
#   scripts/screenshots.sh [PRESET]    release unless given
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
bin=build/$preset/bin
models=out/models
kilobytes=150 # that a picture may have
phone_kilobytes=300
moving_kilobytes=1000
mkdir -p "$models" docs/images
scripts/setup.sh
scripts/build.sh "$preset" irdm-precompute irdm-server irdm-bridge
config=configs/models/liver.toml
[ "$models/liver.h5" -nt "$config" ] || "$bin/irdm-precompute" "$config" -o "$models/liver.h5" >"$models/liver.log"
IRDM_PROGRAMS=$bin IRDM_DATA=$PWD scripts/irdm-play paper-cube --lockstep --once --no-frames
pictures=$(mktemp -d)
trap 'rm -rf "$pictures"' EXIT
IRDM_SERVER=$bin/irdm-server IRDM_BRIDGE=$bin/irdm-bridge CHROMIUM=$(command -v chromium) \
  node viewer/page/browser/screenshots.mjs configs "$models" "$pictures"
# Seven bits a colour look the same and take a third less room.
/usr/bin/python3 - "$pictures" docs/images $kilobytes $phone_kilobytes <<'END'
import pathlib, sys
from PIL import Image

source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
kilobytes, phone_kilobytes = int(sys.argv[3]), int(sys.argv[4])
for path in sorted(source.glob("*.png")):
    picture = Image.open(path).convert("RGB").point(lambda value: value | 1)
    picture.save(target / path.name, optimize=True)
    size = (target / path.name).stat().st_size
    print(f"picture  {target / path.name}, {size / 1000:.0f} kB")
    if size > 1000 * (phone_kilobytes if path.name.startswith("phone") else kilobytes):
        sys.exit(f"screenshots: {path.name} is too large")
END

echo "screenshots: the moving picture"
IRDM_SERVER=$bin/irdm-server CHROMIUM=$(command -v chromium) \
  node viewer/page/browser/moving_picture.mjs out/paper-cube/scene.toml out/paper-cube/trace.h5 "$pictures/moving"
/usr/bin/python3 scripts/moving_picture.py "$pictures/moving" docs/images/cube-moving $moving_kilobytes
