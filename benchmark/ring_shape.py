"""The ring of peg, of quadratic tetrahedra with curved edges: all nodes of its hole lie on the wall.

A script of Gmsh cannot move rows of nodes. In straight ones all nodes of a row touch the ball at once, which moves the
force by a tenth; here each row rises and falls round the hole by one row, so that some nodes begin to touch at any time.
"""

import numpy

import meshes

THROAT, CURVATURE, OUTER, HEIGHT = 0.020, 0.040, 0.050, 0.040  # [m]
AROUND = 14  # cells of 26 degrees
ROWS = numpy.r_[0, numpy.linspace(0.005, HEIGHT - 0.005, 12), HEIGHT]  # finest where the ball is
ACROSS = numpy.array([0, 0.1, 0.25, 0.55, 1])  # shares of the way out
WAVES = 2  # of a row round the hole
END = 0.005  # below and above there are none


def wall(height):
    return THROAT + (height - HEIGHT / 2) ** 2 / (2 * CURVATURE)


def shape(x):
    share, height, turns = x.T
    wave = 4 * abs(WAVES * turns % 1 - 0.5) - 1
    row = (ROWS[2] - ROWS[1]) / 2
    height = height + row * wave * numpy.minimum(numpy.minimum(height, HEIGHT - height) / END, 1)
    radius = wall(height) + share * (OUTER - wall(height))
    angle = 2 * numpy.pi * turns
    return numpy.stack([radius * numpy.cos(angle), height, radius * numpy.sin(angle)], axis=1)


def mesh():
    """Nodes (n, 3) [m] and tetrahedra (e, 10)."""
    nodes, tets = meshes.quadratic([ACROSS, ROWS, numpy.linspace(0, 1, AROUND + 1)], shape)
    first = numpy.arange(len(nodes)).reshape(-1, 2 * AROUND + 1)
    last = first.copy()
    last[:, -1] = first[:, 0]  # closes the ring
    kept, number = numpy.unique(last.ravel(), return_inverse=True)
    return nodes[kept], number[tets]
