#!/usr/bin/env python3
"""A case by irdm: irdm_engine.py SCENE.json RESULT.json (README.md: what both hold)

The tool is irdm's fingertip: its point is the ball's foremost one, its radius that of Hertz' contact at the greatest depth.
Bodies touch each other as irdm's bodies do. Linear elements of the given mesh, all modes.
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


def model(body, dt, folder):
    mesh = folder / f"body{len(list(folder.iterdir()))}.msh"
    meshes.write(mesh, numpy.array(body["nodes"]), numpy.array(body["tets"]))
    material = {key: body["material"][key] for key in
                ("youngs_modulus", "poisson_ratio", "rayleigh_alpha", "rayleigh_beta")}
    config = {"mesh": {"file": str(mesh), "order": 1}, "material": {**material, "density": body["density"]},
              "response": {"dt": dt, "steps": 500}}
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


def run(scene):
    dt = scene["dt"]
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
        table = {"world": {"gravity": scene["gravity"]}, "object": objects}
        settings = "linear elements, all modes"
        if scene["tools"]:
            stiffness = COUPLING if "fixed_below" in scene["bodies"][0] else 0
            table["stylus"] = [{"radius": fingertip_radius(scene), "coupling_stiffness": stiffness}]
            settings += f", fingertip of {1e3 * fingertip_radius(scene):.1f} mm, spring {stiffness:g} N/m"
        simulation = irdm.Simulation(table)
    steps = round(scene["duration"] / dt)
    samples = {round(t / dt) for t in scene["sample_times"]}
    force, taken, shapes = [], [], []
    for k in range(1, steps + 1):
        begin = time.process_time_ns()
        step = simulation.step(tips(scene, k * dt))
        taken.append((time.process_time_ns() - begin) / 1e3)
        if scene["tools"]:
            force.append(step.styluses["force"][0].tolist())
        else:
            on = step.contacts["force"][step.contacts["object"] == 1]
            force.append(on.sum(axis=0).tolist())
        if k in samples:
            shapes.append(matched(scene, starts[0], simulation.surface(0)))
    return {"version": irdm.__version__, "settings": settings, "dt": dt, "force": force,
            "step_us": numpy.percentile(taken, [50, 99]).tolist(), "positions": shapes}


def tips(scene, time):
    if not scene["tools"]:
        return None
    tool = scene["tools"][0]
    path = numpy.array(tool["path"])
    centre = [numpy.interp(time, path[:, 0], path[:, axis]) for axis in (1, 2, 3)]
    return [[centre[0], centre[1] - tool["radius"], centre[2]]]


def matched(scene, start, now):
    """Where the mesh's nodes are that the reference looks at; irdm numbers surface nodes on its own."""
    found = []
    for node in numpy.array(scene["bodies"][0]["nodes"])[scene["watched"]]:
        found.append(now[numpy.argmin(numpy.linalg.norm(start - node, axis=1))].tolist())
    return found


def main():
    scene = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    Path(sys.argv[2]).write_text(json.dumps(run(scene)), encoding="utf-8")


if __name__ == "__main__":
    main()
