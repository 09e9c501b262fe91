"""Tetrahedra that all engines are given: boxes of cells, six tetrahedra each, moved into the shape. Height is y."""

import itertools

import numpy


def graded(fine, until, length, growth=1.3):
    """Planes from 0 to `length`: cells of `fine` up to about `until`, then growing."""
    x, cell = [0.0], fine
    while x[-1] < length - 1e-12:
        if x[-1] >= until - 1e-12:
            cell *= growth
        x.append(x[-1] + cell)
    x = numpy.array(x)
    first = numpy.searchsorted(x, until - 1e-12)
    x[first:] = x[first] + (x[first:] - x[first]) * (length - x[first]) / (x[-1] - x[first])
    return x


def tetrahedra(axes, shape=lambda x: x):
    """Nodes (n, 3) [m] and tetrahedra (e, 4), of the cells between planes, moved by `shape`."""
    nodes = shape(numpy.stack(numpy.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3))
    number = numpy.arange(len(nodes)).reshape([len(axis) for axis in axes])
    corners = [number[tuple(slice(o, o + n - 1) for o, n in zip(offset, number.shape))].ravel()
               for offset in itertools.product((0, 1), repeat=3)]
    tets = []
    for order in itertools.permutations((4, 2, 1)):  # along the edges of a cell from its first to its last corner
        path = numpy.cumsum((0, *order))
        tets.append(numpy.stack([corners[i] for i in path], axis=1))
    tets = numpy.concatenate(tets)
    volume = signed_volume(nodes, tets)
    tets[volume < 0] = tets[volume < 0][:, [1, 0, 2, 3]]
    return nodes, tets


EDGES = (0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)  # of a tetrahedron, in Gmsh's order


def quadratic(axes, shape):
    """The same cells with nodes half-way as well, which `shape` moves, too: tetrahedra (e, 10), in Gmsh's order."""
    halves = [numpy.sort(numpy.r_[axis, (axis[1:] + axis[:-1]) / 2]) for axis in axes]
    nodes = shape(numpy.stack(numpy.meshgrid(*halves, indexing="ij"), -1).reshape(-1, 3))
    place = numpy.stack(numpy.unravel_index(tetrahedra(axes)[1], [len(axis) for axis in axes]), -1)
    places = numpy.concatenate([2 * place, *(place[:, [i]] + place[:, [j]] for i, j in EDGES)], axis=1)
    return nodes, numpy.ravel_multi_index(numpy.moveaxis(places, -1, 0), [len(half) for half in halves])


def signed_volume(nodes, tets):
    a, b, c, d = (nodes[tets[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


def stiffness(nodes, tets, material):
    """Of linear tetrahedra, (e, 12, 12) [N/m]; the modulus may be of each."""
    corners = nodes[tets]
    inverse = numpy.linalg.inv(corners[:, 1:] - corners[:, :1])
    gradient = numpy.concatenate([-inverse.sum(axis=2, keepdims=True), inverse], axis=2)
    strain = numpy.zeros((len(tets), 6, 4, 3))
    for a in range(3):
        strain[:, a, :, a] = gradient[:, a]
    for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 3):
        strain[:, row, :, a], strain[:, row, :, b] = gradient[:, b], gradient[:, a]
    strain = strain.reshape(len(tets), 6, 12)
    young, poisson = material["youngs_modulus"], material["poisson_ratio"]
    elastic = numpy.diag([2.0] * 3 + [1.0] * 3) / (2 * (1 + poisson))
    elastic[:3, :3] += poisson / ((1 + poisson) * (1 - 2 * poisson))
    volume = young * abs(signed_volume(nodes, tets))
    return numpy.einsum("e,esi,st,etj->eij", volume, strain, elastic, strain, optimize=True)


def highest_frequency(nodes, tets, material, density):
    """That of the stiffest tetrahedron with its own mass [rad/s]: none of the mesh is higher."""
    mass = density * abs(signed_volume(nodes, tets)) / 4
    return float(numpy.sqrt((numpy.linalg.eigvalsh(stiffness(nodes, tets, material))[:, -1] / mass).max()))


def surface_of(tets):
    """Triangles (t, 3) that belong to one tetrahedron only, outward."""
    faces = numpy.concatenate([tets[:, order] for order in ([0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2])])
    _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return faces[first[count == 1]]


def disc(x):
    """From the square of the half edge 1 (x and the last) to the unit disc; the middle keeps its size."""
    a, b = x[:, 0], x[:, -1]
    moved = x.copy()
    moved[:, 0], moved[:, -1] = a * numpy.sqrt(1 - b * b / 2), b * numpy.sqrt(1 - a * a / 2)
    return moved


def ball(x):
    """From the cube of the half edge 1 to the unit ball."""
    a, b, c = (x * x).T
    return x * numpy.sqrt(numpy.stack([1 - b / 2 - c / 2 + b * c / 3, 1 - a / 2 - c / 2 + a * c / 3,
                                       1 - a / 2 - b / 2 + a * b / 3], axis=1))


def rotation(quaternion):
    """Of (w, x, y, z), a unit quaternion."""
    w, x, y, z = quaternion
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def write(path, nodes, tets):
    """Gmsh's text format 2.2. tets: (e, 4 or 10)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    lines += [f"{i} {x:.7g} {y:.7g} {z:.7g}" for i, (x, y, z) in enumerate(nodes, 1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    kind = {4: 4, 10: 11}[tets.shape[1]]
    lines += [f"{i} {kind} 2 1 1 {' '.join(map(str, tet))}" for i, tet in enumerate(tets + 1, 1)]
    path.write_text("\n".join([*lines, "$EndElements"]) + "\n", encoding="utf-8")


def read(path):
    """Nodes and tetrahedra of such a file."""
    words = path.read_text(encoding="utf-8").split()
    begin = words.index("$Nodes")
    count = int(words[begin + 1])
    nodes = numpy.array(words[begin + 2:begin + 2 + 4 * count], dtype=float).reshape(-1, 4)[:, 1:]
    begin = words.index("$Elements")
    count = int(words[begin + 1])
    return nodes, numpy.array(words[begin + 2:begin + 2 + 9 * count], dtype=int).reshape(-1, 9)[:, 5:] - 1
