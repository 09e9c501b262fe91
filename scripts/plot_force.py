#!/usr/bin/python3
"""Draws the force on a stylus over time from a trace file, like the paper's Figure 8: as it acted in
the end, with what a bridge told late (a trace of before `applied_force`: as it was known in the step).

usage: plot_force.py TRACE.h5 PICTURE.png [STYLUS]
"""

import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__.strip())
    stylus = sys.argv[3] if len(sys.argv) == 4 else "0"
    with h5py.File(sys.argv[1]) as trace:
        time = trace["/step/time"][:]
        sets = trace[f"/stylus/{stylus}"]
        force = sets["applied_force" if "applied_force" in sets else "force"][:]
        contact = trace[f"/stylus/{stylus}/contact"][:]
    if len(time) == 0:
        sys.exit(f"{sys.argv[1]}: the trace has no steps; nothing was recorded")

    figure, axes = plt.subplots(figsize=(10, 4.5), dpi=120)
    for axis, colour in zip(range(3), ("tab:red", "tab:green", "tab:blue")):
        axes.plot(time, force[:, axis], color=colour, linewidth=0.9, label=f"F{'xyz'[axis]}")
    axes.plot(time, np.linalg.norm(force, axis=1), color="black", linewidth=1.1, label="|F|")
    bottom, top = axes.get_ylim()
    limits = bottom, top + 0.12 * (top - bottom)  # room for the legend
    for state, colour, label in ((1, "tab:orange", "touching"), (2, "tab:purple", "held")):
        axes.fill_between(time, *limits, where=contact == state, step="mid", color=colour,
                          alpha=0.12, linewidth=0, label=label)
    axes.set_ylim(limits)
    axes.set_xlim(time[0], time[-1])
    axes.set_xlabel("time (s)")
    axes.set_ylabel("force on the stylus (N)")
    axes.grid(alpha=0.3)
    axes.legend(ncol=6, loc="upper left", fontsize=8)
    figure.tight_layout()
    figure.savefig(sys.argv[2])


main()
