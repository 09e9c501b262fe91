#!/usr/bin/python3
"""Writes the stylus scripts of the gallery (docs/configuration.md) into configs/scripts.

usage: make_stylus_scripts.py [FOLDER]

A motion is a list of (time, x, y, z, button): from one to the next the tip moves smoothly, starting and ending at
rest; the buttons are those of the row before. Times in s, lengths in m. Buttons: 1 grab, 2 clutch, 4 reset.
"""

import math
import os
import sys

STEP = 0.02  # s, between rows of a curve


def smooth(motion):
    """Rows of a motion: each way is walked with speed 0 at both ends."""
    rows = []
    for (t0, *start, button), (t1, *end, _) in zip(motion, motion[1:]):
        steps = 1 if start == end else max(1, round((t1 - t0) / STEP))
        for i in range(steps):
            share = 0.5 - 0.5 * math.cos(math.pi * i / steps)
            place = [a + share * (b - a) for a, b in zip(start, end)]
            rows.append((t0 + (t1 - t0) * i / steps, *place, button))
    rows.append(motion[-1])
    return rows


def swing(start, place, amplitude, rate, turns, button):
    """Rows of a swing along x that grows within its first turn and fades within its last."""
    rows = []
    duration = turns / rate
    for i in range(round(duration / STEP) + 1):
        time = i * STEP
        growth = min(1.0, time * rate, (duration - time) * rate)
        x = place[0] + growth * amplitude * math.sin(2 * math.pi * rate * time)
        rows.append((start + time, x, place[1], place[2], button))
    return rows


def stir(start, place, radius, rate, turns, button):
    """Rows of circles about +y, from +x towards -z, that grow within the first turn and shrink within the last."""
    rows = []
    duration = turns / rate
    for i in range(round(duration / STEP) + 1):
        time = i * STEP
        now = radius * min(1.0, time * rate, (duration - time) * rate)
        angle = 2 * math.pi * rate * time
        rows.append((start + time, place[0] + now * math.cos(angle), place[1], place[2] - now * math.sin(angle), button))
    return rows


def circle(start, place, radius, rate, turns, button):
    """Rows of circles about +y from +x towards -z that begin and end at rest."""
    duration = turns / rate
    rows = []
    for i in range(round(duration / STEP) + 1):
        share = i * STEP / duration
        angle = 2 * math.pi * turns * (share - math.sin(2 * math.pi * share) / (2 * math.pi))
        rows.append((start + i * STEP, place[0] + radius * math.cos(angle), place[1], place[2] - radius * math.sin(angle), button))
    return rows


TAP = [(0.0, 0.02, 0.09, 0.01, 0), (0.3, 0.02, 0.09, 0.01, 0), (0.5, 0.02, 0.052, 0.01, 0), (0.7, 0.02, 0.09, 0.01, 0),
       (2.0, 0.02, 0.09, 0.01, 0)]

PINCH = [(0.0, 0.08, 0.01, 0.0, 0), (0.5, 0.08, 0.01, 0.0, 0), (1.2, 0.048, 0.01, 0.0, 0), (1.6, 0.048, 0.01, 0.0, 0),
         (2.6, 0.048, 0.06, 0.0, 0), (3.6, 0.048, 0.06, 0.0, 0), (4.6, 0.048, 0.011, 0.0, 0), (5.2, 0.09, 0.011, 0.0, 0),
         (5.5, 0.09, 0.011, 0.0, 0)]

SLIDE = [(0.0, -0.03, 0.08, 0.0, 0), (0.3, -0.03, 0.08, 0.0, 0), (0.9, -0.03, 0.055, 0.0, 0), (1.2, -0.03, 0.055, 0.0, 0),
         (2.7, 0.03, 0.055, 0.0, 0), (3.0, 0.03, 0.055, 0.0, 0), (3.5, 0.03, 0.08, 0.0, 0)]

REST = [(0.0, 0.1, -0.02, 0.0, 0), (2.5, 0.1, -0.02, 0.0, 0), (3.5, 0.03, -0.02, 0.0, 0), (4.5, 0.1, -0.02, 0.0, 0),
        (5.0, 0.1, -0.02, 0.0, 0)]

