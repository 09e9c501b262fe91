#!/usr/bin/python3
"""Compares the lowest elastic frequency of public meshes with that of elements half as long, and judges the warnings.

  bench/public_meshes.py FOLDER [NAME...] [--programs build/release/bin] [--out out/bench/public-meshes]
                         [--most-triangles 6000] [--most-unknowns 150000]

FOLDER has .off, .obj, .stl, .ply or .geo files, such as Data/data/meshes of https://github.com/CGAL/cgal. All of them
with at most --most-triangles are taken, or only the files named NAME. Each is scaled to a largest extent
of 0.12 m and computed with default settings as a soft, floating body.

The reference is the same volume mesh with each tetrahedron cut into eight, so with half the edge, and quadratic
elements. A mesh passes if its lowest frequency is within 10 % of the reference, or if irdm-precompute warns with an
estimate that is within a factor of 2 of the error that the reference shows. Where half the edge is not enough for a
right frequency, the edges are halved on until it changes by less than 2 %: an estimate that is right by that frequency
only is marked. Meshes that irdm-precompute refuses, and those whose reference would have more than --most-unknowns, are
listed after the table.
"""
import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import time

import h5py
import numpy

EXTENT = 0.12            # [m], largest side of the box around a body
LARGEST_ERROR = 0.1      # of the lowest frequency, without a warning
LARGEST_FACTOR = 2.0     # between estimated and true error
CONVERGED = 0.02         # change of the lowest frequency with half the edge
EXTENSIONS = (".off", ".obj", ".stl", ".ply", ".geo")

CONFIG = """
[mesh]
file = "{file}"
[material]
youngs_modulus = 2000.0
poisson_ratio = 0.45
density = 110.0
"""
# The number of modes has no influence on the elements and on their warning, and one takes much less time than all.
ONE_MODE = "[modes]\ncount = 1\n"
# No body is as slow as this: the program stops after the modes with a message that says the lowest frequency. The
# other part of its work, the residual, would take most of the time and is not needed here.
NO_MODE = "[modes]\nhighest_frequency = {:.12f}\n"
TOO_LOW = 1e-6  # [Hz]
RIGID = '[mesh]\nfile = "{file}"\norder = 1\n[material]\nrigid = true\ndensity = 1.0\n'


class Refused(Exception):
    """A mesh that cannot be read or that irdm-precompute refuses; the text is its message."""


class TooLarge(Exception):
    """A mesh whose reference would have too many unknowns."""


def run(program, config, output):
    """The finished process; irdm-precompute works with one thread, so that times can be compared."""
    return subprocess.run([program, config, "-o", output, "--threads", "1"], capture_output=True, text=True,
                          env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})


def message(text):
    return text.strip().removeprefix("irdm-precompute: ")


def read_off(path):
    """Nodes and polygons; colours and normals are skipped."""
    lines = [line.split("#")[0].split() for line in path.read_text(errors="replace").splitlines()]
    lines = [line for line in lines if line]
    try:
        counts, rest = (lines[0][1:], lines[1:]) if len(lines[0]) > 1 else (lines[1], lines[2:])
        nodes, faces = int(counts[0]), int(counts[1])
        return (numpy.array([[float(word) for word in line[:3]] for line in rest[:nodes]]).reshape(nodes, 3),
                [[int(word) for word in line[1:1 + int(line[0])]] for line in rest[nodes:nodes + faces]])
    except (IndexError, ValueError) as fault:
        raise Refused(f"not a readable OFF file: {fault}") from None


def read_surface(path, program, folder):
    """Nodes and polygons. irdm-precompute itself reads all formats but OFF: a rigid model has the surface."""
    if path.suffix.lower() == ".off":
        return read_off(path)
    config, model = folder / "rigid.toml", folder / "rigid.h5"
    config.write_text(RIGID.format(file=path.resolve()))
    done = run(program, config, model)
    if done.returncode != 0:
        raise Refused(message(done.stderr))
    with h5py.File(model) as file:
        nodes, surface = file["mesh/nodes"][:], file["mesh/surface_nodes"][:]
        return nodes, surface[file["mesh/triangles"][:]].tolist()


def triangle_count(faces):
    return sum(len(face) - 2 for face in faces)


def write_scaled_obj(nodes, faces, path):
    used = nodes[numpy.unique([node for face in faces for node in face])]
    scale = EXTENT / numpy.ptp(used, axis=0).max()
    with path.open("w") as file:
        for x, y, z in scale * nodes:
            file.write(f"v {x:.17g} {y:.17g} {z:.17g}\n")
        for face in faces:
            file.write("f " + " ".join(str(node + 1) for node in face) + "\n")


