#!/usr/bin/env python3
"""A case by irdm: irdm_engine.py [--ball] SCENE.json RESULT.json (README.md: what both hold)

The tool is irdm's fingertip: its point is the ball's foremost one, its radius that of Hertz' contact at the greatest
depth. With --ball it is a rigid body that a stylus leads. Linear elements of the given mesh, all modes.
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import numpy

import irdm
import meshes

COUPLING = 1e5  # N/m; a fixed object needs a spring
BALL_CELLS = 15  # in a quarter circle: irdm accepts 1500 nodes
BALL_DENSITY = 20000.0  # kg/m^3: what touches it hardly moves it


def model(body, dt, folder):
    mesh = folder / f"body{len(list(folder.iterdir()))}.msh"
    meshes.write(mesh, numpy.array(body["nodes"]), numpy.array(body["tets"]))
    material = {key: body["material"][key] for key in
                ("youngs_modulus", "poisson_ratio", "rayleigh_alpha", "rayleigh_beta")}
    config = {"mesh": {"file": str(mesh), "order": 1}, "material": {**material, "density": body["density"]},
              "response": {"dt": dt, "steps": 500}}
    if "regions" in body:
        config["region"] = body["regions"]
    if "fixed_below" in body:
        config["response"]["support"] = "fixed"
        config["support"] = {"half_space": {"point": [0, body["fixed_below"] + 1e-9, 0], "normal": [0, 1, 0]}}
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
        self.styluses, self.objects = [{"radius": radius, "coupling_stiffness": stiffness}], []
        self.settings = f"fingertip of {1e3 * radius:.1f} mm, spring {stiffness:g} N/m"

    def tip(self, time):
        return centre(self.tool, time) + self.foremost

    def force(self, step):
        return step.styluses["force"][0]


class Ball:
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
        self.styluses = [{"tool": {"object": "ball", "stiffness": stiffness}}]
        self.number = len(scene["bodies"])
        self.settings = (f"rigid ball of {mass:.2g} kg, {BALL_CELLS} cells in a quarter circle, "
                         f"spring {stiffness:.2g} N/m")

    def tip(self, time):
        return centre(self.tool, time)

    def force(self, step):
        return on_object(step, self.number)


def on_object(step, number):
    """All contacts of an object with others [N], W."""
    contacts = step.contacts
    which = (contacts["object"] == number) & (contacts["kind"] == irdm.OBJECT)
    return contacts["force"][which].sum(axis=0)


def run(scene, tool_kind):
    dt = scene["dt"]
    tool = tool_kind(scene) if scene["tools"] else None
    with tempfile.TemporaryDirectory() as folder:
        models = [model(body, dt, Path(folder)) for body in scene["bodies"]]
        objects, starts = [], []
        for number, (body, one) in enumerate(zip(scene["bodies"], models)):
            node = numpy.array(body["nodes"])[numpy.array(body["tets"])[0, 0]]
            shift = node - one.volume_nodes[numpy.array(body["tets"])[0, 0]]
            objects.append({"name": f"body{number}", "model": one, "position": shift,
                            "friction": {"static": scene["friction"], "kinetic": scene["friction"]},
                            "velocity": body.get("velocity", [0, 0, 0])})
            starts.append(one.nodes + shift)
        table = {"world": {"gravity": scene["gravity"]}, "object": objects + (tool.objects if tool else [])}
        if tool:
            table["stylus"] = tool.styluses
        simulation = irdm.Simulation(table)
    steps = round(scene["duration"] / dt)
    samples = {round(t / dt) for t in scene["sample_times"]}
    force, taken, shapes = [], [], []
    for k in range(1, steps + 1):
        begin = time.process_time_ns()
        step = simulation.step([tool.tip(k * dt)] if tool else None)
        taken.append((time.process_time_ns() - begin) / 1e3)
        force.append((tool.force(step) if tool else on_object(step, 1)).tolist())
        if k in samples:
            shapes.append(matched(scene, starts[0], simulation.surface(0)))
    settings = "linear elements, all modes" + (f", {tool.settings}" if tool else "")
    return {"version": irdm.__version__, "settings": settings, "dt": dt, "force": force, "step_us": numpy.percentile(taken, [50, 99]).tolist(), "positions": shapes}


def matched(scene, start, now):
    """Where the mesh's nodes are that the reference looks at; irdm numbers surface nodes on its own."""
    found = []
    for node in numpy.array(scene["bodies"][0]["nodes"])[scene["watched"]]:
        found.append(now[numpy.argmin(numpy.linalg.norm(start - node, axis=1))].tolist())
    return found


def main():
    arguments = sys.argv[1:]
    kind = Ball if arguments[0] == "--ball" else Fingertip
    scene = json.loads(Path(arguments[-2]).read_text(encoding="utf-8"))
    Path(arguments[-1]).write_text(json.dumps(run(scene, kind)), encoding="utf-8")


if __name__ == "__main__":
    main()
