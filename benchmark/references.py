#!/usr/bin/env python3
"""Makes cases/*.json, cases/*.msh and references/*.json: references.py [NAME...]

The truth is linear elasticity by finite elements of this folder (fem.py, contact.py), on refined meshes and steps, with
exact geometry of the contact; no program under test is used. Each reference says how far it moved when mesh and step
were refined once more.
"""

import json
import sys
from pathlib import Path

import numpy

import meshes
import solids
from contact import Body, sphere
from fem import Grid

HERE = Path(__file__).resolve().parent
GRAVITY = [0.0, 0.0, 0.0]
DT = 0.001  # of the tables over time [s]
SOFT = {"youngs_modulus": 1e5, "poisson_ratio": 0.4, "density": 1000.0, "rayleigh_alpha": 0.0, "rayleigh_beta": 5e-4}
PUCK_RADIUS, PUCK_HEIGHT = 0.06, 0.06
BALL_RADIUS = 0.05
TOOL_RADIUS = 0.05
INCLUSION = {"centre": [0.0, 0.045, 0.0], "radius": 0.010}
RING_THROAT, RING_CURVATURE, RING_OUTER, RING_HEIGHT = 0.020, 0.040, 0.050, 0.040
PEG_RADIUS = 0.0215


def puck_mesh():
    """A cylinder that stands on y = 0."""
    half = meshes.graded(0.005, 0.010, PUCK_RADIUS, 2.0)
    across = numpy.r_[-half[:0:-1], half]
    up = PUCK_HEIGHT - meshes.graded(0.005, 0.010, PUCK_HEIGHT, 1.8)[::-1]
    return meshes.tetrahedra([across / PUCK_RADIUS, up, across / PUCK_RADIUS], lambda x: numpy.stack(
        [PUCK_RADIUS * meshes.disc(x)[:, 0], x[:, 1], PUCK_RADIUS * meshes.disc(x)[:, 2]], axis=1))


def ball_mesh():
    """Round the origin, finest at its top."""
    half = meshes.graded(0.1, 0.2, 1.0, 2.2)
    across = numpy.r_[-half[:0:-1], half]
    up = 1 - meshes.graded(0.1, 0.1, 2.0, 1.6)[::-1]
    return meshes.tetrahedra([across, up, across], lambda x: BALL_RADIUS * meshes.ball(x))


def wall(height):
    """Radius of the ring's hole: narrowest half-way."""
    return RING_THROAT + (height - RING_HEIGHT / 2) ** 2 / (2 * RING_CURVATURE)


def ring_mesh(around=48):
    share = meshes.graded(0.2, 0.2, 1.0, 1.6)
    angle = 2 * numpy.pi * numpy.arange(around + 1) / around

    def shape(x):
        radius = wall(x[:, 1]) + x[:, 0] * (RING_OUTER - wall(x[:, 1]))
        return numpy.stack([radius * numpy.cos(x[:, 2]), x[:, 1], radius * numpy.sin(x[:, 2])], axis=1)
    nodes, tets = meshes.tetrahedra([share, numpy.linspace(0, RING_HEIGHT, 9), angle], shape)
    first = numpy.arange(len(nodes)).reshape(-1, around + 1)
    last = first.copy()
    last[:, -1] = first[:, 0]  # closes the ring
    kept, number = numpy.unique(last.ravel(), return_inverse=True)
    return nodes[kept], number[tets]


MESHES = {"puck.msh": puck_mesh, "ball.msh": ball_mesh, "ring.msh": ring_mesh, **solids.MESHES}


def puck_grid(fine, deep=0.008):
    """`deep`: how far from the top cells are of the size `fine`."""
    up = PUCK_HEIGHT - meshes.graded(fine, deep, PUCK_HEIGHT, 1.25)[::-1]
    return Grid([meshes.graded(fine, 0.012, PUCK_RADIUS, 1.25), up])


