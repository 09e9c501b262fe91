"""Plays a scene of the gallery, shortened and with a small model, with irdm-play, and looks at what it leaves.

usage: check_play.py SOURCES PROGRAMS page|no-page      no-page: the viewer's page is not built
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request

import h5py

SCENE = "tap"
END = 0.7  # s, of the script: four frames
DEADLINE = 600  # s
failures = []


def check(holds, words):
    print("ok  " if holds else "FAIL", words, flush=True)
    if not holds:
        failures.append(words)


def make_data(sources, data):
    """A folder for IRDM_DATA: the scene as it is, fewer cells, the beginning of the script."""
    for name in (f"scenes/{SCENE}.toml", f"bridges/{SCENE}.toml", "models/soft-cube.toml", f"scripts/{SCENE}.csv"):
        (data / "configs" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(sources / "configs" / name, data / "configs" / name)
    (data / "scripts").symlink_to(sources / "scripts")
    model = data / "configs/models/soft-cube.toml"
    model.write_text(re.sub(r"cells = \[.*\]", "cells = [2, 2, 2]", model.read_text()))
    script = data / "configs/scripts" / f"{SCENE}.csv"
    rows = [row for row in script.read_text().splitlines() if not row[0].isdigit() or float(row.split(",")[0]) <= END]
    script.write_text("\n".join(rows) + "\n")


class Play:
    """irdm-play in a process group of its own: SIGINT reaches it as from a terminal, and what it leaves is found."""

    def __init__(self, sources, programs, data, out, options):
        environment = os.environ | {"IRDM_PROGRAMS": str(programs), "IRDM_DATA": str(data)}
        self.process = subprocess.Popen([sources / "scripts/irdm-play", SCENE, "--out", out, *options], env=environment,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        start_new_session=True, preexec_fn=default_signals)
        self.printed = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.signal_group(signal.SIGKILL)
        self.process.wait()
        self.process.stdout.close()

    def line(self, pattern):
        """The first line with the pattern, waited for; None: it ended without."""
        for text in self.process.stdout:
            self.printed.append(text)
            found = re.search(pattern, text)
            if found:
                return found
        return None

    def end(self):
        """Exit status; what it printed is read to its end, which is when nobody can write to it any more."""
        self.printed += self.process.stdout
        return self.process.wait()

    def signal_group(self, number):
        """Whether there was a process."""
        try:
            os.killpg(self.process.pid, number)
        except ProcessLookupError:
            return False
        return True


def default_signals():
    """What starts in the background ignores SIGINT, and so would all that it starts."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def give_up(*_):
    raise TimeoutError(f"not at its end after {DEADLINE} s")


def expect(status, play, words, wanted=0):
    check(status == wanted, f"{words}: exit status {status}")
    if status != wanted:
        print("".join(play.printed))
    check(not play.signal_group(signal.SIGKILL), f"{words}: no process is left")


def touched(trace):
    """Of the styluses of a trace, those that touched something."""
    with h5py.File(trace) as file:
        return sorted(name for name, sets in file["/stylus"].items() if sets["contact"][:].any())


def check_forces(folder, words):
    """The number of styluses in the trace."""
    trace = folder / "trace.h5"
    check(trace.is_file(), f"{words}: a trace")
    forces = sorted(path.stem.removeprefix("force-") for path in folder.glob("force-*.png"))
    check(forces == touched(trace) == ["0"], f"{words}: a force of each stylus that touched: {forces}")
    with h5py.File(trace) as file:
        return len(file["/stylus"])


def play_once(play, folder, draws):
    with play:
        expect(play.end(), play, "--lockstep --once")
    check_forces(folder, "--lockstep --once")
    frames = list((folder / "frames").glob("*.png"))
    check((len(frames) > 2) == draws, f"--lockstep --once: {len(frames)} frames")


def play_until(play, end, words, page_built):
    """Until the page is shown, and then until `end` has sent its signal."""
    with play:
        shown = play.line(r"shown at (http\S+);")
        check(shown, f"{words}: says where the run is shown")
        if shown and page_built:
            text = urllib.request.urlopen(shown[1], timeout=DEADLINE).read().decode()
            check("<script" in text, f"{words}: shows the viewer's page")
        end()
        expect(play.end(), play, words)
    check(not any("drawing the object" in text for text in play.printed), f"{words}: draws no frames")


def interrupt(play, number, words):
    """While it plays: it ends by the signal, after all that it started. SIGINT goes to all, as from a terminal."""
    with play:
        check(play.line("in real time"), f"{words}: plays")
        if number == signal.SIGINT:
            play.signal_group(number)
        else:
            play.process.send_signal(number)
        expect(play.end(), play, words, -number)


def main():
    sources, programs, page_built = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3] == "page"
    signal.signal(signal.SIGALRM, give_up)
    signal.alarm(DEADLINE)
    with tempfile.TemporaryDirectory(prefix="irdm-gallery-") as name:
        data, out = pathlib.Path(name) / "data", pathlib.Path(name) / "out"
        make_data(sources, data)

        def start(*options):
            return Play(sources, programs, data, out, options)

        # Without the page nothing can be drawn.
        draws = page_built and shutil.which("chromium") is not None
        play_once(start("--lockstep", "--once", *([] if draws else ["--no-frames"])), out / SCENE, draws)

        play = start("--no-frames")
        play_until(play, lambda: play.signal_group(signal.SIGINT), "in real time, Ctrl-C", page_built)
        styluses = check_forces(out / SCENE, "in real time")
        check(styluses == 2, "in real time: the mouse is a stylus too")

        play = start("--lockstep", "--no-frames")
        play_until(play, play.process.terminate, "in lockstep, SIGTERM", page_built)

        for number in (signal.SIGINT, signal.SIGTERM):
            interrupt(start("--no-frames"), number, f"while it plays, {signal.Signals(number).name}")
    sys.exit(f"{len(failures)} checks failed" if failures else 0)


main()
