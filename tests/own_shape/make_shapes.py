"""Writes shapes as a person brings them: STL files in millimetres, of many triangles, some of them thin.

usage: make_shapes.py FOLDER [STEP]      STEP: edge of a cell of the grid that they come from [mm]
"""

import pathlib
import sys

import numpy as np
from marching_tetrahedra import surface_of


def kidney(x, y, z):
    """A bent ellipsoid, 11 cm long."""
    bent = y - 0.008 * x**2 + 8
    return 20 * (np.sqrt((x / 55) ** 2 + (bent / 28) ** 2 + (z / 22) ** 2) - 1)


def both(a, b, rounding=5.0):
    """Where both functions are negative, with rounded edges."""
    return np.maximum(a, b) + np.maximum(rounding - np.abs(a - b), 0) ** 2 / (4 * rounding)


def cylinder(x, y, z, radius, bottom, top):
    return both(np.hypot(x, z) - radius, np.abs(y - (bottom + top) / 2) - (top - bottom) / 2)


def mug(x, y, z):
    """Walls of 9 mm, a ring as its handle, one surface of both."""
    handle = np.hypot(np.hypot(x - 42, y - 45) - 24, z) - 8
    outside = -both(-cylinder(x, y, z, 40, 0, 90), -handle)
    return both(outside, -cylinder(x, y, z, 31, 12, 120))


def torus_knot(x, y, z):
    """A tube of 9 mm along a trefoil."""
    t = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    line = 20 * np.stack([(2 + np.cos(3 * t)) * np.cos(2 * t), (2 + np.cos(3 * t)) * np.sin(2 * t), 1.4 * np.sin(3 * t)])
    nearest = np.full(x.shape, np.inf)
    for point in line.T:
        nearest = np.minimum(nearest, (x - point[0]) ** 2 + (y - point[1]) ** 2 + (z - point[2]) ** 2)
    return np.sqrt(nearest) - 9


# Function, corners of a box round it, cells [mm].
SHAPES = {
    "kidney": (kidney, (-58, -38, -24), (58, 46, 24), 4.0),
    "mug-with-handle": (mug, (-42, -2, -42), (78, 92, 42), 3.0),
    "torus-knot": (torus_knot, (-72, -72, -40), (72, 72, 40), 3.0),
}


def triangles_of(name, step=None):
    function, low, high, own_step = SHAPES[name]
    return surface_of(function, low, high, step or own_step)


def write_stl(path, triangles):
    """Binary."""
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    rows = np.zeros(len(triangles), dtype=[("numbers", "<f4", (4, 3)), ("attributes", "<u2")])
    rows["numbers"] = np.concatenate([normal[:, None], triangles], axis=1)
    path.write_bytes(b"mm".ljust(80) + np.uint32(len(triangles)).tobytes() + rows.tobytes())


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    for shape in SHAPES:
        found = triangles_of(shape, *(float(word) for word in sys.argv[2:]))
        write_stl(pathlib.Path(sys.argv[1]) / f"{shape}.stl", found)
        print(f"{shape}.stl: {len(found)} triangles")
