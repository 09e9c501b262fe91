"""What scripts/mutate.sh does; see there."""
import argparse
import fnmatch
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIST = ROOT / "tests" / "mutations.txt"
WORK = ROOT / "build" / "mutations"
SOURCE = WORK / "source"
BUILD = WORK / "build"
NEEDED = 0.95
LOG = WORK / "log.txt"


class ListError(Exception):
    """The list and the sources do not fit."""


@dataclass
class Mutation:
    name: str = ""
    file: str = ""
    before: str = ""
    after: str = ""
    tests: list = field(default_factory=list)  # (program, names of its tests)

    def check(self):
        if not (self.name and self.file and self.before and self.tests):
            raise ListError(f"{self.name or 'a block without a name'}: needs name, file, from and tests")
        path = ROOT / self.file
        count = path.read_text().count(self.before) if path.is_file() else 0
        if count != 1:
            raise ListError(f"{self.name}: its text occurs {count} times in {self.file}, not once")


def read_list():
    mutations = []
    keys = {"name": "name", "file": "file", "from": "before", "to": "after"}
    for block in LIST.read_text().split("\n\n"):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        mutation = Mutation()
        for line in lines:
            key, _, value = line.partition(" ")
            if key == "tests":
                program, _, names = value.strip().partition(" ")
                mutation.tests.append((program, names.strip()))
            elif key in keys:
                setattr(mutation, keys[key], value.strip())
            else:
                raise ListError(f"{mutation.name}: '{key}' is no word of the list")
        if lines:
            mutations.append(mutation)
    names = [mutation.name for mutation in mutations]
    for mutation in mutations:
        mutation.check()
        if names.count(mutation.name) > 1:
            raise ListError(f"{mutation.name}: the name is there twice")
    return mutations


def chosen(mutations, patterns):
    for pattern in patterns:
        if not any(fnmatch.fnmatch(mutation.name, pattern) for mutation in mutations):
            raise ListError(f"{pattern}: no such name in tests/mutations.txt")
    if not patterns:
        return mutations
    return [m for m in mutations if any(fnmatch.fnmatch(m.name, pattern) for pattern in patterns)]


def copy_sources():
    """All that git does not ignore; what has not changed keeps its time, so that little is built."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        cwd=ROOT, check=True, capture_output=True, text=True,
    ).stdout
    names = {name for name in listed.split("\0") if name and (ROOT / name).is_file()}
    for name in sorted(names):
        source, copy = ROOT / name, SOURCE / name
        if copy.is_file() and copy.read_bytes() == source.read_bytes():
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, copy)
    for copy in [path for path in SOURCE.rglob("*") if path.is_file()]:
        if str(copy.relative_to(SOURCE)) not in names:
            copy.unlink()


def quietly(command, limit=None):
    """The exit status; what it prints goes to the log. None: beyond the limit [s]."""
    with LOG.open("a") as log:
        print("$", *command, file=log, flush=True)
        try:
            return subprocess.run(command, cwd=SOURCE, stdout=log, stderr=log, timeout=limit).returncode
        except subprocess.TimeoutExpired:
            return None


def configure():
    command = ["cmake", "-S", str(SOURCE), "-B", str(BUILD), "-G", "Ninja",
               "-DCMAKE_BUILD_TYPE=Release",
               "-DIRDM_BUILD_BENCH=OFF", "-DIRDM_BUILD_PAGE=OFF", "-DIRDM_UNITY_TESTS=ON"]
    return quietly(command) == 0


def build(programs):
    return quietly(["ninja", "-C", str(BUILD)] + [f"bin/{program}" for program in programs]) == 0


def passes(program, names, limit):
    """Whether the tests pass in time; those that are left out count as passed."""
    left_out = 211
    command = [str(BUILD / "bin" / program), "--abort"]
    command += [names] if names else ["~[slow]~[exhaustive]"]
    return quietly(command, limit) in (0, left_out)


def run(mutation, limit):
    """killed, survived or does not build; and what saw it."""
    path = SOURCE / mutation.file
    whole = path.read_text()
    try:
        path.write_text(whole.replace(mutation.before, mutation.after))
        if not build(dict.fromkeys(program for program, _ in mutation.tests)):
            return "does not build", ""
        for program, names in mutation.tests:
            if not passes(program, names, limit):
                return "killed", program
        return "survived", ""
    finally:
        path.write_text(whole)


def check_unchanged(mutations, limit):
    """Tests that fail by themselves would kill everything."""
    tests = dict.fromkeys(test for mutation in mutations for test in mutation.tests)
    print(f"mutate: building {len({program for program, _ in tests})} test programs", flush=True)
    if not build(dict.fromkeys(program for program, _ in tests)):
        raise ListError(f"the sources as they are do not build: {LOG}")
    for program, names in tests:
        if not passes(program, names, limit):
            raise ListError(f"{program} {names} fails without any change: {LOG}")


def main():
    parser = argparse.ArgumentParser(prog="scripts/mutate.sh", description="Mutation run.")
    parser.add_argument("--limit", type=float, default=600, help="of a test program [s]")
    parser.add_argument("name", nargs="*", help="of the list; * for any letters")
    options = parser.parse_args()
    try:
        mutations = chosen(read_list(), options.name)
        WORK.mkdir(parents=True, exist_ok=True)
        LOG.write_text("")
        copy_sources()
        if not configure():
            raise ListError(f"cannot be configured: {LOG}")
        check_unchanged(mutations, options.limit)
    except ListError as error:
        print(f"mutate: error: {error}", file=sys.stderr)
        return 2
    outcomes = []
    for mutation in mutations:
        began = time.monotonic()
        outcome, by = run(mutation, options.limit)
        outcomes.append(outcome)
        by = f" by {by}" if by else ""
        print(f"{outcome}: {mutation.name}{by} ({time.monotonic() - began:.0f} s)", flush=True)
    killed = outcomes.count("killed")
    broken = outcomes.count("does not build")
    share = killed / max(1, len(outcomes) - broken)
    print(f"mutate: {killed} of {len(outcomes)} killed ({100 * share:.0f} %), "
          f"{outcomes.count('survived')} survived, {broken} do not build")
    return 0 if share >= NEEDED and broken == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