def ball_grid(fine):
    up = 1 - meshes.graded(fine / BALL_RADIUS, 0.2, 2.0, 1.25)[::-1]
    return Grid([meshes.graded(fine / BALL_RADIUS, 0.28, 1.0, 1.25), up], lambda x: BALL_RADIUS * meshes.disc(x))


def near_top(grid, top, reach):
    """Nodes that may touch; not the one on the axis, which has no force of its own there."""
    nodes = grid.on(1, top)
    return nodes[(grid.nodes[nodes, 0] < reach) & (grid.nodes[nodes, 0] > 0)]


def pressed_puck(case, fine, step):
    """A ball led along the axis into a puck, fixed or floating."""
    material, deep = SOFT, 0.008
    for region in case["bodies"][0].get("regions", []):
        ball = region["ball"]
        material = {**SOFT, "stiffer": (numpy.array(ball["centre"][:2]), ball["radius"],
                                        region["youngs_modulus"] / SOFT["youngs_modulus"])}
        deep = PUCK_HEIGHT - ball["centre"][1] + ball["radius"]
    grid = puck_grid(fine, deep)
    fixed = 2 * grid.on(0, 0.0)
    if "fixed_below" in case["bodies"][0]:
        bottom = grid.on(1, 0.0)
        fixed = numpy.unique(numpy.r_[fixed, 2 * bottom, 2 * bottom + 1])
    body = Body(grid, material, fixed, near_top(grid, PUCK_HEIGHT, 0.018), step)
    path = numpy.array(case["tools"][0]["path"])

    def gap(time):
        return sphere(numpy.array([0.0, numpy.interp(time, path[:, 0], path[:, 2])]), TOOL_RADIUS)

    top = grid.on(1, PUCK_HEIGHT)
    force, shapes = run(case, body, gap, top, step)
    return force, shapes, lambda nodes: surface(nodes, numpy.hypot(nodes[:, 0], nodes[:, 2]), grid.nodes[top, 0], shapes,
                                                nodes[:, 1] > PUCK_HEIGHT - 1e-6)


def pegged_ring(case, fine, step):
    """A ball led along the axis through a narrower hole."""
    across = meshes.graded(fine / (RING_OUTER - RING_THROAT), 0.1, 1.0, 1.25)
    grid = Grid([across, numpy.linspace(0, RING_HEIGHT, round(RING_HEIGHT / fine) + 1)], lambda x: numpy.stack(
        [wall(x[:, 1]) + x[:, 0] * (RING_OUTER - wall(x[:, 1])), x[:, 1]], axis=1))
    bottom, inner = grid.on(1, 0.0), grid.on(0, 0.0)
    body = Body(grid, SOFT, numpy.r_[2 * bottom, 2 * bottom + 1], inner[1:], step)
    path = numpy.array(case["tools"][0]["path"])

    def gap(time):
        return sphere(numpy.array([0.0, numpy.interp(time, path[:, 0], path[:, 2])]), PEG_RADIUS)

    force, shapes = run(case, body, gap, inner, step)
    return force, shapes, lambda nodes: surface(
        nodes, nodes[:, 1], grid.nodes[inner, 1], shapes,
        abs(numpy.hypot(nodes[:, 0], nodes[:, 2]) - wall(nodes[:, 1])) < 1e-6)


def two_balls(case, fine, step):
    """One of two equal balls, which meets their plane of symmetry."""
    grid = ball_grid(fine)
    start, velocity = case["bodies"][0]["position"][1], case["bodies"][0]["velocity"][1]
    body = Body(grid, SOFT, 2 * grid.on(0, 0.0), near_top(grid, 1.0, 0.018), step, numpy.array([0.0, velocity]))

    def gap(_):
        def below(points):
            return -start - points[:, 1], numpy.array([0.0, -1.0]) + 0 * points
        return below

    top = grid.on(1, 1.0)
    force, shapes = run(case, body, gap, top, step)
    angle = numpy.arctan2(grid.nodes[top, 0], grid.nodes[top, 1])

    def at(nodes):
        own = numpy.arctan2(numpy.hypot(nodes[:, 0], nodes[:, 2]), nodes[:, 1])
        outside = numpy.linalg.norm(nodes, axis=1) > BALL_RADIUS - 1e-6
        return surface(nodes, own, angle, shapes, outside & (own < 0.7))
    return force, shapes, at


