#!/usr/bin/env python3
"""Checks that of the tests that were left out each may be, by tests/may_be_left_out.txt.

    scripts/check_left_out.py RESULTS.xml      what `ctest --output-junit RESULTS.xml` wrote

Silent when all is well: ctest lists what it skipped, and its summary stays the last of CI's output.
"""
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

LIST = Path(__file__).resolve().parent.parent / "tests" / "may_be_left_out.txt"
REASON = re.compile(r"^test left out: (.*)$", re.MULTILINE)


def allowed():
    lines = LIST.read_text().splitlines()
    return [re.compile(line) for line in lines if line and not line.startswith("#")]


def left_out(results):
    """Each as "name: reason"; also those that ctest did not run for a reason of its own."""
    for case in ElementTree.parse(results).iter("testcase"):
        if case.get("status") not in ("run", "fail"):
            said = REASON.search(case.findtext("system-out") or "")
            yield f"{case.get('name')}: {said.group(1) if said else 'it does not say why'}"


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    patterns = allowed()
    wrong = [test for test in left_out(sys.argv[1])
             if not any(pattern.search(test) for pattern in patterns)]
    for test in wrong:
        print(f"left out, but must run here: {test}")
    if wrong:
        print(f"error: {len(wrong)} tests did not run; install what they need (scripts/setup.sh)")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