def split(nodes, tets):
    """Tetrahedra that have half the edges of the given quadratic ones (E,10), whose nodes become the corners."""
    # The numbers are those of a tetrahedron's nodes: corners 0 to 3, middles of 01, 12, 02, 03, 13, 23 in the order
    # ab, bc, ac, ad, bd, cd. An octahedron remains between the children at the corners; it is cut along its shortest
    # diagonal into four, each of which has one edge of the ring around that diagonal.
    corners = numpy.array([[0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3]])
    octahedra = [((4, 9), (5, 6, 7, 8)), ((5, 7), (6, 4, 8, 9)), ((6, 8), (4, 5, 9, 7))]
    inner = numpy.array([[[a, b, ring[k], ring[(k + 1) % 4]] for k in range(4)] for (a, b), ring in octahedra])
    lengths = [numpy.linalg.norm(nodes[tets[:, a]] - nodes[tets[:, b]], axis=1) for (a, b), _ in octahedra]
    chosen = inner[numpy.argmin(lengths, axis=0)]
    rows = numpy.arange(len(tets))[:, None, None]
    return numpy.concatenate([tets[:, corners], tets[rows, chosen]], axis=1).reshape(-1, 4)


def quadratic(nodes, tets):
    """Nodes and tetrahedra (E,10) with a node in the middle of each edge."""
    ends = numpy.sort(tets[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]], axis=2).reshape(-1, 2)
    edges, number = numpy.unique(ends, axis=0, return_inverse=True)
    return (numpy.concatenate([nodes, nodes[edges].mean(axis=1)]),
            numpy.concatenate([tets, len(nodes) + number.reshape(-1, 6)], axis=1))


def write_medit(nodes, tets, path):
    with path.open("w") as file:
        file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(nodes)}\n")
        numpy.savetxt(file, nodes, fmt="%.17g %.17g %.17g 0")
        file.write(f"Tetrahedra\n{len(tets)}\n")
        numpy.savetxt(file, tets + 1, fmt="%d %d %d %d 0")
        file.write("End\n")


def estimate(warnings):
    """The ratio of stiffness that a warning of the elements names, and its words; nothing without a warning."""
    for line in warnings:
        found = re.search(r"the elements make it (about (\S+) (times|%) too (stiff|soft))", line)
        if found:
            number = float(found[2])
            if found[3] == "times":
                return (number if found[4] == "stiff" else 1.0 / number), found[1]
            return 1.0 + (number if found[4] == "stiff" else -number) / 100.0, found[1]
    return None, None


def within_factor(a, b):
    return a * b > 0.0 and max(a / b, b / a) <= LARGEST_FACTOR


def estimate_is_right(estimated, words, stiffness):
    """Per cent are compared with per cent, ratios with ratios."""
    if "%" in words:
        return within_factor(estimated - 1.0, stiffness - 1.0)
    return within_factor(estimated, stiffness)


def default_run(program, folder):
    """Nodes and quadratic tetrahedra of the body, its lowest frequency [Hz] and the program's words."""
    config, model = folder / "default.toml", folder / "default.h5"
    config.write_text(CONFIG.format(file="surface.obj") + ONE_MODE)
    done = run(program, config, model)
    if done.returncode != 0:
        raise Refused(message(done.stderr))
    compared = re.search(r"^elements: (.*)$", done.stdout, re.MULTILINE)
    with h5py.File(model) as file:
        frequency = float(file["response/modal/angular_frequency"][0]) / (2.0 * math.pi)
        return (file["mesh/nodes"][:], file["mesh/tets"][:], frequency,
                [message(line) for line in done.stderr.splitlines()], compared[1] if compared else "")


def reference_frequency(program, nodes, tets, folder):
    """[Hz], of quadratic tetrahedra that have these corners."""
    write_medit(nodes, tets, folder / "finer.mesh")
    config = folder / "finer.toml"
    config.write_text(CONFIG.format(file="finer.mesh") + NO_MODE.format(TOO_LOW))
    done = run(program, config, folder / "finer.h5")
    found = re.search(r"the lowest has (\S+) Hz", done.stderr)
    if not found:
        raise Refused("finer mesh: " + message(done.stderr))
    return float(found[1])


