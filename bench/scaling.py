#!/usr/bin/python3
"""Plots how time and memory grow with the object, and prints the exponents of the power laws.

bench/scaling.py FOLDER PROGRAMS [OUT]

FOLDER    where bench/run.sh has put force_step.json and deformation.json
PROGRAMS  folder of irdm-precompute, which is run on cubes of growing size
OUT       where scaling.png and scaling.json go (default: FOLDER)
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CONFIG = """
[mesh]
box = {{ size = [0.12, 0.12, 0.12], cells = [{cells}, {cells}, {cells}] }}
order = 1
[material]
youngs_modulus = 2000.0
poisson_ratio = 0.49
density = 110.0
"""
SMALLEST_FOR_EXPONENT = 300  # surface nodes; below that fixed costs count


def tables(folder, name):
    file = folder / (name + ".json")
    return json.loads(file.read_text())["tables"] if file.exists() else {}


def series(table, label, value):
    """{label: [(surface nodes, value)]}"""
    lines = {}
    for row in table:
        lines.setdefault(row[label], []).append((row["surface nodes"], row[value]))
    return lines


def precompute_times(program):
    """Of the modal method with all modes [s]."""
    points = []
    for cells in (4, 6, 8, 10, 12):
        with tempfile.TemporaryDirectory() as folder:
            config = pathlib.Path(folder) / "cube.toml"
            config.write_text(CONFIG.format(cells=cells))
            begin = time.monotonic()
            subprocess.run([program, config, "-o", pathlib.Path(folder) / "cube.h5"], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            points.append((6 * cells * cells + 2, time.monotonic() - begin))
    return {"modal, all modes": points}


def exponent(points):
    """Of value ~ nodes^p: the line of least squares through the logarithms."""
    logs = [(math.log(n), math.log(v)) for n, v in points if n >= SMALLEST_FOR_EXPONENT and v > 0]
    if len(logs) < 2:
        return math.nan
    mean_x = sum(x for x, _ in logs) / len(logs)
    mean_y = sum(y for _, y in logs) / len(logs)
    return (sum((x - mean_x) * (y - mean_y) for x, y in logs) /
            sum((x - mean_x) ** 2 for x, _ in logs))


def plot(axes, title, unit, lines):
    exponents = {}
    for label, points in lines.items():
        p = exponents[label] = exponent(points)
        print(f"| {title} | {label} | {p:.2f} |")
        axes.loglog(*zip(*points), "o-", label=f"{label}: n^{p:.2f}")
    axes.set_title(title)
    axes.set_xlabel("surface nodes")
    axes.set_ylabel(unit)
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=7)
    return exponents


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder, programs = map(pathlib.Path, sys.argv[1:3])
    out = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else folder
    steps = next(iter(tables(folder, "force_step").values()), [])
    surfaces = [row for row in next(iter(tables(folder, "deformation").values()), [])
                if row["threads"] == 1]
    figure, axes = plt.subplots(2, 2, figsize=(11, 8))
    print("| what | of | exponent |\n| --- | --- | --- |")
    exponents = {
        "force step": plot(axes[0][0], "force step", "us", series(steps, "engine", "median [us]")),
        "deformed surface": plot(axes[0][1], "deformed surface, 1 thread", "ms",
                                 series(surfaces, "engine", "time [ms]")),
        "memory": plot(axes[1][0], "memory of the response", "GB",
                       series(steps, "engine", "response [GB]")),
        "precomputation": plot(axes[1][1], "precomputation", "s",
                               precompute_times(programs / "irdm-precompute")),
    }
    figure.tight_layout()
    figure.savefig(out / "scaling.png", dpi=110)
    (out / "scaling.json").write_text(json.dumps(exponents, indent=1) + "\n")


if __name__ == "__main__":
    main()
