"""Finds a stiff inclusion in soft tissue by touch: presses a grid of places, maps the force, and draws it.

    python3 palpation.py [MODEL.h5] [FIGURE.png]

The model is computed from configs/models/tissue-inclusion.toml if it is not there.
"""

import pathlib
import sys

import numpy
from matplotlib import pyplot

import irdm

INCLUSION, RADIUS = numpy.array([0.015, 0.010]), 0.010  # of the configuration, in the plane of the top [m]
DEPTH, PRESS = 0.004, 100  # how deep to press [m], in so many steps

model_file = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "tissue-inclusion.h5")
figure_file = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "palpation.png")
if model_file.exists():
    model = irdm.Model.open(model_file)
else:
    configs = pathlib.Path(__file__).resolve().parents[2] / "configs" / "models"
    model = irdm.precompute(configs / "tissue-inclusion.toml", model_file, progress=print)

top = model.nodes[:, 2].max()  # the centre of mass is the origin [m]
stylus = {"radius": 0.012, "coupling_stiffness": 2000}
simulation = irdm.Simulation({"object": [{"model": model}], "stylus": [stylus]})


def press(x, y):
    """Force of the tissue on the fingertip, upward, over depth: (PRESS, 2) [m, N]."""
    simulation.reset()
    depth = numpy.linspace(-0.001, DEPTH, PRESS)
    tips = numpy.stack([numpy.full(PRESS, x), numpy.full(PRESS, y), top - depth], axis=1)
    steps = simulation.step_many(tips[:, None, :])
    return numpy.stack([depth, steps.styluses["force"][:, 0, 2]], axis=1)


places = numpy.linspace(-0.03, 0.03, 13)
force = numpy.array([[press(x, y)[-1, 1] for x in places] for y in places])
row, column = numpy.unravel_index(force.argmax(), force.shape)
found = numpy.array([places[column], places[row]])
curves = {"above the inclusion": press(*found), "far from it": press(-found[0], -found[1])}
print(f"stiffest place: x {1e3 * found[0]:.0f} mm, y {1e3 * found[1]:.0f} mm, {force.max():.2f} N at {1e3 * DEPTH:.0f} mm")
print(f"inclusion:      x {1e3 * INCLUSION[0]:.0f} mm, y {1e3 * INCLUSION[1]:.0f} mm; elsewhere {numpy.median(force):.2f} N")

figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
figure.colorbar(left.pcolormesh(1e3 * places, 1e3 * places, force), ax=left, label=f"force at {1e3 * DEPTH:.0f} mm [N]")
left.add_patch(pyplot.Circle(1e3 * INCLUSION, 1e3 * RADIUS, fill=False, color="white", label="inclusion"))
left.plot(*(1e3 * found), "x", color="red", label="stiffest place")
left.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal", title="Palpation map")
left.legend(loc="lower left")
for name, curve in curves.items():
    right.plot(1e3 * curve[:, 0], curve[:, 1], label=name)
right.set(xlabel="depth [mm]", ylabel="force on the fingertip [N]", title="Two presses")
right.legend()
figure.savefig(figure_file, dpi=110)
sys.exit(0 if numpy.linalg.norm(found - INCLUSION) < RADIUS else 1)
