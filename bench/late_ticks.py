#!/usr/bin/env python3
"""How many ticks at 1 kHz are late, live: a stylus client in Python, and a bridge with Haply's fake service, each with a
server of its own run on this machine; beside the first, `--bare` runs a loop that does nothing (cyclictest).

    bench/late_ticks.py MODEL.h5 [--programs build/release/bin] [--seconds 60] [--bare]

It prints what it measured and judges nothing: on a machine whose bare loop is late, so are they.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from contextlib import contextmanager
from pathlib import Path

SCENE = '[server]\nport = 0\n[[stylus]]\ncoupling_stiffness = 500\n[[object]]\nname = "object"\nmodel = "{}"\n'
BRIDGE = '[[device]]\ntype = "haply"\nservice = "127.0.0.1:{}"\nworkspace = {{ position = [0, -0.05, -0.12] }}\n'


def wait_for(path, pattern):
    for _ in range(600):
        found = re.search(pattern, path.read_text())
        if found:
            return found[1]
        time.sleep(0.05)
    sys.exit(f"late_ticks: nothing like {pattern} in {path.read_text()}")


@contextmanager
def running(command, log):
    with log.open("w") as output, subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT) as process:
        try:
            yield process
        finally:
            process.terminate()


@contextmanager
def server(options, folder):
    log = folder / "server.log"
    with running([options.programs / "irdm-server", folder / "scene.toml", "--no-viewer"], log):
        yield wait_for(log, r"listening on ([\d.]+:\d+)")


def share(late, ticks):
    return f"{late} of {ticks} ticks late, {100 * late / ticks:.3f} %"


def measure_client(options, folder):
    sys.path.insert(0, str(options.programs.parent / "python"))
    import irdm  # pylint: disable=import-outside-toplevel

    bare = ["cyclictest", "-q", "-m", "-p", "80", "-i", "1000", "-t", "1", "-D", str(options.seconds)]
    with server(options, folder) as address:
        beside = subprocess.Popen(bare, stdout=subprocess.PIPE, text=True) if options.bare else None
        with irdm.Stylus.connect(address, tip=(0, 0.08, 0), device={"realtime": "prefer"}) as stylus:
            end = time.monotonic() + options.seconds
            while time.monotonic() < end:
                stylus.set((0, 0.08, 0))
                time.sleep(0.004)
            print("client in Python:", share(stylus.late_ticks, stylus.ticks), flush=True)
        if beside:
            print("bare loop:", " ".join(beside.communicate()[0].split()), flush=True)


def measure_haply(options, folder):
    service_log, bridge = folder / "service.log", folder / "bridge.toml"
    service = [options.programs / "fake_inverse_service", "3.5", "0", "0", "0", "049D"]
    with server(options, folder) as address, running(service, service_log):
        bridge.write_text(BRIDGE.format(wait_for(service_log, r"ports (\d+)")))
        done = subprocess.run([options.programs / "irdm-bridge", bridge, "--server", address, "--duration",
                               str(options.seconds)], capture_output=True, text=True, check=False)
        found = re.search(r"servo: (\d+) ticks, (\d+) missed", done.stdout + done.stderr)
        if not found:
            sys.exit(f"late_ticks: the bridge failed: {done.stderr}")
        print("bridge with Haply's fake:", share(int(found[2]), int(found[1])), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=Path)
    parser.add_argument("--programs", type=Path, default=Path("build/release/bin"))
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--bare", action="store_true")
    options = parser.parse_args()
    options.programs = options.programs.resolve()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(SCENE.format(options.model.resolve()))
        measure_client(options, folder)
        measure_haply(options, folder)


if __name__ == "__main__":
    main()
