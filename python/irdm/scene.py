"""A scene in this process."""

import json
import os
from collections.abc import Mapping

import numpy

from irdm import _core


def _value(value, where):
    if isinstance(value, _core.Model):
        if not value.path:
            raise _core.Error(f"{where}: is a model without a file; use one that was opened or computed")
        value = value.path
    if isinstance(value, (bool, numpy.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, numpy.integer)):
        return str(int(value))
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(_pairs(value, where)) + " }"
    if isinstance(value, (list, tuple, numpy.ndarray)):
        return "[" + ", ".join(_value(item, where) for item in value) + "]"
    raise _core.Error(f"{where}: is a {type(value).__name__}; use numbers, text, paths, lists and dicts")


def _pairs(table, where):
    for key, value in table.items():
        if not isinstance(key, str):
            raise _core.Error(f"{where}: has the key {key!r}; use text")
        name = f"{where}.{key}" if where else key
        yield f"{json.dumps(key)} = {_value(value, name)}"


def to_toml(table):
    """The text of a configuration file with the keys of a dict.

    table: dict of numbers, text, paths, models, lists, arrays and dicts. Raises irdm.Error for others.
    """
    return "\n".join(_pairs(table, "")) + "\n"


class Simulation(_core.SimulationCore):
    """A scene that is stepped in this process: what irdm-server computes in lockstep, to the bit.

    scene: path of a scene file, or a dict with its keys (docs/configuration.md), in which a model may be a path or a
    Model with one. Relative paths of a dict start from the working directory. Raises irdm.Error.

    One thread at a time; others raise RuntimeError. Simulations in several threads run side by side: the interpreter is
    free during a step. The same calls give the same bits.
    """

    def __init__(self, scene):
        if isinstance(scene, Mapping):
            super().__init__(to_toml(scene), "")
        else:
            super().__init__("", os.fspath(scene))
