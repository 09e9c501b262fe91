"""Runs scripts/reproduce.sh --small into a temporary folder, and looks at what it made.

usage: check_small.py SOURCES PROGRAMS [WORK, of a run that was made before]
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np
from PIL import Image

FIGURES = ("figure-3", "figure-4", "figure-5", "wave-speed", "figure-7a", "figure-7b", "figure-7c", "orientation",
           "figure-8")
failures = []


def check(holds, words):
    print("ok  " if holds else "FAIL", words)
    if not holds:
        failures.append(words)


def check_figures(folder):
    for name in FIGURES:
        picture = np.asarray(Image.open(folder / f"{name}.png").convert("RGB")).astype(int)
        colours = len(np.unique(picture.reshape(-1, 3), axis=0))
        drawn = np.mean(np.abs(picture - picture[0, 0]).max(axis=2) > 24)
        check(colours > 20 and 0.005 < drawn < 0.9, f"{name}: {colours} colours, {100 * drawn:.1f} % drawn")


def check_page(page):
    check("$" not in page and not re.search(r"\b(nan|inf|None)\b", page), "the page has all its numbers")
    check("| irdm, all modes | 218 | 432 | 270 | 885 |" in page, "6 cells: 6 n^2 + 2 nodes, 12 n^2 triangles")
    theory = re.search(r"theory: Rayleigh wave \| ([\d.]+)", page)
    check(abs(float(theory[1]) - 2.357) < 0.01, "Rayleigh's speed is sqrt(mu / rho) times 0.954")
    rayleigh, dilatational = 2.36, 17.6
    for speed in re.findall(r"first peak, sampled every .*? \| ([\d.]+)", page):
        check(rayleigh / 2 < float(speed) < 1.2 * dilatational, f"first peak {speed} m/s, between the waves of theory")
    for picture in re.findall(r"\]\((images/[^)]*)\)", page):
        check(pathlib.Path(picture).stem in FIGURES, f"{picture} is made")


def momentum_share(work, name, run):
    """Momentum of the body at the end over the impulse of the forces."""
    model = "cube-stiff" if name == "tap-stiff" else "cube"
    with h5py.File(work / f"models/{model}.h5") as file:
        mass = file["/body"].attrs["mass"]
    with h5py.File(work / name / f"{run}.h5") as file:
        time, place, force = file["/time"][:], file["/object/0/position"][:], file["/stylus/0/force"][:]
    impulse = -(time[1] - time[0]) * force.sum(axis=0)
    return mass * (place[-1] - place[-101])[1] / (time[-1] - time[-101]) / impulse[1]


def comparison(work, path):
    return json.loads((work / path).read_text())


def check_runs(work):
    for name in ("tap", "tap-stiff"):
        for run in ("run", "fem"):
            share = momentum_share(work, name, run)
            check(abs(share - 1) < 1e-6, f"{name}, {run}: drifts with {share:.9f} of the impulse")
    with h5py.File(work / "tap/run.h5") as soft, h5py.File(work / "tap-stiff/run.h5") as stiff:
        forces = [np.linalg.norm(file["/stylus/0/force"][:], axis=1) for file in (soft, stiff)]
    check(forces[1].max() > 1.5 * forces[0].max(), "the stiff cube gives the larger blow")
    check(np.count_nonzero(forces[1]) < 0.7 * np.count_nonzero(forces[0]), "and the shorter one")
    for name in ("swing", "tap", "tap-stiff"):
        u = comparison(work, f"{name}/fem.json")["objects"][0]["displacement"]
        check(0 < u["rms"] < 0.02 * u["reference"], f"{name}: finite elements within 2 % rms")
    for motion in ("swing", "tap"):
        apart = {name: comparison(work, f"{motion}-{name}/compare.json")["styluses"][0]["force"]["rms"]
                 for name in ("hold-2", "hold-10", "predict-2", "predict-10")}
        check(0 < apart["hold-2"] < apart["hold-10"], f"{motion}: the longer delay changes more")
        check(apart["predict-10"] < 0.2 * apart["hold-10"], f"{motion}: less where the bridge solves the contact")
        perception = comparison(work, f"{motion}-quadratic/compare.json")["styluses"][0]["perception"]
        check(perception["compliance"]["b"] > 1.15 * perception["compliance"]["a"], f"{motion}: linear elements lock")
        coarse, fine = (comparison(work, f"{motion}-own-{i}/compare.json")["objects"][0]["displacement"] for i in (1, 2))
        check(fine["rms"] < coarse["rms"] < 0.05 * coarse["reference"], f"{motion}: compressed R, the finer the nearer")


def main():
    sources, programs = pathlib.Path(sys.argv[1]), sys.argv[2]
    with tempfile.TemporaryDirectory(prefix="irdm-reproduce-") as folder:
        work = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else folder)
        if len(sys.argv) < 4:
            subprocess.run([sources / "scripts/reproduce.sh", "--small", "--work", work], check=True,
                           env=os.environ | {"IRDM_PROGRAMS": programs})
        check_figures(work / "docs/images/reproduction")
        check_page((work / "docs/reproduction.md").read_text())
        check_runs(work)
    sys.exit(f"{len(failures)} checks failed" if failures else 0)


main()
