"""Episodes for imitation and offline learning, as HDF5 files in the layout of robomimic."""

import json
import os
from contextlib import AbstractContextManager

import numpy

from irdm import _core


class Episodes(AbstractContextManager):
    """A file of episodes that grows: `data/demo_0`, `data/demo_1`, ... Needs h5py. Use it with `with`, or close() it.

    Each has `obs/NAME`, `next_obs/NAME`, `actions`, `rewards`, `dones`, a row a transition, and the attribute
    `num_samples`; `data` has `total` and `env_args`. Layout: robomimic.github.io/docs/datasets/overview.html.
    A file that is there is replaced. name: of the task. arguments: dict of what else made the episodes.
    """

    def __init__(self, path, name, arguments=None):
        import h5py

        self.path = os.fspath(path)
        try:
            self._file = h5py.File(self.path, "w")
        except OSError as error:
            raise _core.Error(f"{self.path}: cannot be written; choose a folder that is there") from error
        self._data = self._file.create_group("data")
        self._data.attrs["total"] = 0
        self._data.attrs["env_args"] = json.dumps({"env_name": name, "type": 2, "env_kwargs": arguments or {}})
        self.count = 0

    def close(self):
        self._file.close()

    def __exit__(self, *_):
        self.close()

    def add(self, observations, actions, rewards, dones=None):
        """One episode of n actions.

        observations: n + 1 dicts of arrays, the first as reset() gave it. actions: (n, a). rewards: (n). dones: (n), or
        None: the last one. Raises irdm.Error where these do not fit, and writes nothing then.
        """
        actions = numpy.asarray(actions, dtype=float)
        rewards = numpy.asarray(rewards, dtype=float)
        n = len(actions)
        dones = numpy.arange(1, n + 1) == n if dones is None else numpy.asarray(dones, dtype=bool)
        if n == 0 or actions.ndim != 2 or rewards.shape != (n,) or dones.shape != (n,) or len(observations) != n + 1:
            raise _core.Error(f"episode {self.count}: does not fit; give n + 1 observations, actions (n, a), rewards (n)")
        names = sorted(observations[0])
        if any(sorted(one) != names for one in observations):
            raise _core.Error(f"episode {self.count}: observations have different names; give the same in each")
        columns = {name: numpy.stack([numpy.asarray(one[name]) for one in observations]) for name in names}
        self._write(columns, actions, rewards, dones)

    def add_trace(self, trace, rewards=None):
        """A recorded run (Trace) as one episode: what styluses did in a step is the action after what was seen before it.

        Observations: tips, forces on the styluses [m, N], contact, poses of the objects [m; w, x, y, z]. Actions: of each
        stylus tip [m], buttons, present. rewards: of each step but the first, or None: zeros. Raises irdm.Error.
        """
        styluses = sorted({int(name.split("/")[1]) for name in trace.names if name.startswith("stylus/")})
        bodies = [name for name in trace.names if name.endswith(("body_position", "body_orientation"))]
        columns = {}
        for name, source in (("tips", "tip"), ("forces", "applied_force"), ("contact", "contact")):
            columns[name] = numpy.stack([trace[f"stylus/{s}/{source}"] for s in styluses], axis=1)
        columns.update({name.replace("/", "_"): trace[name] for name in bodies})
        present = numpy.stack([trace[f"stylus/{s}/present"] for s in styluses], axis=1)
        buttons = numpy.stack([trace[f"stylus/{s}/buttons"] for s in styluses], axis=1)
        tips = numpy.where(present[..., None] != 0, columns["tips"], 0.0)
        actions = numpy.concatenate([tips, buttons[..., None], present[..., None]], axis=-1)[1:]
        n = len(actions)
        if n < 1:
            raise _core.Error(f"{trace.path}: has fewer than two steps; record a longer run")
        rewards = numpy.zeros(n) if rewards is None else numpy.asarray(rewards, dtype=float)
        if rewards.shape != (n,):
            raise _core.Error(f"{trace.path}: {n} rewards are needed, one a step but the first")
        self._write(columns, actions.reshape(n, -1).astype(float), rewards, numpy.arange(1, n + 1) == n)

    def _write(self, columns, actions, rewards, dones):
        group = self._data.create_group(f"demo_{self.count}")
        for name, rows in columns.items():
            group.create_dataset(f"obs/{name}", data=rows[:-1], compression="gzip")
            group.create_dataset(f"next_obs/{name}", data=rows[1:], compression="gzip")
        for name, rows in (("actions", actions), ("rewards", rewards), ("dones", dones.astype(numpy.int64))):
            group.create_dataset(name, data=rows, compression="gzip")
        group.attrs["num_samples"] = len(actions)
        self._data.attrs["total"] += len(actions)
        self.count += 1
