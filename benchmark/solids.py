"""References of cases that are no bodies of revolution: 27-node boxes, where they are symmetric a half or a quarter."""

import numpy
import scipy.interpolate

import meshes
from contact import Body, complementarity, sphere
from fem import Grid
from friction import Grip

EDGE = 0.1  # of a cube that stands on another [m]
BAR = (0.04, 0.2, 0.04)
PUSHER = 0.3  # radius of the ball that pushes the bar
SLAB = (0.08, 0.04, 0.08)
SLIDER = 0.4  # of the ball that slides on the slab
BLOCK = 0.06  # edge of a cube that is pinched
FINGER = 0.5  # radius of the balls that pinch it


def box_mesh(x, y, z):
    return meshes.tetrahedra([x, y, z])


def even(low, high, cell):
    return numpy.linspace(low, high, max(1, round((high - low) / cell)) + 1)


def joined(*parts):
    """Lines of cells that follow one another: each (low, high, size of the cells)."""
    return numpy.unique(numpy.concatenate([even(*part) for part in parts]).round(12))


MESHES = {
    "cube.msh": lambda: box_mesh(*[even(-EDGE / 2, EDGE / 2, 0.0125), even(0, EDGE, 0.0125),
                                   even(-EDGE / 2, EDGE / 2, 0.0125)]),
    "bar.msh": lambda: box_mesh(*[even(low, low + length, BAR[0] / 6)
                                  for low, length in zip((-BAR[0] / 2, 0, -BAR[2] / 2), BAR)]),
    "slab.msh": lambda: box_mesh(even(-SLAB[0] / 2, SLAB[0] / 2, 0.005), even(0, SLAB[1], 0.008),
                                 even(-SLAB[2] / 2, SLAB[2] / 2, 0.005)),
    "block.msh": lambda: box_mesh(*[even(-BLOCK / 2, BLOCK / 2, BLOCK / 12)] * 3)}