def run(case, body, gap, watched, step):
    """Force on what presses, along y at the ends of the table's steps; displacements of `watched` at the samples."""
    every = round(DT / step)
    force, shapes = [], []
    for k in range(1, round(case["duration"] / step) + 1):
        pushed = body.advance(gap(k * step))
        if k % every == 0:
            force.append(-pushed[:, 1].sum())
            if any(abs(k * step - time) < step / 2 for time in case["sample_times"]):
                shapes.append(body.u[0].reshape(-1, 2)[watched])
    return numpy.array(force), shapes


def surface(nodes, place, places, shapes, which):
    """Displacements (samples, chosen nodes, 3) of the chosen nodes of the engines' mesh."""
    chosen = numpy.flatnonzero(which)
    outward = nodes[chosen][:, [0, 2]]
    outward = outward / numpy.maximum(numpy.linalg.norm(outward, axis=1), 1e-12)[:, None]
    moved = []
    for shape in shapes:
        along, up = (numpy.interp(place[chosen], places, shape[:, axis]) for axis in range(2))
        moved.append(numpy.stack([along * outward[:, 0], up, along * outward[:, 1]], axis=1))
    return chosen, numpy.array(moved)


def puck_case(name, about, depths, samples, fixed, regions=()):
    """depths: (time, how deep the ball is in the face at rest)."""
    centre = PUCK_HEIGHT + TOOL_RADIUS
    body = {"mesh": "puck.msh", "material": SOFT, "mass": 1000.0 * numpy.pi * PUCK_RADIUS**2 * PUCK_HEIGHT}
    if fixed:
        body["fixed_below"] = 0.0
    if regions:
        body["regions"] = list(regions)
    path = solids.thinned([[round(t, 6), 0.0, round(centre - d, 9), 0.0] for t, d in depths])
    return {"name": name, "about": about, "duration": path[-1][0], "gravity": GRAVITY, "bodies": [body],
            "tools": [{"radius": TOOL_RADIUS, "friction": 0.0, "path": path}], "sample_times": samples}


def peg_case():
    points, weights = numpy.polynomial.legendre.leggauss(3)  # exact
    across = numpy.pi * (RING_OUTER**2 - wall(RING_HEIGHT / 2 * (1 + points)) ** 2)
    body = {"mesh": "ring.msh", "material": SOFT, "mass": float(500.0 * RING_HEIGHT * (weights @ across)),
            "fixed_below": 0.0}
    path = [[round(t, 6), 0.0, round(RING_HEIGHT / 2 + 0.015 * numpy.cos(numpy.pi * t / 0.6), 9), 0.0]
            for t in numpy.arange(0, 0.6005, DT)]
    return {"name": "peg", "about": "a rigid ball goes through a ring whose hole is narrower", "duration": 0.6,
            "gravity": GRAVITY, "bodies": [body],
            "tools": [{"radius": PEG_RADIUS, "friction": 0.0, "path": path}], "sample_times": [0.2, 0.3, 0.4]}


def ball_case():
    body = {"mesh": "ball.msh", "material": SOFT, "mass": 1000.0 * 4 / 3 * numpy.pi * BALL_RADIUS**3}
    away = BALL_RADIUS + 0.001
    return {"name": "two-spheres", "about": "two soft balls meet at 0.1 m/s each and part", "duration": 0.12,
            "gravity": GRAVITY, "friction": 0.0, "tools": [], "plane": 0.0,
            "sample_times": [0.03, 0.047, 0.1], "bodies": [
                {**body, "position": [0.0, -away, 0.0], "velocity": [0.0, 0.1, 0.0]},
                {**body, "position": [0.0, away, 0.0], "orientation": [0.0, 1.0, 0.0, 0.0],
                 "velocity": [0.0, -0.1, 0.0]}]}


