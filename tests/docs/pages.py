"""The pages that are run: what stands for what in them, and what has to be there in the end."""

from dataclasses import dataclass, field
from typing import Callable

from outcomes import check_comparison, check_embedding, check_first_session, check_liver, check_tutorial

SCENE = """
[[object]]
name = "cube"
model = "cube.h5"
[[stylus]]
radius = 0.02
coupling_stiffness = 500
"""


@dataclass
class Page:
    file: str
    check: Callable  # of (terminal, printed): raises when something lacks
    section: str = None  # from this line to the next heading; None: all
    left_out: tuple = ()  # configurations and commands with these texts
    installed: tuple = ()  # groups with these texts, which need what is installed
    needs: tuple = ()  # programs of others
    quick: dict = field(default_factory=dict)  # texts of pages and files, and what is in their place but with --numbers
    instead: dict = field(default_factory=dict)  # texts of commands and what is in their place
    files: dict = field(default_factory=dict)  # that a reader has: their text, or a file of the clone
    first: tuple = ()  # commands that a reader has given before
    servers: dict = field(default_factory=dict)  # text of a group and the server that it needs
    python: str = ""  # what a reader has before the first line of Python


PAGES = {
    "tutorial": Page(
        "docs/tutorial.md",
        check_tutorial,
        left_out=('type = "openhaptics"',),
        needs=("gmsh",),
        # A hundredth of the time to compute.
        quick={"order = 2": "order = 1", "edge_length = 0.014": "edge_length = 0.018"},
    ),
    "readme": Page(
        "README.md",
        check_first_session,
        section="The same by hand:",
        left_out=("scripts/setup.sh", "scripts/build.sh"),
        quick={"cells = [12, 12, 12]": "cells = [4, 4, 4]"},
    ),
    "embedding": Page(
        "docs/embedding.md",
        check_embedding,
        installed=("examples/embed",),
        instead={"MODEL.h5": "cube.h5"},
        files={"cube.toml": "configs/models/soft-cube.toml", "scene.toml": SCENE},
        servers={"localhost:4321": "irdm-server scene.toml --port 4321"},
        python="import irdm\ntips = [[[0.0, 0.05, 0.0]]] * 10\n",
    ),
    "meshes": Page(
        "docs/meshes.md",
        check_liver,
        section="## The liver",
        needs=("gmsh",),
        quick={"order = 2": "order = 1"},
    ),
    "replay": Page(
        "docs/replay.md",
        check_comparison,
        files={"cube.toml": "configs/models/soft-cube.toml", "scene.toml": SCENE},
        first=(
            "irdm-precompute cube.toml -o cube.h5",
            "irdm-server scene.toml --port 47000 --record trace.h5",
            "irdm-bridge configs/bridges/tap.toml --server 127.0.0.1:47000",
        ),
    ),
}