def weights_on(line, x):
    """Of a line's nodes, two a cell, in the quadratic field at x: (n, nodes)."""
    first = 2 * numpy.clip(numpy.searchsorted(line[::2], x) - 1, 0, len(line) // 2 - 1)
    share = (x - line[first]) / (line[first + 2] - line[first])
    weights = numpy.zeros((len(x), len(line)))
    of_three = ((1 - share) * (1 - 2 * share), 4 * share * (1 - share), share * (2 * share - 1))
    for offset, weight in enumerate(of_three):
        weights[numpy.arange(len(x)), first + offset] = weight
    return weights


def mirrored(grid, axis, value, symmetric, shapes, quadratic=False):
    """Displacements (samples, n, 3) at points (n, 3) of a face; `symmetric`: axes along which it goes on. Between nodes
    linear or, with `quadratic`, as the cells are."""
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
        if quadratic:
            first, second = (weights_on(line, folded[:, other]) for line, other in zip(lines, others))
            return numpy.array([sign * numpy.einsum("na,nb,abk->nk", first, second, shape[face].reshape(*counts, 3))
                                for shape in shapes])
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


def centre(case, time):
    """Of the first tool."""
    path = numpy.array(case["tools"][0]["path"])
    return numpy.array([numpy.interp(time, path[:, 0], path[:, axis]) for axis in (1, 2, 3)])


def pushed_bar(case, fine, step, _, dt):
    """Half of it, glued below; the ball comes from -x."""
    side = -BAR[0] / 2
    grid = Grid([joined((side, side + 0.006, fine), (side + 0.006, -side, 3 * fine)),
                 joined((0, 0.136, 3 * fine), (0.136, 0.18, fine), (0.18, BAR[1], 3 * fine)),
                 joined((0, 0.01, fine), (0.01, BAR[2] / 2, 3 * fine))])
    face = grid.on(0, side)
    _, y, z = grid.nodes[face].T
    touching = face[(abs(y - 0.158) < 0.021) & (z < 0.009)]
    body = Body(grid, case["bodies"][0]["material"], held(grid, 0.0, (2,)), touching, step,
                light=(0, side))
    force, shapes = [], []
    for k in range(1, round(case["duration"] / step) + 1):
        pushed = -2 * body.advance(sphere(centre(case, k * step), PUSHER)).sum(axis=0)
        if k % round(dt / step) == 0:
            force.append([*pushed[:2], 0.0])
        if sampled(case, k, step):
            shapes.append(body.u[0].reshape(-1, 3))
    at = mirrored(grid, 0, side, (2,), shapes, True)
    return numpy.array(force), shapes, lambda nodes: chosen(nodes, nodes[:, 0] < side + 1e-6, at)


def gripped(case, body, step, dt, parts):
    """Force on the ball at the ends of the table's steps, `parts` times that of the modelled part, and the samples."""
    tool = case["tools"][0]
    grip = Grip(body, centre(case, 0.0), tool["radius"], tool["friction"])
    force, shapes = [], []
    for k in range(1, round(case["duration"] / step) + 1):
        pushed = -parts * grip.advance(centre(case, k * step)).sum(axis=0)
        if k % round(dt / step) == 0:
            force.append([*pushed[:2], 0.0])
        if sampled(case, k, step):
            shapes.append(body.u[0].reshape(-1, 3))
    return numpy.array(force), shapes


def slid_slab(case, fine, step, material, dt):
    """Half of it, glued below; the ball comes from above."""
    (wide, height, deep), reach = SLAB, 0.035
    up = height - meshes.graded(fine, fine, height, 1.5)[::-1]
    grid = Grid([even(-wide / 2, wide / 2, fine), up, even(0, deep / 2, fine)])
    top = grid.on(1, height)
    x, _, z = grid.nodes[top].T
    touching = top[numpy.hypot(numpy.maximum(abs(x - 0.004) - 0.004, 0), z) < reach]
    body = Body(grid, material, held(grid, 0.0, (2,)), touching, step, light=(1, height))
    force, shapes = gripped(case, body, step, dt, 2)
    at = mirrored(grid, 1, height, (2,), shapes, True)
    return force, shapes, lambda nodes: chosen(nodes, nodes[:, 1] > height - 1e-6, at)


def pinched_block(case, fine, step, material, dt):
    """A quarter, between the planes x = 0 and z = 0; the ball comes from -x."""
    side = -BLOCK / 2
    grid = Grid([joined((side, side * 2 / 3, fine), (side * 2 / 3, 0, 2 * fine)), even(side, -side, fine),
                 even(0, -side, fine)])
    face, (_, y, z) = grid.on(0, side), grid.nodes.T
    body = Body(grid, case["bodies"][0]["material"], held(grid, None, (0, 2)), face[numpy.hypot(y, z)[face] < 0.029], step,
                gravity=numpy.array(case["gravity"]), light=(0, side))
    force, shapes = gripped(case, body, step, dt, 2)
    at = mirrored(grid, 0, side, (2,), shapes, True)
    return force, shapes, lambda nodes: chosen(nodes, nodes[:, 0] < side + 1e-6, at)


def smooth(time, begin, end):
    """From 0 to 1, without jumps of the acceleration."""
    share = numpy.clip((time - begin) / (end - begin), 0, 1)
    return share - numpy.sin(2 * numpy.pi * share) / (2 * numpy.pi)


def thinned(rows):
    """Of rows (time, place): of a place that stays the first and the last."""
    return rows[:1] + [now for before, now, after in zip(rows, rows[1:], rows[2:])
                       if before[1:] != now[1:] or now[1:] != after[1:]] + rows[-1:]


def path_of(time, x, y, z):
    return thinned([[round(value, 9) for value in row] for row in zip(time.tolist(), *numpy.broadcast_arrays(x, y, z))])


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

    time = numpy.arange(0, 0.45 + dt / 2, dt)
    away = 8e-3 * smooth(time, 0.0, 0.25) - 3e-2 * smooth(time, 0.26, 0.36)
    swing = case("swing", "a bar, glued at its lower end, is pushed aside by a rigid ball and let go", 0.45,
                 [0.15, 0.26, 0.28, 0.34, 0.4, 0.45], "bar.msh", BAR, True,
                 [{"radius": PUSHER, "friction": 0.0,
                   "path": path_of(time, away - BAR[0] / 2 - PUSHER, 0.17, 0.0)}])
    swing["bodies"][0]["material"] = {**material, "youngs_modulus": 2e6, "rayleigh_beta": 1e-3}
    time = numpy.arange(0, 0.34 + dt / 2, dt)
    deep = 1.5e-3 * smooth(time, 0.0, 0.09) - 3e-3 * smooth(time, 0.24, 0.34)
    along = 8e-3 * smooth(time, 0.06, 0.17) - 4e-3 * smooth(time, 0.17, 0.25)
    slide = case("slide", "a rigid ball slides to and fro on a slab that is glued to a table", 0.34,
                 [0.07, 0.12, 0.17, 0.22], "slab.msh", SLAB, True,
                 [{"radius": SLIDER, "friction": 0.5, "path": path_of(time, along, SLAB[1] + SLIDER - deep, 0.0)}])
    time = numpy.arange(0, 0.3 + dt / 16, dt / 8)
    deep, high = 1e-3 * smooth(time, 0.0, 0.03), 0.03 * smooth(time, 0.08, 0.26)
    away = BLOCK / 2 + FINGER - deep
    pinch = case("pinch", "two rigid balls pinch a cube that begins to fall, and lift it", 0.3,
                 [0.02, 0.08, 0.16, 0.3], "block.msh", [BLOCK] * 3, False,
                 [{"radius": FINGER, "friction": 0.5, "path": path_of(time, sign * away, high, 0.0)}
                  for sign in (-1, 1)])
    pinch["gravity"] = cubes["gravity"]
    pinch["bodies"][0]["material"] = {**material, "rayleigh_beta": 1e-3}
    return [
        (cubes, two_cubes, (EDGE / 12, 2.5e-4)),
        (swing, pushed_bar, (2e-3, 2.5e-4)),
        (slide, slid_slab, (SLAB[0] / 16, 5e-4)),
        (pinch, pinched_block, (BLOCK / 18, 1.25e-4)),
    ]
