#!/usr/bin/python3
"""Draws what `irdm-replay compare A.h5 B.h5 --json COMPARISON.json` found: forces, displacements, how
far B is from A over time, spectra, and what a hand would notice with its limits.

usage: plot_comparison.py COMPARISON.json PICTURE.png|.svg|.pdf
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

STYLES = {  # B is dashed, so that it does not hide A
    "A": {"color": "tab:blue"},
    "B": {"color": "tab:orange", "linestyle": "--"},
    "difference": {"color": "black"},
    "limit": {"color": "tab:red", "linestyle": ":"},
}
COLUMNS = 3
DECADES = 1e6  # that a logarithmic axis shows at most
LOWEST_HEARD = 20.0  # Hz, an octave below the lowest frequency that vibrations are judged at


class Chart:
    def __init__(self, title, x_label, y_label, logarithmic=False):
        self.title, self.x_label, self.y_label, self.logarithmic = title, x_label, y_label, logarithmic
        self.curves = []

    def add(self, name, style, x, y, factor=1.0):
        x, y = np.array(x, dtype=float), factor * np.array(y, dtype=float)  # null is NaN
        if x.ndim != 1 or x.shape != y.shape:
            raise ValueError(f"a curve of '{self.title}' has {x.size} places and {y.size} values")
        if self.logarithmic:
            y[~(y > 0)] = np.nan
            x, y = x[x > 0], y[x > 0]
        self.curves.append((name, style, x, y))
        return self

    def draw(self, axes):
        for name, style, x, y in self.curves:
            axes.plot(x, y, linewidth=1, label=name, **STYLES[style])
        axes.margins(x=0)
        if self.logarithmic:
            axes.set(xscale="log", yscale="log")
            highest = max((np.nanmax(y) for _, _, _, y in self.curves if np.isfinite(y).any()), default=1.0)
            axes.set_ylim(bottom=max(axes.get_ylim()[0], highest / DECADES))
        elif axes.get_ylim()[0] > 0:
            axes.set_ylim(bottom=0)
        axes.set(title=self.title, xlabel=self.x_label, ylabel=self.y_label)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)


def size_chart(title, pair, time, y_label, factor=1.0):
    return Chart(title, "time (s)", y_label).add("A", "A", time, pair["a"], factor).add("B", "B", time, pair["b"], factor)


def drift_chart(title, apart, time, y_label, factor=1.0):
    return Chart(title, "time (s)", y_label).add("B from A", "difference", time, apart["max_over_time"], factor)


def spectrum_charts(title, spectrum, unit, factor=1.0):
    """None where the frames are not evenly spaced."""
    if not spectrum["frequency"]:
        return []
    chart = Chart(title, "frequency (Hz)", f"amplitude ({unit})", logarithmic=True)
    for run, style in (("a", "A"), ("b", "B")):
        chart.add(style, style, spectrum["frequency"], spectrum[run], factor)
    return [chart]


def vibration_charts(name, vibration):
    if vibration["noticeable"] is None:
        return []
    chart = Chart(f"{name}: vibration of the hand", "frequency (Hz)", "motion of the hand (µm)", logarithmic=True)
    heard = np.array(vibration["frequency"], dtype=float) >= LOWEST_HEARD
    for key, label, style in (("a", "A", "A"), ("b", "B", "B"), ("difference", "B less A", "difference"),
                              ("threshold", "felt from here on", "limit")):
        chart.add(label, style, np.array(vibration["frequency"], dtype=float)[heard],
                  np.array(vibration[key], dtype=float)[heard], 1e6)
    return [chart]


def stylus_charts(name, stylus, time):
    share = stylus["perception"]["force"]
    noticed = Chart(f"{name}: force, as a hand would notice", "time (s)", "difference (% of A)")
    noticed.add("force of B less A", "difference", time, share["share_over_time"], 100)
    noticed.add("noticed from here on", "limit", [time[0], time[-1]], 2 * [share["limit"]], 100)
    return [size_chart(f"{name}: force", stylus["size_over_time"], time, "force (N)"),
            drift_chart(f"{name}: force, B from A", stylus["force"], time, "apart (N)"),
            noticed,
            *spectrum_charts(f"{name}: spectrum of the force", stylus["spectrum"], "N"),
            *vibration_charts(name, stylus["perception"]["vibration"])]


def node_charts(name, item, time):
    """None where the meshes differ."""
    if item["node"] is None:
        return []
    node, apart = item["node"], item["displacement"]
    differences = Chart(f"{name}: nodes, B from A", "time (s)", "apart (mm)")
    differences.add("root mean square", "difference", time, apart["rms_over_time"], 1e3)
    differences.add("largest", "limit", time, apart["max_over_time"], 1e3)
    title = f"{name}: node {node['number']}, displaced most"
    return [differences, size_chart(title, node["size_over_time"], time, "displacement (mm)", 1e3),
            *spectrum_charts(f"{name}: spectrum of node {node['number']}", node["spectrum"], "mm", 1e3)]


def object_charts(item, time):
    name = item["name"].replace("$", r"\$")  # no formula
    return [*node_charts(name, item, time),
            drift_chart(f"{name}: centre of mass, B from A", item["centre_of_mass"], time, "apart (mm)", 1e3),
            drift_chart(f"{name}: orientation, B from A", item["orientation"], time, "angle (degrees)", np.degrees(1))]


def read_charts(path):
    """The title, and the charts of each stylus and each object."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        sys.exit(f"{path}: cannot be read: {error.strerror}")
    except ValueError:
        found = None
    if not isinstance(found, dict) or found.get("format") != "irdm-comparison" or found.get("version") != 1:
        sys.exit(f"{path}: is not a comparison; make one with irdm-replay compare A.h5 B.h5 --json FILE")
    try:
        time = found["time"]
        groups = [stylus_charts(f"stylus {s}", stylus, time) for s, stylus in enumerate(found["styluses"])]
        groups += [object_charts(item, time) for item in found["objects"]]
        if not groups:
            raise ValueError("no objects and no styluses")
        return f"A: {found['a']}\nB: {found['b']}".replace("$", r"\$"), groups
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        sys.exit(f"{path}: is damaged ({type(error).__name__}: {error}); make it again with irdm-replay compare")


def draw(title, groups, picture):
    rows = [group[i : i + COLUMNS] for group in groups for i in range(0, len(group), COLUMNS)]
    figure, all_axes = plt.subplots(len(rows), COLUMNS, figsize=(5 * COLUMNS, 3.4 * len(rows) + 0.6), dpi=100,
                                    squeeze=False, layout="constrained")
    figure.suptitle(title, fontsize=10)
    for row, row_axes in zip(rows, all_axes):
        for axes in row_axes[len(row) :]:
            axes.remove()
        for chart, axes in zip(row, row_axes):
            chart.draw(axes)
    try:
        figure.savefig(picture)
    except OSError as error:
        sys.exit(f"{picture}: cannot be written: {error.strerror}")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    picture = Path(sys.argv[2])
    if picture.suffix not in (".png", ".svg", ".pdf"):
        sys.exit(f"{picture}: is no picture; give a name that ends in .png, .svg or .pdf")
    title, groups = read_charts(Path(sys.argv[1]))
    draw(title, groups, picture)


if __name__ == "__main__":
    main()