HOLD = (0.0, 0.064, 0.0)
SWING = (smooth([(0.0, 0.0, 0.09, 0.0, 0), (0.3, 0.0, 0.09, 0.0, 0), (0.6, *HOLD, 0), (0.7, *HOLD, 1), (1.0, *HOLD, 1)])[:-1]
         + swing(1.0, HOLD, 0.03, 1.5, 6, 1)
         + [(5.1, *HOLD, 1), (5.2, *HOLD, 0), (5.5, 0.0, 0.12, 0.0, 0)])

STACK = [(0.0, 0.12, 0.31, 0.0, 0), (3.0, 0.12, 0.31, 0.0, 0), (5.0, -0.05, 0.31, 0.0, 0), (5.5, -0.05, 0.31, 0.0, 0),
         (6.5, 0.12, 0.31, 0.0, 0), (8.0, 0.12, 0.31, 0.0, 0)]

PEG = [(0.0, 0.2, 0.06, 0.0, 0), (1.0, 0.2, 0.06, 0.0, 0), (4.0, 0.05, 0.06, 0.0, 0), (5.5, 0.05, 0.06, 0.0, 0),
       (6.5, 0.2, 0.06, 0.0, 0)]

SQUEEZE = [(0.0, 0.08, 0.055, 0.0, 0), (1.0, 0.08, 0.055, 0.0, 0), (1.8, 0.034, 0.055, 0.0, 0), (2.2, 0.034, 0.055, 0.0, 0),
           (3.2, 0.034, 0.105, 0.0, 0), (4.2, 0.034, 0.105, 0.0, 0), (5.2, 0.034, 0.056, 0.0, 0), (5.8, 0.08, 0.056, 0.0, 0),
           (6.2, 0.08, 0.056, 0.0, 0)]

KNOB = (0.0, 0.12, 0.0)
TRAY = (smooth([(0.0, 0.0, 0.15, 0.0, 0), (0.5, 0.0, 0.15, 0.0, 0), (0.9, *KNOB, 0), (1.0, *KNOB, 1), (1.2, *KNOB, 1)])[:-1]
        + stir(1.2, KNOB, 0.085, 0.3, 3, 1)
        + [(11.4, *KNOB, 1), (11.5, *KNOB, 0), (12.0, 0.0, 0.15, 0.0, 0), (12.5, 0.0, 0.15, 0.0, 0)])

EDGE = (0.09, 0.01, -0.03)  # of the spatula, where its mesh begins
SPATULA = [(0.0, *EDGE, 0), (1.5, *EDGE, 0), (3.5, -0.06, 0.01, -0.03, 0), (3.7, -0.06, 0.01, -0.03, 0),
           (5.7, -0.06, 0.09, -0.03, 0), (7.7, -0.06, 0.09, -0.03, 0), (9.7, -0.06, 0.01, -0.03, 0), (10.0, -0.06, 0.01, -0.03, 0),
           (11.5, *EDGE, 0), (12.0, *EDGE, 0)]

FOOT = (-0.008, 0.01, -0.008)  # from the rod's axis to where its mesh begins, and its height
BOWL = (smooth([(0.0, 0.09 + FOOT[0], *FOOT[1:], 0), (1.0, 0.09 + FOOT[0], *FOOT[1:], 0)])[:-1]
        + circle(1.0, FOOT, 0.09, 0.25, 2, 0))

RING = 0.04  # m, of the torus: radius of the tube's circle, of the tube
TUBE = 0.02
DEPTH = 0.013  # how far inside the tube a pinching tip is led
SAG = 0.009  # of the ring's other side, when one hand holds it


def pinch_of_ring(side, outer, way):
    """Of one finger of the hand on a side (+1 right, -1 left): way is a list of (time, x, y, gap), the middle of the tube
    between both fingers and how far each tip is outside the tube."""
    finger = side if outer else -side
    return smooth([(time, x + finger * (TUBE + gap), y, 0.0, 0) for time, x, y, gap in way])