def cases():
    """Each case with what computes it and (size of the finest cells [m], step [s])."""
    ramp = [(t, 2.5e-3 * (1 - numpy.cos(numpy.pi * t / 0.25)) / 2 - 5e-4) for t in numpy.arange(0, 0.2501, DT)]
    press = ramp + [(0.25 + t, depth) for t, depth in zip(numpy.arange(DT, 0.5, DT), [2e-3] * 249 + [d for _, d in ramp[::-1]])]
    tap = numpy.arange(0, 0.1501, DT)
    return [
        (puck_case("press", "a rigid ball presses a block that stands glued to a table",
                   press, [0.1, 0.25, 0.45, 0.6], True),
         pressed_puck, (5e-4, 5e-4)),
        (puck_case("tap", "a rigid ball taps it, at most 0.31 m/s",
                   [(t, -1e-3 + 3e-3 * max(0.0, numpy.sin(numpy.pi * (t - 0.02) / 0.03)) * (0.02 < t < 0.05)) for t in tap],
                   [0.03, 0.035, 0.042, 0.1], True), pressed_puck, (2.5e-4, 1.25e-4)),
        (puck_case("push", "a rigid ball at 0.1 m/s pushes a block that floats, which bounces off",
                   [(0, -1e-3), (0.15, 0.014)], [0.025, 0.045, 0.07, 0.12], False), pressed_puck, (5e-4, 1.25e-4)),
        (ball_case(), two_balls, (5e-4, 1.25e-4)),
        (puck_case("palpation", "press above a ball (radius 1 cm, 1.5 cm deep) that is ten times as stiff",
                   press, [0.1, 0.25, 0.45, 0.6], True,
                   [{"ball": INCLUSION, "youngs_modulus": 10 * SOFT["youngs_modulus"]}]), pressed_puck, (5e-4, 5e-4)),
        (peg_case(), pegged_ring, (2.5e-4, 5e-4)),
        *((case, lambda *args, compute=compute: compute(*args, SOFT, DT), sizes)
          for case, compute, sizes in solids.cases(SOFT, DT)),
    ]


def in_space(force):
    """Of a body of revolution only along y."""
    return force if force.ndim == 2 else numpy.stack([0 * force, force, 0 * force], axis=1)


def largest(force):
    return numpy.linalg.norm(in_space(force), axis=1).max()


def rounded(values, digits):
    return json.loads(json.dumps(numpy.round(values, digits).tolist()))


def main():
    for folder in ("cases", "references"):
        (HERE / folder).mkdir(exist_ok=True)
    for name, make in MESHES.items():
        meshes.write(HERE / "cases" / name, *make())
    for case, compute, (fine, step) in cases():
        name = case["name"]
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        write(HERE / "cases" / f"{name}.json", case)
        force, _, at = compute(case, fine, step)
        peak = largest(force)
        nodes, _ = meshes.read(HERE / "cases" / case["bodies"][0]["mesh"])
        chosen, displacements = at(nodes)
        size = abs(displacements).max()
        moved = {}
        for what, other in (("cells twice as large", (2 * fine, step)), ("steps twice as long", (fine, 2 * step))):
            coarse, _, coarse_at = compute(case, *other)
            moved[what] = {"force": float(f"{largest(coarse - force) / peak if peak > 0 else 0:.2g}"),
                           "surface": float(f"{abs(coarse_at(nodes)[1] - displacements).max() / size:.2g}")}
        write(HERE / "references" / f"{name}.json", {
            "case": name, "made_by": "references.py", "cells": fine, "step": step,
            "largest_change_by_peak_with": moved, "dt": DT,
            "force": rounded(in_space(force), 5), "nodes": chosen.tolist(),
            "displacements": rounded(displacements, 8)})
        print(f"{name}: peak {peak:.4g} N, {moved}", flush=True)


def write(path, table):
    path.write_text(json.dumps(table, separators=(",", ":")).replace('],"', '],\n"').replace('},"', '},\n"') + "\n",
                    encoding="utf-8")


if __name__ == "__main__":
    main()
