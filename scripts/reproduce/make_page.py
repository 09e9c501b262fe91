"""Writes reproduction.md and its figures from what scripts/reproduce.sh has left in its work folder.

usage: make_page.py WORK DOCS
"""

import os
import pathlib
import string
import sys

import numpy as np

import draw
import figures
import impulse
import tables
from results import Model, Run, figure_of, read_comparison


def machine():
    names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    return f"{os.cpu_count()} cores of {names[0] if names else 'an unknown processor'}"


def draw_interactions(work, pictures, triangles):
    """Figures 7 and 8."""
    camera = draw.Camera(29, 20)
    swing = {name: Run(work / "swing" / f"{name}.h5") for name in ("run", "fem")}
    soft = {name: Run(work / "tap" / f"{name}.h5") for name in ("run", "fem")}
    stiff = {name: Run(work / "tap-stiff" / f"{name}.h5") for name in ("run", "fem")}
    figures.sequence(pictures, "figure-7a", [("irdm", swing["run"], triangles), ("finite elements", swing["fem"], triangles)],
                     (2.50, 2.61, 2.72, 2.83, 2.94, 3.06), camera, 3)
    times = (0.44, 0.46, 0.48, 0.52, 0.70, 1.00)
    for name, run in (("figure-7b", "run"), ("figure-7c", "fem")):
        rows = [(words, cube[run], triangles) for words, cube in (("soft", soft), ("stiff", stiff))]
        like = [(words, cube["run"], triangles) for words, cube in (("soft", soft), ("stiff", stiff))]
        figures.sequence(pictures, name, rows, times, camera, 3, like)
    curves = []
    for name, words, style in (("swing", "swing", "tab:blue"),
                               ("tap", "tap, soft", "tab:orange"),
                               ("tap-stiff", "tap, stiff", "tab:green")):
        comparison = read_comparison(work / name / "fem.json")
        apart = comparison["objects"][0]["orientation"]["max_over_time"]
        curves.append((words, comparison["time"], np.degrees(apart), style))
    figures.over_time(pictures, "orientation", curves, "orientation apart (degrees)")
    figures.pack(work / "swing/force-0.png", pictures / "figure-8.png")
    return swing["run"], {"soft": soft["run"], "stiff": stiff["run"]}


def peak(run):
    return f"{np.linalg.norm(run.force, axis=1).max():.2f}"


def contact_time(run):
    return f"{1000 * np.diff(run.time).mean() * np.count_nonzero(np.linalg.norm(run.force, axis=1)):.0f}"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    work, docs = map(pathlib.Path, sys.argv[1:])
    pictures = docs / "images/reproduction"
    model, stiff = Model(work / "models/cube.h5"), Model(work / "models/cube-stiff.h5")
    factor = figures.impulse_figures(pictures, model)
    speeds = figures.wave_figure(pictures, model)
    swing, taps = draw_interactions(work, pictures, model.triangles)
    cells = round((len(model.rest) - 2) ** 0.5 / 6**0.5)
    own = Model(work / "models/own.h5")
    values = {
        "machine": machine(), "cells": cells, "own_cells": round((len(own.rest) - 2) ** 0.5 / 6**0.5),
        "sizes": tables.sizes(work, model), "total_time": figure_of(work / "models/cube.log", "pre-computation time"),
        "dense_size": f"{4e-6 * len(model.rest) * 3 * model.steps:.1f}",
        "mass": f"{model.mass:.3f}", "factor": f"{factor:.1f}",
        "waves": tables.waves(model, speeds, impulse.theoretical_speeds(model.material), work / "models/check.log"),
        "swing_peak": peak(swing), "soft_peak": peak(taps["soft"]), "stiff_peak": peak(taps["stiff"]),
        "soft_contact": contact_time(taps["soft"]), "stiff_contact": contact_time(taps["stiff"]),
        "lowest": f"{model.lowest_frequency:.1f}", "stiff_lowest": f"{stiff.lowest_frequency:.1f}",
        "references": tables.references(work), "ringing": tables.ringing(work), "variants": tables.variants(work),
    }
    page = string.Template(pathlib.Path(__file__).with_name("page.md").read_text())
    (docs / "reproduction.md").write_text(page.substitute(values))


main()
