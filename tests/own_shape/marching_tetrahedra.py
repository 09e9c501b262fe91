"""The surface where a function of space is zero, as triangles: closed, whatever the function, if it is positive at the
borders of its box. Every cell of a grid is six tetrahedra, which share its diagonal."""

import itertools

import numpy as np

# Corners of a cell have the bits x, y, z; a tetrahedron goes from corner 0 to 7 by one axis after the other.
CELL = np.array([[0, 1 << a, (1 << a) + (1 << b), 7] for a, b, _ in itertools.permutations(range(3))])
AWAY_FROM_ZERO = 0.05  # of a cell: no triangle becomes very thin


def surface_of(function, low, high, step):
    """Triangles (n, 3, 3), normals outward, where function(x, y, z) < 0 inside; it is about a distance."""
    axes = [np.arange(a - step, b + 2 * step, step) for a, b in zip(low, high)]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    value = function(*np.moveaxis(places, -1, 0)).ravel()
    smallest = AWAY_FROM_ZERO * step
    value = np.where(np.abs(value) < smallest, np.where(value < 0, -smallest, smallest), value)
    corners = crossed(tetrahedra(places.shape[:3]), value)
    ends = edges(corners, (value[corners] < 0).sum(axis=1))
    place = crossings(places.reshape(-1, 3), value, ends)
    return turned(place, places.reshape(-1, 3), ends)


def tetrahedra(shape):
    numbers = np.arange(np.prod(shape)).reshape(shape)
    ends = [slice(None, -1), slice(1, None)]
    corner = np.stack([numbers[ends[i & 1], ends[i >> 1 & 1], ends[i >> 2 & 1]].ravel() for i in range(8)], axis=1)
    return corner[:, CELL].reshape(-1, 4)


def crossed(corners, value):
    """Those that the surface goes through, each with its inner corners first."""
    inside = value[corners] < 0
    count = inside.sum(axis=1)
    through = (count > 0) & (count < 4)
    order = np.argsort(~inside[through], axis=1, kind="stable")
    return np.take_along_axis(corners[through], order, axis=1)


def edges(corners, inner):
    """Edges (n, 3, 2), from inside to outside, on which the corners of the triangles are."""
    triangles = {1: [[(0, 1), (0, 2), (0, 3)]], 3: [[(0, 3), (1, 3), (2, 3)]],
                 2: [[(0, 2), (0, 3), (1, 3)], [(0, 2), (1, 3), (1, 2)]]}
    return np.concatenate([corners[inner == count][:, triangle] for count in triangles for triangle in triangles[count]])


def crossings(places, value, ends):
    """Where the function is zero, linearly, on each edge; the same number wherever an edge is met."""
    a, b = ends[..., 0], ends[..., 1]
    share = value[a] / (value[a] - value[b])
    return places[a] + share[..., None] * (places[b] - places[a])


def turned(triangles, places, ends):
    outward = (places[ends[..., 1]] - places[ends[..., 0]]).sum(axis=1)
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    wrong = np.einsum("ij,ij->i", normal, outward) < 0
    triangles[wrong] = triangles[wrong][:, ::-1]
    return triangles
