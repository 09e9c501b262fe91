"""What precomputation, runs and comparisons left behind, as numpy arrays and plain numbers."""

import json
import re

import h5py
import numpy as np


class Model:
    """Mesh, body and modes of a model file (docs/files.md)."""

    def __init__(self, path):
        with h5py.File(path) as file:
            mesh, modal = file["/mesh"], file["/response/modal"]
            self.nodes = len(mesh["nodes"])
            self.tets, self.order = len(mesh["tets"]), 1 if mesh["tets"].shape[1] == 4 else 2
            self.rest = mesh["nodes"][:][mesh["surface_nodes"][:]]  # (n, 3) m, B
            self.triangles = mesh["triangles"][:]
            self.mass, self.inertia = file["/body"].attrs["mass"], file["/body"].attrs["inertia"]
            self.material = {key: file["/material"].attrs[key]
                             for key in ("youngs_modulus", "poisson_ratio", "density")}
            self.dt, self.steps = file["/response"].attrs["dt"], int(file["/response"].attrs["steps"])
            self.w, self.decay = modal["angular_frequency"][:], modal["decay_rate"][:]
            self.shapes = modal["shapes"][:].astype(float)  # (3n, r)

    @property
    def lowest_frequency(self):
        """Of the first elastic mode, undamped [Hz]."""
        return self.w[0] / (2 * np.pi)


class Run:
    """A run file of irdm-replay: places of an object's surface nodes, and of the styluses, frame by frame."""

    def __init__(self, path, object=0):
        with h5py.File(path) as file:
            group = file[f"/object/{object}"]
            self.time = file["/time"][:]
            self.rest = group["rest"][:]
            self.displacement = group["displacement"][:]  # (F, n, 3) m, B
            self.position, orientation = group["position"][:], group["orientation"][:]
            self.tip = file[f"/stylus/{object if f'/stylus/{object}' in file else 0}/tip"][:]
            self.force = file[f"/stylus/{object if f'/stylus/{object}' in file else 0}/force"][:]
        self.rotation = np.array([rotation_matrix(q) for q in orientation])

    def frame(self, time):
        return int(np.argmin(np.abs(self.time - time)))

    def places(self, frame, exaggeration=1.0):
        """Of the surface nodes, deformation exaggerated [m], W."""
        local = self.rest + exaggeration * self.displacement[frame]
        return self.position[frame] + local @ self.rotation[frame].T


def rotation_matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def read_comparison(path):
    return json.loads(path.read_text())


def figure_of(log, label):
    """The text after `label` in a summary of irdm-precompute."""
    found = re.search(rf"^ *{re.escape(label)}  +(.*)$", log.read_text(), re.MULTILINE)
    if not found:
        raise SystemExit(f"reproduce: {log}: there is no '{label}'")
    return found[1]