RIGHT = [(0.0, RING, 0.025, 0.012), (0.5, RING, 0.025, 0.012), (1.2, RING, 0.025, -DEPTH), (1.5, RING, 0.025, -DEPTH),
         (2.5, RING, 0.125, -DEPTH), (3.5, RING - 0.1, 0.125, -DEPTH), (5.7, RING - 0.1, 0.125, -DEPTH),
         (6.4, RING - 0.1, 0.125, 0.012), (7.4, RING - 0.1, 0.222, 0.012), (10.0, RING - 0.1, 0.222, 0.012)]
LEFT = [(0.0, -RING - 0.1, 0.222, 0.012), (3.5, -RING - 0.1, 0.222, 0.012), (4.5, -RING - 0.1, 0.125 - SAG, 0.012),
        (5.2, -RING - 0.1, 0.125 - SAG, -DEPTH), (7.0, -RING - 0.1, 0.125 - SAG, -DEPTH),
        (8.0, -RING - 0.2, 0.125 - SAG, -DEPTH), (10.0, -RING - 0.2, 0.125 - SAG, -DEPTH)]

SCRIPTS = {
    "tap": ("From 3 cm above a face at y = 6 cm to 8 mm below it and back, at once.", smooth(TAP)),
    "pinch": ("From 2 cm off a face at x = 6 cm to 1.2 cm inside it, 5 cm up, down again, and off.", smooth(PINCH)),
    "slide": ("Down to 5 mm below a face at y = 6 cm, 6 cm along it, and off.", smooth(SLIDE)),
    "rest": ("Waits for 2.5 s, then pushes along -x from 4 cm off a face at x = 6 cm to 3 cm inside it, and back.", smooth(REST)),
    "stack": ("Waits for 3 s, then pushes along -x from 6 cm off a face at x = 6 cm to 11 cm inside it, and back.", smooth(STACK)),
    "tray": ("To the top of a cube at y = 12 cm, takes hold (1 s), three circles of up to 8.5 cm, lets go (11.5 s).", TRAY),
    "peg": ("Waits for 1 s, then pushes along -x from x = 20 cm to 5 cm, stays for 1.5 s, and back.", smooth(PEG)),
    "squeeze": ("From 3 cm off a ball of 5 cm to 1.6 cm inside it, 5 cm up, down again, and off.", smooth(SQUEEZE)),
    "spatula": ("Waits for 1.5 s, 15 cm along -x, 8 cm up, stays for 2 s, down and back.", smooth(SPATULA)),
    "bowl": ("Waits for 1 s, then two circles of 9 cm.", BOWL),
    "torus-right-outer": ("Pinches a ring's tube from outside at x = 4 cm, lifts it, carries it 10 cm along -x, lets go (5.7 s).",
                          pinch_of_ring(1, True, RIGHT)),
    "torus-right-inner": ("The same from inside.", pinch_of_ring(1, False, RIGHT)),
    "torus-left-outer": ("Pinches the ring's tube from outside at x = -14 cm (5.2 s), carries 10 cm along -x (8 s).",
                         pinch_of_ring(-1, True, LEFT)),
    "torus-left-inner": ("The same from inside.", pinch_of_ring(-1, False, LEFT)),
    "swing": ("To 4 mm above a face at y = 6 cm, takes hold (0.7 s), swings 3 cm at 1.5 Hz (1 s), lets go (5.2 s).", SWING),
}


def main():
    if len(sys.argv) > 2 or sys.argv[1:] in (["-h"], ["--help"]):
        sys.exit(__doc__.strip())
    folder = sys.argv[1] if len(sys.argv) == 2 else os.path.join(os.path.dirname(__file__), "..", "configs", "scripts")
    for name, (comment, rows) in SCRIPTS.items():
        with open(os.path.join(folder, name + ".csv"), "w") as file:
            file.write(f"# {comment}\n# Made by scripts/make_stylus_scripts.py.\ntime,x,y,z,button\n")
            for time, x, y, z, button in rows:
                file.write(f"{time:.3f},{x:.5f},{y:.5f},{z:.5f},{button}\n")


main()
