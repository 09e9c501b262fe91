"""A person's own STL file becomes an object that a stylus touches, by the tutorial's steps; what is wrong with it is
refused in one line, and mended as that line says. Prints the time of each step.

usage: check_shapes.py SOURCES PROGRAMS [--all]      --all: every shape of make_shapes.py; otherwise a coarse kidney
"""

import os
import pathlib
import re
import sys
import tempfile
import time

import h5py
import numpy as np
from make_shapes import triangles_of, write_stl

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
from terminal import CommandFailed, Terminal  # noqa: E402

HOLE = 5  # triangles that lack
DEPTH = 0.01  # m, below the highest node
# mesh.edge_length of each [m]; before it one that is refused, and what the message says to do.
EDGES = {
    "kidney": [(None, "with a larger mesh.edge_length"), (0.012, None)],
    "mug-with-handle": [(0.008, None)],
    "torus-knot": [(0.012, "make mesh.edge_length smaller"), (0.009, None)],
}


def expect(holds, words):
    print("ok  " if holds else "FAIL", words, flush=True)
    if not holds:
        sys.exit(1)


class Shape:
    """A folder with one shape, and what the tutorial has for the ring."""

    def __init__(self, name, step, sources, terminal):
        self.name, self.terminal = name, terminal
        self.folder = pathlib.Path(terminal.folder)
        self.triangles = triangles_of(name, step)
        tutorial = sources / "examples/tutorial"
        for file in ("bridge.toml", "scene.toml"):
            (self.folder / file).write_text((tutorial / file).read_text().replace("ring", name))
        self.model = (tutorial / "ring.toml").read_text().replace("ring", name).replace("order = 2", "order = 1")
        self.write()

    def write(self, without=0):
        write_stl(self.folder / f"{self.name}.stl", self.triangles[without:])

    def precompute(self, edge_length, unit="mm"):
        lines = [f'unit = "{unit}"' if unit else "", f"edge_length = {edge_length}" if edge_length else ""]
        text = re.sub(r"unit = .*\nedge_length = .*", "\n".join(lines), self.model)
        (self.folder / "model.toml").write_text(text)
        return self.timed(f"irdm-precompute model.toml -o {self.name}.h5")

    def refused(self, remedy, *arguments):
        """In one line that says what to do, and no model is left."""
        try:
            self.precompute(*arguments)
        except CommandFailed as failed:
            lines = failed.printed.splitlines()
            expect(failed.status == 1 and len(lines) == 1 and remedy in lines[0], f"{self.name} is refused: {lines}")
            expect(not (self.folder / f"{self.name}.h5").exists(), f"{self.name}: no model is left")
        else:
            expect(False, f"{self.name} is refused with '{remedy}'")

    def timed(self, command):
        begin = time.monotonic()
        printed = self.terminal.run(command)
        print(f"     {time.monotonic() - begin:.1f} s: {command}", flush=True)
        return printed

    def touch(self):
        """Presses on the highest node from above and goes up again."""
        with h5py.File(self.folder / f"{self.name}.h5") as model:
            nodes = model["/mesh/nodes"][:]
        top = nodes[np.argmax(nodes[:, 1])]
        rows = [(0, 0.03), (1, -DEPTH), (1.5, -DEPTH), (2, 0.03)]
        (self.folder / "touch.csv").write_text("time,x,y,z,button\n" + "".join(
            f"{when},{top[0]:.5f},{top[1] + above:.5f},{top[2]:.5f},0\n" for when, above in rows))
        self.terminal.run("irdm-server scene.toml --port 47000 --record trace.h5")
        self.timed("irdm-bridge bridge.toml --server 127.0.0.1:47000")
        self.terminal.end_server()
        with h5py.File(self.folder / "trace.h5") as trace:
            contact, force = trace["/stylus/0/contact"][:], trace["/stylus/0/force"][:]
        touched = np.count_nonzero(contact == 1)
        highest = np.linalg.norm(force, axis=1).max()
        expect(touched > 100 and highest > 0.01 and contact[-1] == 0,
               f"{self.name}: touched in {touched} steps, with up to {highest:.2f} N")


def follow(shape, edges):
    for edge_length, remedy in edges:
        if remedy:
            shape.refused(remedy, edge_length)
        else:
            shape.precompute(edge_length)
    shape.touch()


def mend(shape, edge_length):
    """A file in millimetres that is taken for metres, and one with a hole."""
    shape.refused("mind mesh.unit", edge_length, None)
    shape.write(without=HOLE)
    shape.refused("close the hole there", edge_length)
    shape.write()


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    sources, programs = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    environment = {"PATH": f"{programs}:{os.environ['PATH']}"}
    for name in EDGES if "--all" in sys.argv else ["kidney"]:
        with tempfile.TemporaryDirectory(prefix="irdm-shape-") as folder, Terminal(folder, environment, True) as terminal:
            coarse = "--all" not in sys.argv
            shape = Shape(name, 8.0 if coarse else None, sources, terminal)
            print(f"{name}.stl: {len(shape.triangles)} triangles", flush=True)
            mend(shape, EDGES[name][-1][0])
            follow(shape, [(0.016, None)] if coarse else EDGES[name])


main()
