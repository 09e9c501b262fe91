"""Recorded runs."""

import os
from contextlib import AbstractContextManager

from irdm import _core


class Trace(AbstractContextManager):
    """A trace file (docs/files.md), opened for reading. Needs h5py. Use it with `with`, or close() it.

    dt [s], steps and scene (text) describe it; arrays are read when they are asked for, and end at the last valid step.
    """

    def __init__(self, path):
        import h5py

        self.path = os.fspath(path)
        try:
            self._file = h5py.File(self.path, "r", swmr=True)
        except OSError as error:
            raise _core.Error(f"{self.path}: cannot be opened as HDF5; give a trace file") from error
        if self._file.attrs.get("format") not in ("irdm-trace", b"irdm-trace"):
            self._file.close()
            raise _core.Error(f"{self.path}: is not a trace; give a file that irdm-server recorded")
        self.dt = float(self._file.attrs["dt"])
        scene = self._file.attrs["scene"]
        self.scene = scene.decode() if isinstance(scene, bytes) else str(scene)
        self.steps = int(self._file["committed"][0])

    @classmethod
    def open(cls, path):
        """The same as Trace(path). Raises irdm.Error."""
        return cls(path)

    def close(self):
        self._file.close()

    def __exit__(self, *_):
        self.close()

    @property
    def names(self):
        """Of all sets that have a row a step, as ["step/time", "stylus/0/tip", ...]."""
        import h5py

        found = []

        def visit(name, item):
            if isinstance(item, h5py.Dataset) and name.split("/")[0] in ("step", "stylus", "object", "floor"):
                found.append(name)

        self._file.visititems(visit)
        return [name for name in found if len(self._file[name]) >= self.steps and name != "floor/node"
                and not name.endswith(("/floor/node", "floor/force"))]

    def __getitem__(self, name):
        """The rows of one set [unit of docs/files.md], as "stylus/0/applied_force": an array. Raises KeyError."""
        return self._file[name][: self.steps]

    @property
    def contacts(self):
        """Of objects with each other and scenery: a dict of arrays, a row a contact, `force_step` among them."""
        group = self._file.get("body_contact")
        return {} if group is None else {name: group[name][:] for name in group}

    def table(self, names=None):
        """The sets of these names, or all with a row a step, as a dict of columns: sets with several numbers a row become
        `name.0`, `name.1`, ..."""
        columns = {}
        for name in self.names if names is None else names:
            rows = self[name]
            if rows.ndim == 1:
                columns[name] = rows
            else:
                flat = rows.reshape(len(rows), -1)
                columns.update({f"{name}.{i}": flat[:, i] for i in range(flat.shape[1])})
        return columns