def finer_frequencies(program, nodes, tets, folder, most_unknowns, close):
    """The lowest frequencies with 1/2, 1/4, ... of the edge [Hz]: the first alone if `close` accepts it."""
    frequencies = []
    while True:
        corners = split(nodes, tets)
        finer_nodes, finer = quadratic(nodes, corners)
        if 3 * len(finer_nodes) > most_unknowns:
            if not frequencies:
                raise TooLarge(f"{len(tets)} tetrahedra; the finer mesh has {3 * len(finer_nodes)} unknowns")
            return frequencies
        frequencies.append(reference_frequency(program, nodes, corners, folder))
        if len(frequencies) == 1 and close(frequencies[0]):
            return frequencies
        if len(frequencies) > 1 and abs(frequencies[-2] / frequencies[-1] - 1.0) < CONVERGED:
            return frequencies
        nodes, tets = finer_nodes, finer


def measure(path, program, folder, most_triangles, most_unknowns):
    """One row of the table; None if the mesh has too many triangles. Throws Refused, TooLarge."""
    folder.mkdir(parents=True, exist_ok=True)
    nodes, faces = read_surface(path, program, folder)
    if not faces:
        raise Refused("has no faces")
    if triangle_count(faces) > most_triangles:
        return None
    write_scaled_obj(nodes, faces, folder / "surface.obj")
    nodes, tets, frequency, warnings, compared = default_run(program, folder)
    estimated, words = estimate(warnings)

    def close(finer):
        return abs(frequency / finer - 1.0) <= LARGEST_ERROR

    finer = finer_frequencies(program, nodes, tets, folder, most_unknowns,
                              lambda first: close(first) and estimated is None)

    def passes(reference):
        return estimated is not None and estimate_is_right(estimated, words, (frequency / reference) ** 2)

    verdict = "ok" if close(finer[0]) or passes(finer[0]) else "by the finest" if passes(finer[-1]) else "NOT OK"
    return {"name": path.name, "tetrahedra": len(tets), "nodes": len(nodes), "frequency": frequency, "finer": finer,
            "close": close(finer[0]), "warnings": warnings, "compared": compared, "estimate": estimated,
            "says": words or ("not compared" if compared.startswith("not compared") else "no warning"),
            "verdict": verdict}


def table_line(row):
    ratio = row["frequency"] / row["finer"][0]
    finest = f"{(row['frequency'] / row['finer'][-1]) ** 2:.3f} (1/{2 ** len(row['finer'])})"
    return (f"| {row['name']} | {row['tetrahedra']} | {row['nodes']} | {row['frequency']:.4g} | "
            f"{row['finer'][0]:.4g} | {ratio:.3f} | {ratio ** 2:.3f} | {finest if len(row['finer']) > 1 else ''} | "
            f"{row['says']} | {row['verdict']} |")


def summary(rows):
    passed = sum(row["verdict"] == "ok" for row in rows)
    return (f"{passed} of {len(rows)} meshes pass: {sum(row['close'] for row in rows)} are within "
            f"{100 * LARGEST_ERROR:.0f} % of finer elements; "
            f"{sum(row['estimate'] is not None for row in rows)} have a warning of their elements")


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--programs", type=pathlib.Path, default="build/release/bin")
    parser.add_argument("--out", type=pathlib.Path, default="out/bench/public-meshes")
    parser.add_argument("--most-triangles", type=int, default=6000)
    parser.add_argument("--most-unknowns", type=int, default=150_000)
    return parser.parse_args()


def main():
    given = options()
    files = sorted((p for p in given.folder.iterdir() if p.suffix.lower() in EXTENSIONS), key=lambda p: p.name.lower())
    if given.names:
        files = [p for p in files if p.name in given.names]
    program = (given.programs / "irdm-precompute").resolve()
    rows, left_out = [], []
    begin = time.monotonic()
    print("| mesh | tetrahedra | nodes | lowest frequency [Hz] | half the edge [Hz] | ratio | stiffness ratio | "
          "stiffness ratio, finest | irdm-precompute says | verdict |\n" + "| --- " * 10 + "|")
    for path in files:
        try:
            row = measure(path, program, given.out / path.name, given.most_triangles, given.most_unknowns)
        except (Refused, TooLarge) as fault:
            left_out.append((path.name, str(fault)))
            continue
        if row:
            rows.append(row)
            print(table_line(row), flush=True)
    print("\n" + summary(rows) + f"; {time.monotonic() - begin:.0f} s")
    if left_out:
        print("\nLeft out:\n" + "\n".join(f"- {name}: {why}" for name, why in left_out))
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "public_meshes.json").write_text(json.dumps({"rows": rows, "left out": left_out}, indent=1) + "\n")
    sys.exit(0 if all(row["verdict"] == "ok" for row in rows) else 1)


if __name__ == "__main__":
    main()
