#!/usr/bin/python3
"""A bridge over a link that delays, in lockstep: every force reaches the hand some steps late. It speaks the protocol
(docs/protocol.md) itself, with the virtual hand of irdm-bridge, and of its safety filter the limit on how fast a force
may change, which also acts without delay: a stiff contact that begins asks for more than 300 N/s.

usage: delayed_bridge.py BRIDGE.toml --server HOST:PORT    IRDM_DELAY_STEPS: round trip in force steps, 0 unless given
"""

import csv
import os
import pathlib
import socket
import struct
import sys
import tomllib

import numpy as np

HEADER = struct.Struct("<4sHHIIQq")
HELLO, WELCOME, GOODBYE, SAMPLE, FORCE = 1, 2, 4, 5, 6
SERVO = 0.001  # s, of irdm-bridge
RISE, FALL = 300.0, 1200.0 - 20.0  # N/s; device_bridge/safety/guards.hpp, less the slew of the thermal limit


def checksum(data):
    """CRC32C."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


class Link:
    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.session, self.sequence = 0, 0

    def send(self, kind, payload):
        header = HEADER.pack(b"IRDM", 1, kind, len(payload), self.session, self.sequence, 0)
        self.socket.sendall(header + struct.pack("<I", checksum(header + payload)) + payload)
        self.sequence += 1

    def take(self, size):
        data = b""
        while len(data) < size:
            more = self.socket.recv(size - len(data))
            if not more:
                sys.exit("delayed bridge: the server hung up")
            data += more
        return data

    def receive(self, kind):
        head = self.take(36)
        got, length = struct.unpack_from("<HI", head, 6)
        payload = self.take(length)
        if got != kind:
            sys.exit(f"delayed bridge: a frame of type {got}, not {kind}")
        return payload


class Hand:
    """As VirtualHand of the bridge: exact for a constant force and a target that moves evenly."""

    def __init__(self, mass, damping, stiffness, start):
        a, square = damping / (2 * mass), stiffness / mass
        w = np.sqrt(square - a * a)  # of an underdamped hand
        c, s = np.exp(-a * SERVO) * np.cos(w * SERVO), np.exp(-a * SERVO) * np.sin(w * SERVO) / w
        self.step = np.array([[c + a * s, s], [-square * s, c - a * s]])
        self.stiffness = stiffness
        self.target, self.position, self.velocity = start, start.copy(), np.zeros(3)

    def advance(self, target, force):
        speed, sag = (target - self.target) / SERVO, force / self.stiffness
        y, u = self.step @ np.array([self.position - self.target - sag, self.velocity - speed])
        self.position, self.velocity, self.target = target + sag + y, speed + u, target


def limit_rate(shown, wanted):
    """The next force shown, SERVO later (device_bridge/safety/guards.cpp)."""
    way = wanted - shown
    length = np.linalg.norm(way)
    if length == 0:
        return wanted
    falling = np.clip(-shown @ way / length, 0, length)
    size = np.linalg.norm(shown)
    blend = np.clip(2 - 2 * np.linalg.norm(wanted) / size, 0, 1) if size else 0
    fall = RISE + blend * (FALL - RISE)
    travelled = fall * SERVO
    if travelled > falling:
        travelled = falling + RISE * (SERVO - falling / fall)
    return wanted if travelled >= length else shown + travelled / length * way


def read_script(path):
    rows = [row for row in csv.reader(open(path)) if row and not row[0].startswith("#")][1:]
    return np.array([[float(value) for value in row] for row in rows])  # time, x, y, z, button


def main():
    bridge = pathlib.Path(sys.argv[1])
    device = tomllib.loads(bridge.read_text())["device"][0]
    script = read_script(bridge.parent / device["script"])
    delay = int(os.environ.get("IRDM_DELAY_STEPS", "0"))

    def target(time):
        return np.array([np.interp(time, script[:, 0], script[:, axis]) for axis in (1, 2, 3)])

    def button(time):
        return int(script[max(0, np.searchsorted(script[:, 0], time + 1e-9, side="right") - 1), 4])

    link = Link(sys.argv[3])
    link.send(HELLO, struct.pack("<HHIHBB32s", 1, 1, 0, 1, 1, 0, b"delayed bridge"))
    welcome = link.receive(WELCOME)
    stylus, = struct.unpack_from("<H", welcome, 2)
    link.session, = struct.unpack_from("<I", welcome, 8)
    dt, = struct.unpack_from("<d", welcome, 16)
    parts = round(dt / SERVO)
    hand = Hand(**device["hand"], start=target(0.0))
    forces = [np.zeros(3)] * (delay + 1)  # those under way, and the one that has come
    shown = np.zeros(3)
    for k in range(round(script[-1, 0] / dt)):
        for part in range(parts):
            shown = limit_rate(shown, forces[0])
            hand.advance(target(k * dt + (part + 1) * SERVO), shown)
        time = (k + 1) * dt
        link.send(SAMPLE, struct.pack("<HHIQq3d4d", stylus, 0, button(time), k, round(1e9 * time),
                                      *hand.position, 1, 0, 0, 0))
        forces = forces[1:] + [np.array(struct.unpack_from("<3d", link.receive(FORCE), 32))]
    link.send(GOODBYE, struct.pack("<HH", 0, 0))
    link.receive(GOODBYE)


main()
