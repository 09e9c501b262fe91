#!/usr/bin/env python3
"""Runs an engine on the cases and says how far it is from the truth: run.py --engine NAME [--case NAME] (README.md)

With --table: prints the table of all results in results/.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

import meshes

HERE = Path(__file__).resolve().parent
BUILT = HERE.parent / "out" / "benchmark"  # by engines/setup.sh
ENGINES = {"irdm": [sys.executable, str(HERE / "irdm_engine.py")],
           "irdm, fine": [sys.executable, str(HERE / "irdm_engine.py"), "--fine"],
           "irdm, ball": [sys.executable, str(HERE / "irdm_engine.py"), "--ball"],
           "irdm, ball, quadratic": [sys.executable, str(HERE / "irdm_engine.py"), "--ball", "--quadratic"],
           "irdm, rigid ball": [sys.executable, str(HERE / "irdm_engine.py"), "--rigid-ball"],
           "bullet": [str(BUILT / "bullet")],
           "jolt": ["node", str(BUILT / "jolt.mjs")],
           "jolt, 10 substeps": ["node", str(BUILT / "jolt.mjs"), "--substeps", "10"],
           "mujoco": ["node", str(BUILT / "mujoco.mjs")]}
# As irdm-replay judges forces (docs/replay.md, "Comparing").
JND = 0.10
JND_TIME = 0.1  # s
JND_SMALL = 0.5  # N


class Error(Exception):
    pass


def case_names():
    return sorted(path.stem for path in (HERE / "cases").glob("*.json"))


def choose(name, known, what):
    if name not in known:
        raise Error(f"--{what} {name}: is unknown; use one of: {', '.join(known)}")
    return name


def scene_of(name):
    """A case with its meshes where they start, and its reference: all that an adapter needs."""
    case = json.loads((HERE / "cases" / f"{name}.json").read_text(encoding="utf-8"))
    reference = json.loads((HERE / "references" / f"{name}.json").read_text(encoding="utf-8"))
    scene = {"dt": reference["dt"], "friction": 0.0, **case, "watched": reference["nodes"]}
    for body in scene["bodies"]:
        nodes, tets = meshes.read(HERE / "cases" / body["mesh"])
        volume = meshes.signed_volume(nodes, tets)
        nodes = nodes @ meshes.rotation(body.get("orientation", [1, 0, 0, 0])).T + body.get("position", [0, 0, 0])
        density = body["mass"] / volume.sum()  # the mesh has the body's mass, if not its volume
        node_mass = numpy.bincount(tets.ravel(), weights=numpy.repeat(density * volume / 4, 4))
        young = numpy.full(len(tets), body["material"]["youngs_modulus"])
        for region in body.get("regions", []):
            ball = region["ball"]
            inside = numpy.linalg.norm(nodes[tets].mean(axis=1) - ball["centre"], axis=1) <= ball["radius"]
            young[inside] = region["youngs_modulus"]
        body.update(nodes=nodes.tolist(), tets=tets.tolist(), density=density, node_mass=node_mass.tolist(),
                    triangles=meshes.surface_of(tets).tolist(),
                    youngs_modulus=young.tolist(),
                    highest_frequency=meshes.highest_frequency(
                        nodes, tets, {**body["material"], "youngs_modulus": young}, density))
    return scene, reference


def smoothed(force, dt):
    reach = int(numpy.floor(0.5 * JND_TIME / dt * (1 + 1e-9)))
    return numpy.array([force[max(k - reach, 0):k + reach + 1].mean(axis=0) for k in range(len(force))])


def noticeable(truth, force, dt):
    """Largest difference in just noticeable differences."""
    a, b = smoothed(truth, dt), smoothed(force, dt)
    share = numpy.linalg.norm(b - a, axis=1) / numpy.maximum(numpy.linalg.norm(a, axis=1), JND_SMALL)
    return share.max() / JND


def tool_at(tool, time):
    path = numpy.array(tool["path"])
    return numpy.array([numpy.interp(time, path[:, 0], path[:, axis]) for axis in (1, 2, 3)])


def deepest(scene, positions):
    """How far watched nodes are inside the tool, or beyond the plane between two like bodies [m]; else None."""
    if not scene["tools"] and "plane" not in scene:
        return None
    depth = 0.0
    for time, nodes in zip(scene["sample_times"], numpy.array(positions)):
        if scene["tools"]:
            tool = scene["tools"][0]
            depth = max(depth, (tool["radius"] - numpy.linalg.norm(nodes - tool_at(tool, time), axis=1)).max())
        else:
            depth = max(depth, nodes[:, 1].max() - scene["plane"])
    return depth


def means_of_values(force):
    """Means over steps of a force that is known at their ends, and begins at zero."""
    return 0.5 * (force + numpy.vstack([numpy.zeros(3), force[:-1]]))


def means_of_means(force, own_dt, dt, count):
    """Means over `count` steps of dt of a force that is known as means over steps of own_dt: of its impulse."""
    impulse = numpy.vstack([numpy.zeros(3), own_dt * numpy.cumsum(force, axis=0)])
    own_time = own_dt * numpy.arange(len(impulse))
    time = dt * numpy.arange(count + 1)
    return numpy.stack([numpy.diff(numpy.interp(time, own_time, impulse[:, axis])) / dt for axis in range(3)], axis=1)


def score(scene, reference, found):
    dt = reference["dt"]
    truth = means_of_values(numpy.array(reference["force"]))
    force = means_of_means(numpy.array(found["force"], dtype=float), found["dt"], dt, len(truth))
    peak = numpy.linalg.norm(truth, axis=1).max()
    apart = numpy.linalg.norm(force - truth, axis=1)
    rest = numpy.array(scene["bodies"][0]["nodes"])[scene["watched"]]
    there = rest + numpy.array(reference["displacements"])
    surface = numpy.linalg.norm(numpy.array(found["positions"]) - there, axis=2).max()

    inside = deepest(scene, found["positions"])

    def digits(value):
        return float(f"{value:.3g}")
    return {"peak_N": digits(peak), "own_peak_N": digits(numpy.linalg.norm(force, axis=1).max()),
            "error_max_N": digits(apart.max()), "error_rms_N": digits(numpy.sqrt((apart**2).mean())),
            "jnd": digits(noticeable(truth, force, dt)), "surface_mm": digits(1e3 * surface),
            "penetration_mm": None if inside is None else digits(1e3 * max(0.0, inside)),
            "step_us": [digits(value) for value in found["step_us"]], "dt": found["dt"], "settings": found["settings"]}


def run(engine, name):
    scene, reference = scene_of(name)
    with tempfile.TemporaryDirectory() as folder:
        wanted, result = Path(folder) / "scene.json", Path(folder) / "result.json"
        wanted.write_text(json.dumps(scene), encoding="utf-8")
        command = [*ENGINES[engine], str(wanted), str(result)]
        try:
            done = subprocess.run(command, env={"OMP_NUM_THREADS": "1", **os.environ}, stderr=subprocess.PIPE, text=True)
        except OSError as error:
            raise Error(f"--engine {engine}: {command[0]} cannot be started ({error.strerror}); see README.md") from None
        if done.returncode != 0 or not result.is_file():
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise Error(f"--engine {engine}, --case {name}: its adapter failed: {last}")
        found = json.loads(result.read_text(encoding="utf-8"))
    return found["version"], score(scene, reference, found)


def table():
    lines = ["| case | engine | peak, truth, N | error, N | JND | surface, mm | inside, mm | step, us |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    results = [json.loads(path.read_text(encoding="utf-8")) for path in sorted((HERE / "results").glob("*.json"))]
    for name in case_names():
        for result in results:
            row = result["cases"].get(name)
            if row:
                inside = "" if row["penetration_mm"] is None else f"{row['penetration_mm']:g}"
                lines.append(f"| {name} | {result['engine']} | {row['own_peak_N']:g}, {row['peak_N']:g} | "
                             f"{row['error_max_N']:g} | {row['jnd']:g} | {row['surface_mm']:g} | "
                             f"{inside} | {row['step_us'][0]:g}, {row['step_us'][1]:g} |")
    return "\n".join(lines)


def save(path, engine, version, rows):
    """Adds rows to an engine's results."""
    result = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {"engine": engine, "cases": {}}
    result.update(version=version, machine=f"{platform.machine()}, {os.cpu_count()} cores, busy; processor time")
    result["cases"].update(rows)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--engine", help=", ".join(ENGINES))
    parser.add_argument("--case", help="default: all of " + ", ".join(case_names()))
    parser.add_argument("--save", type=Path, help="results file to add to, such as results/irdm.json")
    parser.add_argument("--table", action="store_true", help="prints the table of results/")
    options = parser.parse_args()
    if options.table:
        print(table())
        return
    if options.engine is None:
        parser.error("--engine or --table is required")
    choose(options.engine, list(ENGINES), "engine")
    names = [choose(options.case, case_names(), "case")] if options.case else case_names()
    rows = {}
    for name in names:
        version, rows[name] = run(options.engine, name)
        print(f"{name}: {json.dumps(rows[name])}", flush=True)
    if options.save:
        save(options.save, options.engine, version, rows)


if __name__ == "__main__":
    try:
        main()
    except Error as error:
        print(f"run.py: error: {error}", file=sys.stderr)
        sys.exit(1)
