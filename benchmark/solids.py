"""References of cases that are no bodies of revolution: 27-node boxes, where they are symmetric a half or a quarter."""

import numpy
import scipy.interpolate

import meshes
from contact import Body, complementarity
from fem import Grid

EDGE = 0.1  # of a cube that stands on another [m]


def box_mesh(x, y, z):
    return meshes.tetrahedra([x, y, z])


def even(low, high, cell):
    return numpy.linspace(low, high, round((high - low) / cell) + 1)


MESHES = {
    "cube.msh": lambda: box_mesh(*[even(-EDGE / 2, EDGE / 2, 0.0125), even(0, EDGE, 0.0125),
                                   even(-EDGE / 2, EDGE / 2, 0.0125)])}


def mirrored(grid, axis, value, symmetric, shapes):
    """Displacements (samples, n, 3) at points (n, 3) of a face; `symmetric`: axes along which it goes on."""
    face = grid.on(axis, value)
    others = [other for other in range(3) if other != axis]
    counts = [grid.counts[other] for other in others]
    lines = [numpy.unique(grid.rest[face, other]) for other in others]
    tables = [scipy.interpolate.RegularGridInterpolator(lines, shape[face].reshape(*counts, 3)) for shape in shapes]

    def at(points):
        folded = points.copy()
        sign = numpy.ones_like(points)
        for one in symmetric:
            folded[:, one] = abs(points[:, one])
            sign[:, one] = numpy.where(points[:, one] < 0, -1.0, 1.0)
        return numpy.array([sign * table(folded[:, others]) for table in tables])
    return at


def held(grid, bottom, symmetric):
    """Degrees of freedom that do not move: of the plane y = `bottom` (None: none) all, of symmetry's the one across."""
    fixed = [3 * grid.on(axis, 0.0) + axis for axis in symmetric]
    if bottom is not None:
        fixed += [3 * grid.on(1, bottom) + axis for axis in range(3)]
    return numpy.unique(numpy.concatenate(fixed))


def sampled(case, k, step):
    return any(abs(k * step - time) < step / 2 for time in case["sample_times"])


def chosen(nodes, which, at):
    numbers = numpy.flatnonzero(which)
    return numbers, at(nodes[numbers])


def two_cubes(case, fine, step, material, dt):
    """A quarter of both. Contact is of nodes that face each other at rest."""
    half = numpy.linspace(0, EDGE / 2, round(EDGE / 2 / fine) + 1)
    grid = Grid([half, numpy.linspace(0, EDGE, round(EDGE / fine) + 1), half])
    top, bottom = grid.on(1, EDGE), grid.on(1, 0.0)
    common = {"along": [1], "gravity": numpy.array(case["gravity"])}
    lower = Body(grid, material, held(grid, 0.0, (0, 2)), top, step, **common)
    upper = Body(grid, material, held(grid, None, (0, 2)), bottom, step, **common)
    active = numpy.zeros(len(top), dtype=bool)
    force, shapes = [], []
    for k in range(1, round(case["duration"] / step) + 1):
        gap = upper.predict()[3 * bottom + 1] - lower.predict()[3 * top + 1]
        pressing, active = complementarity(lower.compliance + upper.compliance, gap, active)
        lower.finish(-pressing)
        upper.finish(pressing)
        if k % round(dt / step) == 0:
            force.append([0.0, 4 * pressing.sum(), 0.0])
        if sampled(case, k, step):
            shapes.append(lower.u[0].reshape(-1, 3))
    at = mirrored(grid, 1, EDGE, (0, 2), shapes)
    return numpy.array(force), shapes, lambda nodes: chosen(nodes, nodes[:, 1] > EDGE - 1e-6, at)


def cases(material, dt):
    """As references.cases."""
    def case(name, about, duration, samples, mesh, size, fixed, tools):
        body = {"mesh": mesh, "material": material, "mass": float(numpy.prod(size)) * material["density"]}
        if fixed:
            body["fixed_below"] = 0.0
        return {"name": name, "about": about, "duration": duration, "gravity": [0.0, 0.0, 0.0], "friction": 0.0,
                "bodies": [body], "tools": tools, "sample_times": samples}

    cubes = case("two-cubes", "a cube stands on another, which is glued to a table, and gravity begins", 0.25,
                 [0.06, 0.1, 0.24], "cube.msh", [EDGE] * 3, True, [])
    cubes["gravity"] = [0.0, -9.81, 0.0]
    cubes["bodies"].append({**cubes["bodies"][0], "position": [0.0, EDGE, 0.0]})
    del cubes["bodies"][1]["fixed_below"]
    return [
        (cubes, two_cubes, (EDGE / 12, 2.5e-4)),
    ]
