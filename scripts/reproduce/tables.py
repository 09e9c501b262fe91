"""Tables of the page in Markdown."""

import re

import numpy as np

from results import figure_of, read_comparison

PAPER = ["paper", "866", "1728", "1360", "5309", "1462 s", "9.9 MB"]
VARIANTS = (("quadratic", "quadratic elements"), ("inertial", "with inertial loading"), ("1khz", "dt = 1 ms (1 kHz)"),
            ("own-1", ""), ("own-2", ""), ("fem", "finite elements, led along the same path"), ("hold-2", "2 ms one way, `hold`"),
            ("hold-10", "10 ms one way, `hold`"), ("predict-2", "2 ms one way, `predict`"),
            ("predict-10", "10 ms one way, `predict`"))
MEASURES = ("force", "compliance", "vibration", "onset")


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def number(value, digits=2):
    """`value` with so many digits that count; 0 where there is nothing but rounding."""
    if value is None:
        return "not judged"
    if abs(value) < 1e-9:
        return "0"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text and abs(value) >= 1 else text


def percent(share, digits=2):
    return "not judged" if share is None else number(100 * share, digits) + " %"


def sizes(work, model):
    logs = {"modes": work / "models/cube.log", "stepped": work / "models/stepped.log"}
    numbers = [figure_of(logs["modes"], label) for label in
               ("free nodes (n)", "triangle patches", "entire nodes", "tetrahedral elements")]

    def of(log):
        return [figure_of(logs[log], f"{what} per d.o.f.") for what in ("pre-computation time", "data size")]

    def seconds(text):
        return number(float(text.split()[0]), 2) + " s"

    modes, stepped = of("modes"), of("stepped")
    columns = figure_of(logs["stepped"], "columns computed in this run")
    rows = [PAPER, ["irdm, all modes", *numbers, seconds(modes[0]), modes[1]],
            [f"irdm, by the paper's method (time stepping, corotational; {columns} columns)", *numbers,
             seconds(stepped[0]), stepped[1]]]
    head = ["", "free nodes (n)", "triangle patches", "entire nodes", "tetrahedral elements",
            "pre-computation time per d.o.f.", "data size per d.o.f."]
    return table(head, rows)


def waves(model, speeds, theory, check):
    line = re.search(r"main wave ([\d.]+), first peak ([\d.]+), first arrival ([\d.]+) m/s", check.read_text())
    rows = [["the paper, \"surface elastic wave\"", "6 - 8"]]
    rows += [[f"first peak, sampled every {1000 * dt:g} ms", f"{speed:.1f}"] for dt, speed in speeds.items()]
    if line:
        rows += [[f"{what}, by `irdm-precompute check`, finely sampled, tapped on the face that is nearest",
                  f"{float(line[i]):.1f}"] for i, what in ((2, "first peak"), (1, "main wave"), (3, "first arrival"))]
    rows += [[f"theory: {name}", f"{speed:.2f}"] for name, speed in
             zip(("Rayleigh wave", "shear wave", "dilatational wave"), theory)]
    return table(["", "speed, m/s"], rows)


def references(work):
    rows = []
    for name, words in (("swing", "swing"), ("tap", "tap, soft"), ("tap-stiff", "tap, stiff")):
        comparison = read_comparison(work / name / "fem.json")
        thing = comparison["objects"][0]
        u = thing["displacement"]
        rows.append([words, number(1000 * u["reference"]) + " mm", percent(u["rms"] / u["reference"]),
                     percent(u["max"] / u["reference"]), number(1000 * thing["centre_of_mass"]["max"]) + " mm",
                     number(np.degrees(thing["orientation"]["max"])) + "°",
                     number(np.degrees(thing["orientation"]["last"])) + "°"])
    return table(["run", "peak displacement", "apart, rms", "apart, largest", "centre of mass, largest",
                  "orientation, largest", "orientation, at the end"], rows)


def ringing(work):
    rows = []
    for name, words in (("tap", "soft"), ("tap-stiff", "stiff")):
        found = read_comparison(work / name / "fem.json")["objects"][0]["node"]["ringing"]
        first = [max((one for one in found[run] if one["damping_ratio"] < 0.1), key=lambda one: one["amplitude"],
                     default=None) for run in ("a", "b")]
        rows.append([words] + [f"{one['frequency']:.1f} Hz, {100 * one['damping_ratio']:.1f} %" if one else "none found"
                               for one in first])
    return table(["cube", "irdm: loudest oscillation, its damping", "finite elements"], rows)


def verdict(perception, force):
    if force["max"] > 3 * force["reference"]:
        return "**unstable**"
    noticed = [measure for measure in MEASURES if perception[measure]["noticeable"]]
    unjudged = [measure for measure in MEASURES if perception[measure]["noticeable"] is None]
    words = "**noticeable: " + ", ".join(noticed) + "**" if noticed else "not noticeable"
    return words + ("; not judged: " + ", ".join(unjudged) if unjudged else "")


def compression_words(work, name):
    log = (work / "models" / f"compress-{name[-1]}.log").read_text()
    found = re.search(r"([\d.]+) times smaller;.*: ([\d.]+) % of displacement", log)
    return f"compressed {float(found[1]):.0f} times, displacement off by {found[2]} % at most"


def variants(work):
    rows = []
    for name, words in VARIANTS:
        words = words or compression_words(work, name)
        for motion in ("swing", "tap"):
            if (motion, name) == ("tap", "fem"):
                continue  # where a tip only touches the forces are the recorded ones
            comparison = read_comparison(work / f"{motion}-{name}" / "compare.json")
            perception = comparison["styluses"][0]["perception"]
            thing, force = comparison["objects"][0], comparison["styluses"][0]["force"]
            u = thing.get("displacement")
            rows.append([words, motion, percent(force["max"] / force["reference"]),
                         percent(perception["force"]["largest"]), percent(perception["compliance"]["share"]),
                         number(perception["vibration"]["level"]),
                         number(1000 * (perception["onset"]["largest"] or 0)) + " ms",
                         percent(u["max"] / u["reference"]) if u else "other mesh",
                         number(np.degrees(thing["orientation"]["max"])) + "°", verdict(perception, force)])
    return table(["variant", "motion", "force, largest, of the peak", "force, as felt (limit 10 %)",
                  "compliance (limit 15 %)", "vibration (limit 1)", "onset (limit 5.5 ms)", "node displacement, largest",
                  "orientation, largest", "a hand"], rows)
