#!/usr/bin/env python3
"""Checks that the sources of each folder include only what the folder may depend on.

    scripts/check_includes.py

The rules are those of docs/architecture.md: RULES says which other folders each product folder may include; the
physics (PURE) includes no header of threads, clocks, sockets, files or logs.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RULES = {
    "common": set(),
    "simulation": {"common"},
    "scene": {"common", "simulation"},
    "trace": {"common", "simulation"},
    "viewer": {"common", "simulation", "scene"},
    "server": {"common", "simulation", "scene", "trace", "viewer"},
    "precompute": {"common"},
    "replay": {"common", "simulation", "scene", "trace", "viewer", "precompute"},
    "device_bridge": {"common"},
    "c_interface": {"common", "simulation", "scene", "device_bridge"},
    "python": {"common", "simulation", "scene", "device_bridge"},
    "ros_bridge": {"common", "simulation", "viewer", "device_bridge"},
}
PURE = {"simulation"}
IMPURE = re.compile(
    r"<(atomic|chrono|condition_variable|filesystem|fstream|future|iostream|mutex|semaphore|thread|boost/asio|"
    r"boost/beast|hdf5|H5|spdlog|sys/|unistd|pthread|netinet|openssl)|"
    r"\"common/(hdf5|wire|process|program|config|blackbox|realtime/(?!no_denormals))"
)
INCLUDE = re.compile(r"^\s*#\s*include\s+([<\"][^>\"]+)[>\"]", re.MULTILINE)


def faults(folder):
    for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
        for included in INCLUDE.findall(path.read_text()):
            name = included[1:].split("/")[0]
            where = f"{path.relative_to(ROOT)}: includes {included[1:]}: "
            if included[0] == '"' and name != folder and name not in RULES[folder]:
                yield where + f"{folder} may include {', '.join(sorted(RULES[folder] | {folder}))} only"
            if folder in PURE and IMPURE.match(included):
                yield where + f"{folder} knows no thread, clock, socket, file or log"


def main():
    found = [fault for folder in RULES for fault in faults(folder)]
    for fault in found:
        print(fault, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
