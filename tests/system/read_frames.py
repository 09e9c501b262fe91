"""Looks at the pictures of irdm-replay --frames: how many, how large, and of all the least of what a picture that is not
blank has: colours, the share of the picture that is no background; and how many are like the one before."""

import pathlib
import sys

import numpy
from PIL import Image

paths = sorted(pathlib.Path(sys.argv[1]).glob("frame_*.png"))
pictures = [numpy.asarray(Image.open(path).convert("RGB")).astype(int) for path in paths]
colours = min(len(numpy.unique(picture.reshape(-1, 3), axis=0)) for picture in pictures)


def share_of_object(picture):
    corner = picture[0, 0]
    return float(numpy.mean(numpy.abs(picture - corner).max(axis=2) > 24))


alike = sum(numpy.array_equal(one, next) for one, next in zip(pictures, pictures[1:]))
height, width, _ = pictures[0].shape
print(f"frames {len(pictures)}, {width} x {height}, colours {colours}, object {min(map(share_of_object, pictures)):.3f}, "
      f"alike {alike}")
