#!/usr/bin/python3
"""Live runs as a user has them: real server and bridge, real time, a recorder, a connected viewer.

  bench/live.py [--bin build/release/bin] [--out out/bench/live] [--seconds 10] [--runs 1]
                [--dt 2 1 0.5] [--styluses 1 4] [--mode predict hold] [--busy 0 2] [--stop 0]

The paper's cube with all modes and the demonstration's script, again and again; more styluses play it on other faces.
One row a run: step and prediction of the server, round trip, missed deadlines, forces delayed and lost, how often the
safety filter dropped the force, peak force at the hand (bridge) and on the object (trace), impulse there. With several
runs a row of medians follows. Times in us, forces in N, impulses in N s.
"""
import argparse
import base64
import os
import pathlib
import re
import signal
import socket
import statistics
import struct
import subprocess
import sys
import threading
import time

import h5py
import numpy

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Workspace rotations of the styluses: the script presses from +y; from -x, +x and +z.
FACES = ["[1, 0, 0, 0]", "[0.7071067811865476, 0, 0, 0.7071067811865476]",
         "[0.7071067811865476, 0, 0, -0.7071067811865476]", "[0.7071067811865476, 0.7071067811865476, 0, 0]"]

RESET = 4  # the button that puts the object back


class Viewer(threading.Thread):
    """A browser's connection that reads all that comes (docs/viewer-protocol.md)."""

    def __init__(self, address):
        super().__init__(daemon=True)
        host, port = address.rsplit(":", 1)
        self.peer = socket.create_connection((host, int(port)))
        key = base64.b64encode(os.urandom(16)).decode()
        self.peer.sendall((f"GET /live HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\n"
                           f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                           "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        if b" 101 " not in self.peer.recv(4096):
            sys.exit("live: the server takes no viewer")
        self.send(0x2, b"IRVW" + struct.pack("<HHHH", 1, 16, 0, 0))

    def send(self, opcode, payload):
        self.peer.sendall(bytes([0x80 | opcode, 0x80 | len(payload), 0, 0, 0, 0]) + payload)

    def run(self):
        heard = time.monotonic()
        while self.peer.recv(1 << 16):
            if time.monotonic() - heard > 5:
                heard = time.monotonic()
                self.send(0xA, b"")  # a pong: it is still there


def stop_again_and_again(server, milliseconds):
    """Stops the process so long, once a second."""
    while server.poll() is None:
        time.sleep(1)
        server.send_signal(signal.SIGSTOP)
        time.sleep(milliseconds / 1000)
        server.send_signal(signal.SIGCONT)


def make_model(args, dt):
    model = args.out / f"cube-{dt:g}ms.h5"
    if not model.exists():
        text = (ROOT / "configs/models/paper-cube.toml").read_text()
        text = re.sub(r"(?m)^dt = .*$", f"dt = {dt / 1000:g}", text)
        config = model.with_suffix(".toml")
        config.write_text(text)
        subprocess.run([args.bin / "irdm-precompute", config, "-o", model], check=True, stdout=subprocess.DEVNULL)
    return model


def write_script(args):
    lines = (ROOT / "configs/scripts/demo.csv").read_text().splitlines()
    rows = [line.split(",") for line in lines if line[:1].isdigit()]
    period = float(rows[-1][0]) + 0.5
    header = next(line for line in lines if line.startswith("time"))
    path = args.out / "script.csv"
    with path.open("w") as file:
        print(header, file=file)
        for again in range(max(1, round(args.seconds / period))):
            for time_, *place, button in rows:
                if again and float(time_) < 0.1:
                    button = RESET
                print(f"{float(time_) + again * period:g}", *place, button, sep=",", file=file)
    return path.resolve()


def write_configs(args, dt, styluses, mode):
    scene = (ROOT / "configs/scenes/paper-cube.toml").read_text()
    scene = scene.replace("styluses = 1", f"styluses = {styluses}")
    scene = scene.replace('"paper-cube.h5"', f'"{make_model(args, dt).resolve()}"')
    (args.out / "scene.toml").write_text(scene)
    script = write_script(args)
    bridge = f'[bridge]\nmode = "{mode}"\n'
    for s in range(styluses):
        bridge += (f'[[device]]\ntype = "virtual"\nscript = "{script}"\n'
                   "hand = { mass = 0.12, damping = 2.0, stiffness = 300.0 }\n"
                   f"workspace = {{ rotation = {FACES[s]} }}\n")
    (args.out / "bridge.toml").write_text(bridge)


def number(pattern, text, default=float("nan")):
    found = re.search(pattern, text)
    return float(found.group(1)) if found else default


def run(args, dt, styluses, mode, busy):
    write_configs(args, dt, styluses, mode)
    trace = args.out / "trace.h5"
    trace.unlink(missing_ok=True)
    log = args.out / "server.log"
    loops = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(busy)]
    try:
        with log.open("w") as file:
            server = subprocess.Popen([args.bin / "irdm-server", args.out / "scene.toml", "--record", trace],
                                      stdout=file, stderr=subprocess.STDOUT)
        while True:
            text = log.read_text()
            address = re.search(r"(?m)^listening on (\d\S*)", text)
            page = re.search(r"(?m)^listening on http://([^/\s]+)", text)
            if address and page:
                break
            if server.poll() is not None:
                sys.exit(f"live: the server did not start: {text}")
            time.sleep(0.05)
        viewer = Viewer(page.group(1))
        viewer.start()
        if args.stop:
            threading.Thread(target=stop_again_and_again, args=(server, args.stop), daemon=True).start()
        bridge = subprocess.run([args.bin / "irdm-bridge", args.out / "bridge.toml", "--server", address.group(1),
                                 "--duration", str(args.seconds)], capture_output=True, text=True)
        server.terminate()
        server.wait()
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
    text = log.read_text()
    (args.out / "bridge.log").write_text(bridge.stdout + bridge.stderr)
    with h5py.File(trace) as file:
        forces = [numpy.linalg.norm(file[f"stylus/{s}/force"][:], axis=1) for s in range(styluses)]
    row = {
        "step p50": number(r"step time: p50 ([\d.]+)", text),
        "step p99": number(r"step time: p50 [\d.]+ us, p99 ([\d.]+)", text),
        "prediction p50": number(r"of which prediction: p50 ([\d.]+)", text),
        "prediction p99": number(r"of which prediction: p50 [\d.]+ us, p99 ([\d.]+)", text),
        "round trip p50": 1000 * number(r"round trip: p50 ([\d.]+)", bridge.stdout),
        "steps": number(r"(?m)^steps: (\d+)", text),
        "missed": number(r"missed deadlines: (\d+)", text),
        "delayed": number(r"came late, entered at their own step: (\d+)", text, 0),
        "lost": number(r"forces of bridges that were lost: (\d+)", text, 0),
        "unsolved": number(r"without a finite solution: (\d+)", text),
        "dropped": number(r"force dropped (\d+)", bridge.stdout),
        "peak hand": number(r"peak force: ([\d.]+)", bridge.stdout),
        "peak object": max(float(force.max()) for force in forces),
        "impulse hand": number(r"impulse ([\d.]+)", bridge.stdout),
        "impulse object": sum(float(force.sum()) for force in forces) * dt / 1000,
    }
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "out/bench/live")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--dt", type=float, nargs="+", default=[2.0, 1.0, 0.5], help="[ms]")
    parser.add_argument("--styluses", type=int, nargs="+", default=[1, 4])
    parser.add_argument("--mode", nargs="+", default=["predict"])
    parser.add_argument("--busy", type=int, nargs="+", default=[0, 2], help="busy loops beside it")
    parser.add_argument("--stop", type=float, default=0.0, help="the server is stopped for so long once a second [ms]")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    first = True
    for mode in args.mode:
        for dt in args.dt:
            for styluses in args.styluses:
                for busy in args.busy:
                    rows = []
                    for _ in range(args.runs):
                        row = run(args, dt, styluses, mode, busy)
                        rows.append(row)
                        if first:
                            print("| mode | dt | styluses | busy | " + " | ".join(row) + " |")
                            print("|" + " --- |" * (4 + len(row)))
                            first = False
                        print(f"| {mode} | {dt:g} | {styluses} | {busy} | " +
                              " | ".join(f"{value:.4g}" for value in row.values()) + " |", flush=True)
                    if args.runs > 1:
                        medians = [statistics.median(row[name] for row in rows) for name in rows[0]]
                        print(f"| *median* | {dt:g} | {styluses} | {busy} | " +
                              " | ".join(f"{value:.4g}" for value in medians) + " |", flush=True)


if __name__ == "__main__":
    main()
