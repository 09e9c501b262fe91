#!/usr/bin/env python3
"""A case by irdm: irdm_engine.py [--ball [--quadratic] | --rigid-ball | --fine] SCENE.json RESULT.json (README.md: what both hold)

The tool is irdm's fingertip: its point is the ball's foremost one, its radius that of Hertz' contact at the greatest
depth. With --ball it is the ball of a stylus, with --rigid-ball a rigid body that a stylus leads. Linear elements of the
given mesh, all modes. With --quadratic: quadratic elements, twice as large as those of --fine where the case has a shape.
With --fine it is scenery, an exact ball on its path; quadratic elements, of shapes/ where the case has one, a quarter of
the step or less.
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import numpy

import irdm
import meshes
import ring_shape

COUPLING = 1e5  # N/m; a fixed object needs a spring
SHAPES = Path(__file__).resolve().parent / "shapes"
FINE_MODES = 300  # where all would take long
ALL_MODES = ("ball.geo", "bar.geo", "block.geo", "cube.geo", "puck.geo")
FINE_STEPS = 4  # in one of the case ...
FINER_STEPS = {"pinch": 8}  # ... and where friction follows a force that rises within 20 ms
BALL_CELLS = 15  # in a quarter circle: nodes of the surface
BALL_DENSITY = 20000.0  # kg/m^3: what touches it hardly moves it


def table_of(body, dt, mesh):
    """What irdm-precompute is given."""
    material = {key: body["material"][key] for key in
                ("youngs_modulus", "poisson_ratio", "rayleigh_alpha", "rayleigh_beta")}
    config = {"mesh": {"file": str(mesh), "order": 1}, "material": {**material, "density": body["density"]},
              "response": {"dt": dt, "steps": 500}}
    if "regions" in body:
        config["region"] = body["regions"]
    if "fixed_below" in body:
        config["response"]["support"] = "fixed"
        config["support"] = {"half_space": {"point": [0, body["fixed_below"] + 1e-9, 0], "normal": [0, 1, 0]}}
    return config


def given_mesh(body, folder):
    mesh = folder / f"body{len(list(folder.iterdir()))}.msh"
    meshes.write(mesh, numpy.array(body["nodes"]), numpy.array(body["tets"]))
    return mesh


def model(body, dt, folder):
    return irdm.precompute(table_of(body, dt, given_mesh(body, folder)), threads=1)


def shape_of(body, folder):
    """A file with a shape of our own; none: None."""
    if body["mesh"] == "ring.msh":
        meshes.write(folder / "ring.msh", *ring_shape.mesh())
        return folder / "ring.msh"
    shape = SHAPES / ("palpation.geo" if "regions" in body else Path(body["mesh"]).with_suffix(".geo"))
    return shape if shape.exists() else None


def volume(mesh, dt):
    """Of the body that a mesh is [m^3]."""
    rigid = {"mesh": mesh, "material": {"rigid": True, "density": 1000.0}, "response": {"dt": dt}}
    return irdm.precompute(rigid, threads=1).mass / 1000.0


def fine_model(body, dt, folder):
    """Of a shape of our own, else of the given mesh; with some modes where all would take long."""
    return model_of_shape(body, dt, folder, shape_of(body, folder))


def coarse_model(body, dt, folder):
    """The same with elements twice as large."""
    shape = shape_of(body, folder)
    if shape and shape.suffix == ".geo":
        coarse = folder / shape.name
        coarse.write_text(shape.read_text(encoding="utf-8") + "Mesh.MeshSizeFactor = 1.4;\n", encoding="utf-8")
        shape = coarse
    return model_of_shape(body, dt, folder, shape)


def model_of_shape(body, dt, folder, shape):
    config = table_of(body, dt, shape or given_mesh(body, folder))
    config["mesh"]["order"] = 2
    if shape:
        config["material"]["density"] = body["mass"] / volume(config["mesh"], dt)
    if shape and shape.suffix == ".msh":
        config["modes"] = {"count": FINE_MODES, "contact_radius": ring_shape.OUTER}  # it is touched all round
    elif not shape or shape.name not in ALL_MODES:
        config["modes"] = {"count": FINE_MODES}
    return irdm.precompute(config, threads=1)


def fingertip_radius(scene):
    """sqrt(radius depth): the depth of the tool's ball in the body at rest, or of Hertz' impact on a floating one."""
    tool, body = scene["tools"][0], scene["bodies"][0]
    path, radius = numpy.array(tool["path"]), tool["radius"]
    depth = max(node[1] for node in body["nodes"]) - (path[:, 2] - radius).min()
    if "fixed_below" not in body:
        material = body["material"]
        modulus = material["youngs_modulus"] / (1 - material["poisson_ratio"] ** 2)
        speed = abs(numpy.diff(path[:, 2]) / numpy.diff(path[:, 0])).max()
        depth = (15 * body["mass"] * speed**2 / (16 * modulus * numpy.sqrt(radius))) ** 0.4
    return float(numpy.sqrt(radius * depth))


def centre(tool, time):
    path = numpy.array(tool["path"])
    return numpy.array([numpy.interp(time, path[:, 0], path[:, axis]) for axis in (1, 2, 3)])


class Fingertip:
    """A tool as a patch of fixed radius, on a spring where irdm asks for one."""

    def __init__(self, scene):
        self.tool = scene["tools"][0]
        nodes = numpy.array(scene["bodies"][0]["nodes"])
        start = centre(self.tool, 0.0)
        first = nodes[numpy.argmin(numpy.linalg.norm(nodes - start, axis=1))] - start
        self.foremost = self.tool["radius"] * first / numpy.linalg.norm(first)
        radius = fingertip_radius(scene)
        stiffness = COUPLING if "fixed_below" in scene["bodies"][0] else 0
        self.styluses = [{"radius": radius, "coupling_stiffness": stiffness}]
        self.objects, self.scenery = [], []
        self.settings = f"fingertip of {1e3 * radius:.1f} mm, spring {stiffness:g} N/m"

    def tips(self, time):
        return [centre(self.tool, time) + self.foremost]

    def force(self, step):
        return step.styluses["force"][0]


class Ball:
    """A tool as the ball of a stylus, without a spring."""

    def __init__(self, scene):
        self.tools = scene["tools"]
        self.styluses = [{"shape": "ball", "radius": tool["radius"], "coupling_stiffness": 0} for tool in self.tools]
        self.objects, self.scenery = [], []
        self.settings = "ball of a stylus, no spring"
        scene["friction"] = self.tools[0]["friction"]  # such a ball has that of the object

    def tips(self, time):
        return [centre(tool, time) for tool in self.tools]

    def force(self, step):
        return step.styluses["force"][0]


class RigidBall:
    """A tool as a rigid body, led by nearly the stiffest spring that irdm accepts."""

    def __init__(self, scene):
        self.tool, dt = scene["tools"][0], scene["dt"]
        mass = BALL_DENSITY * 4 / 3 * numpy.pi * self.tool["radius"] ** 3
        one = irdm.precompute({"mesh": {"sphere": {"radius": self.tool["radius"], "cells": BALL_CELLS}},
                               "material": {"rigid": True, "density": BALL_DENSITY}, "response": {"dt": dt}}, threads=1)
        friction = {"static": self.tool["friction"], "kinetic": self.tool["friction"]}
        self.objects = [{"name": "ball", "model": one, "position": self.tip(0.0), "friction": friction,
                         "velocity": (self.tip(dt) - self.tip(0.0)) / dt}]
        stiffness = 0.4 * mass / dt**2
        self.styluses, self.scenery = [{"tool": {"object": "ball", "stiffness": stiffness}}], []
        self.number = len(scene["bodies"])
        self.settings = (f"rigid ball of {mass:.2g} kg, {BALL_CELLS} cells in a quarter circle, "
                         f"spring {stiffness:.2g} N/m")

    def tips(self, time):
        return [self.tip(time)]

    def tip(self, time):
        return centre(self.tool, time)

    def force(self, step):
        return on_object(step, self.number)


class Kinematic:
    """Tools as scenery: exact balls on their paths."""

    def __init__(self, scene):
        self.scenery = [{"name": f"tool{number}", **self.ball(tool)} for number, tool in enumerate(scene["tools"])]
        self.objects, self.styluses = [], []
        self.settings = "exact ball on its path"

    @staticmethod
    def ball(tool):
        start = centre(tool, 0.0)
        path = [{"time": row[0], "displacement": (numpy.array(row[1:]) - start).tolist()} for row in tool["path"]]
        return {"sphere": {"radius": tool["radius"]}, "position": start.tolist(), "motion": {"path": path},
                "friction": {"static": tool["friction"], "kinetic": tool["friction"]}}

    def force(self, step):
        contacts = step.contacts
        first = (contacts["kind"] == irdm.SCENERY) & (contacts["other"] == 0)
        return -contacts["force"][first].sum(axis=0)


def on_object(step, number):
    """All contacts of an object with others [N], W."""
    contacts = step.contacts
    which = (contacts["object"] == number) & (contacts["kind"] == irdm.OBJECT)
    return contacts["force"][which].sum(axis=0)


def run(scene, tool_kind, quadratic=False):
    fine = tool_kind is Kinematic
    parts = FINER_STEPS.get(scene["name"], FINE_STEPS) if fine else 1
    dt = scene["dt"] / parts
    tool = tool_kind(scene) if scene["tools"] else None
    with tempfile.TemporaryDirectory() as folder:
        make = fine_model if fine else coarse_model if quadratic else model
        models = [make(body, dt, Path(folder)) for body in scene["bodies"]]
        objects, starts = [], []
        for number, (body, one) in enumerate(zip(scene["bodies"], models)):
            own = (fine or quadratic) and shape_of(body, Path(folder))  # in the frame of its file
            orientation = body.get("orientation", [1, 0, 0, 0]) if own else [1, 0, 0, 0]
            turn = meshes.rotation(orientation)
            if own:
                shift = turn @ one.com_offset + body.get("position", [0, 0, 0])
            else:
                shift = numpy.array(body["nodes"]).min(axis=0) - one.volume_nodes.min(axis=0)
            objects.append({"name": f"body{number}", "model": one, "position": shift, "orientation": orientation,
                            "friction": {"static": scene["friction"], "kinetic": scene["friction"]},
                            "velocity": body.get("velocity", [0, 0, 0])})
            starts.append(one.nodes @ turn.T + shift)
        table = {"object": objects + (tool.objects if tool else [])}
        if tool:
            table["stylus"], table["scenery"] = tool.styluses, tool.scenery
        if fine:
            table["contact"] = {"samples": 4096}
        simulation = irdm.Simulation(table)
    if any(scene["gravity"]):
        if any("fixed_below" in body for body in scene["bodies"]):
            simulation.step()  # fixed ones begin at rest under gravity, here at rest without
        simulation.gravity = scene["gravity"]
    steps = round(scene["duration"] / scene["dt"])
    samples = {round(t / scene["dt"]) for t in scene["sample_times"]}
    force, taken, shapes = [], [], []
    styluses = tool.styluses if tool else []
    for k in range(1, steps + 1):
        mean, took = numpy.zeros(3), 0
        for part in range(parts):
            now = ((k - 1) * parts + part + 1) * dt
            tips = tool.tips(now) if styluses else None
            begin = time.process_time_ns()
            step = simulation.step(tips)
            took += time.process_time_ns() - begin
            mean += (tool.force(step) if tool else on_object(step, 1)) / parts
        taken.append(took / 1e3)
        force.append(mean.tolist())
        if k in samples:
            shapes.append(matched(scene, starts[0], models[0].triangles, simulation.surface(0)))
    settings = "linear elements, all modes"
    if fine or quadratic:
        settings = f"quadratic elements, all modes or {FINE_MODES}, steps of {1e3 * dt:g} ms"
    settings += f", {tool.settings}" if tool else ""
    return {"version": irdm.__version__, "settings": settings, "dt": scene["dt"], "force": force,
            "step_us": numpy.percentile(taken, [50, 99]).tolist(), "positions": shapes}


def weights_in(corners, point):
    """Barycentric, of a point in triangles (t, 3, 3), with their distances from it."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac, way = b - a, c - a, point - a
    dot = lambda x, y: numpy.einsum("ij,ij->i", x, y)
    determinant = dot(ab, ab) * dot(ac, ac) - dot(ab, ac) ** 2
    v = (dot(ac, ac) * dot(way, ab) - dot(ab, ac) * dot(way, ac)) / determinant
    w = (dot(ab, ab) * dot(way, ac) - dot(ab, ac) * dot(way, ab)) / determinant
    weights = numpy.clip(numpy.stack([1 - v - w, v, w], axis=1), 0, None)
    weights /= weights.sum(axis=1, keepdims=True)
    return weights, numpy.linalg.norm(numpy.einsum("ti,tij->tj", weights, corners) - point, axis=1)


def matched(scene, start, triangles, now):
    """Where the mesh's nodes are that the reference looks at, on the surface that irdm has."""
    found = []
    for node in numpy.array(scene["bodies"][0]["nodes"])[scene["watched"]]:
        weights, distance = weights_in(start[triangles], node)
        nearest = numpy.argmin(distance)
        moved = (now - start)[triangles[nearest]]
        found.append((node + weights[nearest] @ moved).tolist())
    return found


def main():
    arguments = sys.argv[1:]
    kind = {"--ball": Ball, "--rigid-ball": RigidBall, "--fine": Kinematic}.get(arguments[0], Fingertip)
    scene = json.loads(Path(arguments[-2]).read_text(encoding="utf-8"))
    Path(arguments[-1]).write_text(json.dumps(run(scene, kind, "--quadratic" in arguments)), encoding="utf-8")


if __name__ == "__main__":
    main()
