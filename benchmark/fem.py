"""Linear elasticity with quadratic elements: boxes of 27 nodes, or rings of 9 nodes round the z axis."""

import itertools

import numpy
import scipy.sparse

_POINTS = numpy.sqrt(0.6) * numpy.array([-1.0, 0.0, 1.0])  # Gauss-Legendre, 3 points
_WEIGHTS = numpy.array([5.0, 8.0, 5.0]) / 9.0


def _line(x):
    """Quadratic shape functions of a line at x and their derivatives."""
    return (numpy.array([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2]), numpy.array([x - 0.5, -2 * x, x + 0.5]))


def _light(point, axis, end):
    """Functions (3^d) of which those on the face at `end` of an axis are 0; linear fields are in them."""
    lines = [_line(x)[0] for x in point]
    x = point[axis]
    lines[axis] = numpy.array([0.0, 1 - x, x] if end == 0 else [-x, 1 + x, 0.0])
    value = 1.0
    for one in lines:
        value = numpy.multiply.outer(value, one)
    return value.ravel()


def _shapes(point):
    """At a point of the reference cell: functions (3^d), gradients (d, 3^d)."""
    lines = [_line(x) for x in point]
    value = 1.0
    for one in lines:
        value = numpy.multiply.outer(value, one[0])
    gradient = []
    for axis in range(len(point)):
        product = 1.0
        for other, one in enumerate(lines):
            product = numpy.multiply.outer(product, one[other == axis])
        gradient.append(product.ravel())
    return value.ravel(), numpy.array(gradient)


