"""Contact forces between soft bodies and what touches them, as arrays.

    import irdm
    model = irdm.precompute("cube.toml", "cube.h5")
    simulation = irdm.Simulation({"object": [{"model": "cube.h5"}], "stylus": [{"radius": 0.01}]})
    step = simulation.step([[0.0, 0.06, 0.0]])
    step.styluses["force"]      # on the stylus [N], world frame

SI units. Frames and equations: docs/theory.md; the package: docs/embedding.md. Tasks: irdm.environment.
"""

from irdm._core import (
    COUPLING,
    FLOOR,
    GRAB,
    OBJECT,
    RESET,
    SCENERY,
    STYLUS,
    Error,
    Model,
    Step,
    Steps,
    __version__,
    contact_dtype,
    object_dtype,
    stylus_dtype,
)
from irdm.commands import CheckLine, check, precompute
from irdm.episodes import Episodes
from irdm.lerobot import to_lerobot
from irdm.scene import Simulation, to_toml
from irdm.stylus import Stylus
from irdm.trace import Trace

__all__ = [
    "COUPLING", "FLOOR", "GRAB", "OBJECT", "RESET", "SCENERY", "STYLUS",
    "CheckLine", "Episodes", "Error", "Model", "Simulation", "Step", "Steps", "Stylus", "Trace", "__version__",
    "check", "contact_dtype", "object_dtype", "precompute", "stylus_dtype", "to_lerobot", "to_toml",
]
