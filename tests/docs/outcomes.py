"""What has to be there when a page was run to its end, by what physics says of it."""

import pathlib
import re

import h5py
import numpy as np


def expect(holds, words):
    print("ok  " if holds else "FAIL", words, flush=True)
    if not holds:
        raise RuntimeError(words)


def check_tutorial(terminal, printed):
    folder = pathlib.Path(terminal.folder)
    verdicts = re.findall(r"^  (\w[\w ]*?)  +(ok|none|limit|fail\w*) ", printed, re.MULTILINE)
    # A coarse mesh may have too few nodes to measure a wave speed.
    bad = [line for line in verdicts if line[1] != "ok" and line != ("wave speed", "none")]
    expect(len(verdicts) >= 10 and not bad, f"irdm-precompute check says ok in {len(verdicts)} lines {bad or ''}")
    for name in ("force.png", "run.csv", "vtk/run.pvd"):
        expect((folder / name).stat().st_size > 0, f"{name} is there")
    with h5py.File(folder / "trace.h5") as trace:
        contact = trace["/stylus/0/contact"][:]
    expect((contact == 1).any() and (contact == 2).any(), "the ring was pressed, and held")
    if terminal.lockstep:
        check_momentum(folder, float(re.search(r"^  mass +([\d.]+) kg", printed, re.MULTILINE)[1]))


def check_momentum(folder, mass):
    """Along y during the press: what the stylus gives goes into the ring's motion, its tether and its damping."""
    tether, damping, end = 40.0, 2.0, 1000  # N/m, 1/s, steps
    with h5py.File(folder / "trace.h5") as trace:
        dt = np.diff(trace["/step/time"][:2])[0]
        pressed = np.count_nonzero(trace["/stylus/0/contact"][:end] == 1)
        force, place, velocity = (trace[name][:end, 1] for name in (
            "/stylus/0/force", "/step/body_position", "/step/body_velocity"))
    given = -dt * force.sum()
    taken = mass * velocity[-1] + dt * (tether * place + damping * mass * velocity).sum()
    expect(pressed > 500 and -given > 0.02 and abs(given - taken) < 0.01 * abs(given),
           f"the stylus gave {given:.5f} N s, the ring took {taken:.5f} N s")


def check_first_session(terminal, _):
    folder = pathlib.Path(terminal.folder) / "out/first"
    expect((folder / "run.csv").stat().st_size > 0, "run.csv is there")
    with h5py.File(folder / "trace.h5") as trace:
        contact = trace["/stylus/0/contact"][:]
    expect((contact == 1).any() and (contact == 2).any(), "the cube was pressed, and held")


def check_embedding(terminal, printed):
    """The impulse that the stylus gave is the momentum of the free object; a scene's trace can be replayed to the bit."""
    found = re.search(r"impulse (\S+) momentum (\S+) N s", printed)
    if not found:  # its C++ was left out
        return
    impulse, momentum = float(found[1]), float(found[2])
    expect(impulse < -1e-3 and abs(impulse - momentum) < 1e-6 * abs(impulse), f"build/embed: {found[0]}")
    scene = pathlib.Path(terminal.folder) / "turning.toml"
    turning = "angular_velocity = [1, 2, 3]\n[[stylus]]"
    scene.write_text(scene.with_name("scene.toml").read_text().replace("[[stylus]]", turning))
    replayed = terminal.run("build/scene turning.toml turning.h5 && "
                            "irdm-replay turning.h5 --from inputs --rate 10 --csv turning.csv")
    expect("500 steps" in replayed and "velocity 0 m/s, angular velocity 0 rad/s" in re.sub(r"\s+", " ", replayed),
           "build/scene: its trace is replayed to the bit")


def check_liver(_, printed):
    """In real time: the pace of the machine is not asked for."""
    expect(re.search(r"^session: .* sessions [1-9]", printed, re.MULTILINE), "irdm-bridge had a session, and ended")


def check_comparison(terminal, printed):
    expect("force" in printed and (pathlib.Path(terminal.folder) / "apart.png").stat().st_size > 0,
           "the runs are compared, and drawn")
