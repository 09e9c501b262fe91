#!/usr/bin/python3
"""Draws the error of the force over the step from the output of bench_time_order.

usage: bench_time_order | plot_time_order.py PICTURE.png
"""

import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    curves = {}
    for row in csv.DictReader(sys.stdin):
        curve = curves.setdefault(row["motion"], {}).setdefault(float(row["youngs_modulus"]), [])
        curve.append((1e3 * float(row["dt"]), 100 * float(row["error"]),
                      100 * float(row["fem_error"])))
    if not curves:
        sys.exit("no rows: give it what bench_time_order prints")

    figure, all_axes = plt.subplots(1, len(curves), figsize=(3.6 * len(curves), 4), dpi=110,
                                    sharey=True, squeeze=False)
    for axes, (motion, by_stiffness) in zip(all_axes[0], curves.items()):
        for stiffness, points in sorted(by_stiffness.items()):
            points.sort()
            steps = [p[0] for p in points]
            line, = axes.loglog(steps, [p[1] or None for p in points], linewidth=1,
                                label=f"{stiffness / 1e3:g} kPa")
            axes.loglog(steps, [p[2] for p in points], linestyle="none", marker="o", markersize=3,
                        color=line.get_color())
        axes.loglog([0.2, 4], [0.01, 4], color="grey", linestyle=":", label="second order")
        axes.loglog([], [], color="grey", marker="o", markersize=3, linestyle="none",
                    label="against finite elements")
        axes.set_title(motion)
        axes.set_xlabel("step (ms)")
        axes.grid(alpha=0.3, which="both")
    all_axes[0][0].set_ylabel("largest error of the force (% of the peak)")
    handles, labels = all_axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=len(handles), fontsize=8)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(sys.argv[1])


if __name__ == "__main__":
    main()
