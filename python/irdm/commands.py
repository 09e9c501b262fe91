"""What irdm-precompute does, from Python."""

import contextlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import tomllib
import weakref
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from irdm import _core
from irdm.scene import to_toml


class CheckLine(NamedTuple):
    """A line of irdm.check(): verdict is "ok", "warn", "FAIL" or "none"; found says what was measured, with unit."""

    name: str
    verdict: str
    found: str


def _program():
    package = Path(__file__).resolve().parent
    # Where it is installed, and in a build folder: BUILD/python/irdm and BUILD/bin.
    for folder in (package.parents[3] / "bin", package.parents[1] / "bin"):
        if (folder / "irdm-precompute").is_file():
            return str(folder / "irdm-precompute")
    program = shutil.which("irdm-precompute")
    if program is None:
        raise _core.Error(
            f"irdm-precompute: is neither beside the package ({package}) nor in PATH; install the package irdm, or add the "
            "folder that the program is in to PATH"
        )
    return program


@contextlib.contextmanager
def _until_terminated():
    """SIGTERM, which would end Python without a word, becomes SystemExit, so that what was begun is put away."""
    main = threading.current_thread() is threading.main_thread()
    if not main or signal.getsignal(signal.SIGTERM) is not signal.SIG_DFL:
        yield
        return

    def end(number, _frame):
        raise SystemExit(128 + number)

    signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _run(arguments, progress=None):
    """Its lines. The program ends with this call, however it ends, and with this process."""
    with_parent = ["setpriv", "--pdeathsig", "TERM", "--"] if shutil.which("setpriv") else []
    with tempfile.TemporaryFile("w+") as complaints, subprocess.Popen(
        [*with_parent, _program(), *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=complaints, text=True
    ) as process:
        try:
            lines = []
            for line in process.stdout:
                lines.append(line.rstrip("\n"))
                if progress is not None:
                    share = re.search(r"  +(\d+) %", line)
                    progress(lines[-1], int(share[1]) / 100.0 if share else None)
            status = process.wait()
        except BaseException:
            process.terminate()
            raise
        complaints.seek(0)
        return status, lines, complaints.read().strip()


def precompute(config, output=None, *, progress=None, threads=None):
    """Computes a model file and reads it.

    config: path of a configuration file, or a dict with its keys (docs/configuration.md). Relative paths of a dict start
    from the working directory. output: the model file [HDF5]; None: a temporary one, which lives as long as the Model.
    progress: called as progress(text, fraction) with each line that the program prints, fraction in 0..1 or None.
    threads: to compute with; None: all cores. Raises irdm.Error. KeyboardInterrupt and what `progress` raises end the
    computation, and so does SIGTERM where the program has no handler of its own: it becomes SystemExit.
    """
    with _until_terminated():
        folder = tempfile.mkdtemp(prefix="irdm-")
        try:
            model = _precompute(config, output, folder, progress, threads)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
    if output is None:
        weakref.finalize(model, shutil.rmtree, folder, ignore_errors=True)
    else:
        shutil.rmtree(folder, ignore_errors=True)
    return model


def _precompute(config, output, folder, progress, threads):
    if isinstance(config, Mapping):
        table = dict(config)
        mesh = table.get("mesh")
        if isinstance(mesh, Mapping) and "file" in mesh:
            table["mesh"] = {**mesh, "file": os.path.abspath(mesh["file"])}
        config = os.path.join(folder, "config.toml")
        Path(config).write_text(to_toml(table), encoding="utf-8")
    else:
        config = os.fspath(config)
    path = os.path.join(folder, "model.h5") if output is None else os.fspath(output)
    arguments = [config, "-o", path]
    if threads is not None:
        arguments += ["--threads", str(int(threads))]
    status, _, complaints = _run(arguments, progress)
    if status != 0:
        last = complaints.splitlines()[-1] if complaints else f"ended with status {status}"
        raise _core.Error(last.removeprefix("irdm-precompute: error: ").replace(folder + os.sep, ""))
    response = tomllib.loads(Path(config).read_text(encoding="utf-8")).get("response", {})
    return _core.Model(path, "dense" if response.get("storage") == "dense" else "modal")


def check(model, *, coupling=None, hand_mass=None, hand_damping=None, hand_stiffness=None, delay=None):
    """Whether a model is physically sound and safe to render (docs/check.md): a list of CheckLine.

    model: path or Model. coupling [N/m], hand_mass [kg], hand_damping [N s/m], hand_stiffness [N/m], delay one way [s]:
    the loop that it is judged in. Raises irdm.Error when the file cannot be read at all.
    """
    path = model.path if isinstance(model, _core.Model) else os.fspath(model)
    arguments = ["check", path]
    for option, value in (("--coupling", coupling), ("--hand-mass", hand_mass), ("--hand-damping", hand_damping),
                          ("--hand-stiffness", hand_stiffness), ("--delay", delay)):
        if value is not None:
            arguments += [option, repr(float(value))]
    status, lines, complaints = _run(arguments)
    found = (re.fullmatch(r"  (\S.*?)  +(ok|warn|FAIL|none)  +(.*)", line) for line in lines)
    report = [CheckLine(*line.groups()) for line in found if line]
    if status not in (0, 1) or not report:
        last = complaints.splitlines()[-1] if complaints else f"ended with status {status}"
        raise _core.Error(last.removeprefix("irdm-precompute: error: "))
    return report
