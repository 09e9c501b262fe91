#!/usr/bin/env python3
"""Checks that of the tests that were left out each may be, by tests/may_be_left_out.txt.

    scripts/check_left_out.py RESULTS.xml [--quick]    what `ctest --output-junit RESULTS.xml` wrote

--quick allows also what needs a package of scripts/packages.txt's group `all`: lines that begin with "quick: ".

Silent when all is well: ctest lists what it skipped, and its summary stays the last of CI's output.
"""
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

LIST = Path(__file__).resolve().parent.parent / "tests" / "may_be_left_out.txt"
SAID = re.compile(r"test left out: (.*)$", re.MULTILINE)


def allowed(quick):
    lines = [line for line in LIST.read_text().splitlines() if line and not line.startswith("#")]
    return [re.compile(line.removeprefix("quick: ")) for line in lines if quick or not line.startswith("quick: ")]


def left_out(results):
    """Each as "name: what it said"; also those that ctest did not run for a reason of its own.

    A test that ran may have left out a part of itself.
    """
    for case in ElementTree.parse(results).iter("testcase"):
        said = SAID.findall(case.findtext("system-out") or "")
        if not said and case.get("status") not in ("run", "fail"):
            said = ["it does not say why"]
        for line in said:
            yield f"{case.get('name')}: {line}"


def main():
    quick = "--quick" in sys.argv[2:]
    if len(sys.argv) != (3 if quick else 2):
        print(__doc__, file=sys.stderr)
        return 2
    patterns = allowed(quick)
    wrong = [test for test in left_out(sys.argv[1])
             if not any(pattern.search(test) for pattern in patterns)]
    for test in wrong:
        print(f"left out, but must run here: {test}")
    if wrong:
        print(f"error: {len(wrong)} tests did not run; install what they need (scripts/setup.sh)")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
