#!/usr/bin/python3
"""Makes moving pictures, WebP, of the frames of viewer/page/browser/moving_picture.mjs.

usage: moving_picture.py FRAMES PICTURE KILOBYTES     PICTURE-light.webp and PICTURE-dark.webp, at most so large each
"""

import pathlib
import sys

from PIL import Image

LENGTH_MS = 15000  # of it all
LAST_MS = 1500  # of the last frame, before it begins again
SIZE = (720, 360)  # as large as a README shows it
QUALITIES = (70, 55, 40, 25, 20)


def save(frames, path, kilobytes):
    """In the best quality that fits."""
    steps = max(1, len(frames) - 1)
    durations = [(LENGTH_MS - LAST_MS) // steps] * (len(frames) - 1) + [LAST_MS]
    for quality in QUALITIES:
        frames[0].save(path, save_all=True, append_images=frames[1:], duration=durations, loop=0, quality=quality)
        size = path.stat().st_size
        if size <= 1000 * kilobytes:
            print(f"picture  {path}, {len(frames)} frames, {size / 1000:.0f} kB, quality {quality}")
            return
    sys.exit(f"moving_picture: {path.name} is too large: {size / 1000:.0f} kB")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__.strip())
    for look in ("light", "dark"):
        paths = sorted(pathlib.Path(sys.argv[1]).glob(f"{look}-*.png"))
        frames = [Image.open(path).convert("RGB").resize(SIZE, Image.Resampling.LANCZOS) for path in paths]
        if not frames:
            sys.exit(f"moving_picture: {sys.argv[1]} has no {look}-*.png")
        save(frames, pathlib.Path(f"{sys.argv[2]}-{look}.webp"), float(sys.argv[3]))


main()
