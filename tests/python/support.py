"""Models and scenes that the tests share."""

import functools
import os
import tempfile

import irdm

# Of a sanitizer, which only an interpreter needs: programs that are started have their own.
PRELOADED = os.environ.pop("LD_PRELOAD", "")

folder = tempfile.TemporaryDirectory(prefix="irdm-test-")


def cube_config(**more):
    config = {
        "mesh": {"box": {"size": [0.12, 0.12, 0.12], "cells": [3, 3, 3]}, "order": 1},
        "material": {"youngs_modulus": 5000.0, "poisson_ratio": 0.4, "density": 110.0},
        "response": {"dt": 0.002, "steps": 100},
    }
    config.update(more)
    return config


@functools.cache
def cube():
    """A soft cube of 12 cm, all modes."""
    return irdm.precompute(cube_config(), f"{folder.name}/cube.h5")


@functools.cache
def block():
    """A rigid cube of 6 cm."""
    config = {
        "mesh": {"box": {"size": [0.06, 0.06, 0.06], "cells": [2, 2, 2]}},
        "material": {"rigid": True, "density": 200.0},
        "response": {"dt": 0.002},
    }
    return irdm.precompute(config, f"{folder.name}/block.h5")


def scene(**more):
    """A soft cube on a plane, a rigid block on the cube; two fingertips."""
    table = {
        "world": {"gravity": [0, -9.81, 0]},
        "stylus": [{"radius": 0.02, "coupling_stiffness": 500, "reach": 0.01}] * 2,
        "object": [
            {"name": "cube", "model": cube(), "position": [0, 0.061, 0]},
            {"name": "block", "model": block(), "position": [0.01, 0.153, 0]},
        ],
        "scenery": [{"name": "table", "plane": {}}],
    }
    table.update(more)
    return table
