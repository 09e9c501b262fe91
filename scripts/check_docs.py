#!/usr/bin/env python3
"""Whether pages and programs agree: links and their anchors lead somewhere, and the commands that pages show name files
of this repository that exist and options that the programs have. Fails with a line for each that is wrong.

    scripts/check_docs.py PROGRAMS    folder of the built programs, such as build/release/bin
"""

import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = re.compile(r"(?:^|\s|/)(irdm-(?:precompute|server|bridge|replay|ros-bridge|play))\s(.*)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)")
TEMPLATE = ROOT / "scripts/reproduce/page.md"  # of a page in docs
OWN_FOLDERS = ("configs/", "scripts/", "examples/", "benchmark/")


def pages():
    # A copy without git, or without its history, has pages, too.
    git = ["git", "ls-files", "*.md"] if shutil.which("git") else ["true"]
    listed = subprocess.run(git, cwd=ROOT, capture_output=True, text=True, check=False)
    names = listed.stdout.split() or [str(path.relative_to(ROOT)) for path in ROOT.glob("**/*.md")
                                      if not {"build", "out", "node_modules"} & set(path.parts)]
    return [ROOT / name for name in names]


@cache
def anchors(page):
    """As GitHub makes them of headings."""
    found = set()
    for line in page.read_text(encoding="utf-8").splitlines():
        heading = re.match(r"#+ (.*)", line)
        if heading:
            text = re.sub(r"[`*\[\]]|\([^)]*\.md[^)]*\)", "", heading[1]).lower()
            found.add(re.sub(r"[^\w\- ]", "", text).strip().replace(" ", "-"))
    return found


@cache
def options_of(program, command):
    """What --help lists; None: there is no such program or command here."""
    words = [str(program), *([command] if command else []), "--help"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    return frozenset(OPTION.findall(done.stdout)) if done.returncode == 0 else None


@cache
def commands_of(program):
    done = subprocess.run([str(program), "--help"], capture_output=True, text=True, check=False)
    _, _, rest = done.stdout.partition("Subcommands:")
    return frozenset(re.findall(r"^  ([a-z-]+) ", rest, re.MULTILINE))


def link_faults(page, line):
    folder = ROOT / "docs" if page == TEMPLATE else page.parent
    for target in LINK.findall(re.sub(r"`[^`]*`", "`", line)):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = (folder / name).resolve() if name else page
        if not file.exists():
            yield f"the link {target} leads nowhere"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            yield f"the link {target} leads to no heading"


def command_faults(programs, line):
    code = line.split("  #")[0]
    for name in re.findall(r"(?<![\w/.-])[\w./-]+", code):
        if name.startswith(OWN_FOLDERS) and not name.endswith((".h5", "/")) and not (ROOT / name).exists():
            yield f"{name} does not exist"
    found = PROGRAM.search(code)
    if not found:
        return
    program, rest = programs / found[1], found[2]
    if found[1] == "irdm-play":
        program = ROOT / "scripts" / "irdm-play"
    if not program.is_file():
        return
    words = rest.split()
    commands = [word for word in words[:1] for word in word.split("|") if word in commands_of(program)]
    for command in commands or [""]:
        known = options_of(program, command)
        for option in OPTION.findall(rest):
            if known is None or option not in known:
                yield f"{' '.join([found[1], command]).strip()} has no option {option}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    programs = Path(sys.argv[1]).resolve()
    if not (programs / "irdm-server").is_file():
        sys.exit(f"check_docs: {programs} has no programs; build them, or name another folder")
    faults = []
    commands = 0
    for page in pages():
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            found = list(link_faults(page, line))
            if line.startswith("    "):
                commands += bool(PROGRAM.search(line))
                found += command_faults(programs, line)
            faults += [f"{page.relative_to(ROOT)}:{number}: {fault}" for fault in found]
    for fault in faults:
        print(fault)
    print(f"check_docs: {commands} commands, {len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