class Grid:
    """Quadratic cells between the planes `axes` [m], moved by `shape`, a function of points (n, d).

    With two axes they are r and z of a body of revolution, else x, y, z.
    """

    def __init__(self, axes, shape=lambda x: x):
        self.counts = [2 * len(axis) - 1 for axis in axes]
        lines = []
        for axis in axes:
            axis = numpy.asarray(axis, dtype=float)
            line = numpy.empty(2 * len(axis) - 1)
            line[0::2], line[1::2] = axis, (axis[:-1] + axis[1:]) / 2
            lines.append(line)
        self.dimension = len(axes)
        self.rest = numpy.stack(numpy.meshgrid(*lines, indexing="ij"), -1).reshape(-1, self.dimension)
        self.nodes = shape(self.rest)
        number = numpy.arange(len(self.rest)).reshape(self.counts)
        corner = numpy.stack(numpy.meshgrid(*[numpy.arange(0, n - 2, 2) for n in self.counts], indexing="ij"), -1)
        offsets = numpy.array(list(itertools.product(range(3), repeat=self.dimension)))
        at = corner.reshape(-1, 1, self.dimension) + offsets
        self.cells = number[tuple(numpy.moveaxis(at, -1, 0))]

    def on(self, axis, value):
        """Nodes whose coordinate before `shape` is `value`."""
        return numpy.flatnonzero(abs(self.rest[:, axis] - value) < 1e-9)

    def elimination_order(self):
        """Nodes in the order of nested dissection: few entries of the factors of their matrix."""
        number = numpy.arange(len(self.nodes)).reshape(self.counts)

        def order(block, first):  # first: its place, as planes between cells have even ones
            axis = int(numpy.argmax(block.shape))
            middle = block.shape[axis] // 2
            middle -= (first[axis] + middle) % 2
            if block.size <= 40 or middle < 1 or middle > block.shape[axis] - 2:
                return [block.ravel()]
            low, plane, high = numpy.split(block, [middle, middle + 1], axis)
            after = [place + (middle + 1) * (other == axis) for other, place in enumerate(first)]
            return order(low, first) + order(high, after) + [plane.ravel()]
        return numpy.concatenate(order(number, [0] * self.dimension))

    def assemble(self, material, light=None):
        """Stiffness and consistent mass, and the volume of each node [N/m, kg, m^3].

        light: (axis, value): nodes of that face have no mass. Mass, its centre and moments of inertia stay.

        material["stiffer"]: (centre, radius, factor): a ball of so many times the modulus, by integration points.
        """
        young, poisson = material["youngs_modulus"], material["poisson_ratio"]
        shear = young / (2 * (1 + poisson))
        bulk = young * poisson / ((1 + poisson) * (1 - 2 * poisson))  # Lame's first
        inclusion = material.get("stiffer")
        d, count = self.dimension, self.cells.shape[1]
        if light:
            on_face = numpy.isin(self.cells, self.on(*light))
            outer = numpy.flatnonzero(on_face.any(axis=1))
            ends = numpy.arange(3**d) // 3 ** (d - 1 - light[0]) % 3
            end = ends[on_face[outer[0]]][0]
        x = self.nodes[self.cells]
        stiffness = numpy.zeros((len(self.cells), count * d, count * d))
        mass = numpy.zeros((len(self.cells), count, count))
        volume = numpy.zeros(len(self.nodes))
        for index in itertools.product(range(3), repeat=d):
            shape, gradient = _shapes(_POINTS[list(index)])
            jacobian = numpy.einsum("ai,cid->cad", gradient, x)
            local = numpy.einsum("cda,ai->cdi", numpy.linalg.inv(jacobian), gradient)
            weight = numpy.prod(_WEIGHTS[list(index)]) * numpy.linalg.det(jacobian)
            radius = None
            if d == 2:
                radius = x[:, :, 0] @ shape
                weight = weight * 2 * numpy.pi * radius
            if inclusion:
                centre, reach, factor = inclusion
                inside = numpy.linalg.norm(numpy.einsum("cid,i->cd", x, shape) - centre, axis=1) < reach
            strain, elastic = self._strain(local, shape, radius), _elasticity(d, bulk, shear)
            firm = weight * numpy.where(inside, factor, 1.0) if inclusion else weight
            stiffness += numpy.einsum("c,csi,st,ctj->cij", firm, strain, elastic, strain, optimize=True)
            mass += numpy.einsum("c,i,j->cij", weight, shape, shape)
            if light:
                inner = _light(_POINTS[list(index)], light[0], end)
                instead = numpy.outer(inner, inner) - numpy.outer(shape, shape)
                mass[outer] += numpy.multiply.outer(weight[outer], instead)
            numpy.add.at(volume, self.cells, weight[:, None] * shape)
        dofs = (d * self.cells[:, :, None] + numpy.arange(d)).reshape(len(self.cells), -1)
        size = d * len(self.nodes)
        full_mass = material["density"] * numpy.einsum("cij,ab->ciajb", mass, numpy.eye(d)).reshape(stiffness.shape)
        return _sparse(stiffness, dofs, size), _sparse(full_mass, dofs, size), volume

    def _strain(self, gradient, shape, radius):
        """Engineering strain by displacement: (cells, components, dofs of a cell)."""
        cells, d, count = gradient.shape
        rows = numpy.zeros((cells, 4 if d == 2 else 6, count, d))
        for a in range(d):
            rows[:, a, :, a] = gradient[:, a]
        if d == 2:
            rows[:, 2, :, 0] = shape / radius[:, None]
            rows[:, 3, :, 0], rows[:, 3, :, 1] = gradient[:, 1], gradient[:, 0]
        else:
            for row, (a, b) in enumerate(((0, 1), (1, 2), (2, 0)), 3):
                rows[:, row, :, a], rows[:, row, :, b] = gradient[:, b], gradient[:, a]
        return rows.reshape(cells, rows.shape[1], count * d)


def _elasticity(dimension, bulk, shear):
    size = 4 if dimension == 2 else 6
    matrix = numpy.diag([2 * shear] * 3 + [shear] * (size - 3))
    matrix[:3, :3] += bulk
    return matrix


def _sparse(blocks, dofs, size):
    rows = numpy.repeat(dofs, dofs.shape[1], axis=1).ravel()
    columns = numpy.tile(dofs, (1, dofs.shape[1])).ravel()
    return scipy.sparse.csc_matrix((blocks.ravel(), (rows, columns)), shape=(size, size))
