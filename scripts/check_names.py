#!/usr/bin/env python3
"""Checks that names in anonymous namespaces are unique within each target.

    scripts/check_names.py        two minutes on two processors

The sanitizer presets compile several sources of a target at once, and which ones depends on how many
there are: two equal names may meet when a file comes or goes. Here each target is compiled as one
source (syntax only, preset `names`), so that all of them meet.
"""
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "names"


def syntax_only(entry):
    words = shlex.split(entry["command"])
    output = words.index("-o")
    del words[output : output + 2]
    words.remove("-c")
    ended = subprocess.run(
        words + ["-fsyntax-only"], cwd=entry["directory"], capture_output=True, text=True
    )
    return ended.returncode, ended.stderr


def main():
    subprocess.run(["cmake", "--preset", "names"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    entries = json.loads((BUILD / "compile_commands.json").read_text())
    targets = [entry for entry in entries if "/Unity/" in entry["file"]]
    with ThreadPoolExecutor(os.cpu_count()) as workers:
        results = list(workers.map(syntax_only, targets))
    failed = [errors for status, errors in results if status != 0]
    print(*failed, sep="\n", end="")
    print(f"names: {len(targets)} targets, of which {len(failed)} cannot be compiled as one source")
    return 1 if failed or not targets else 0


if __name__ == "__main__":
    sys.exit(main())
