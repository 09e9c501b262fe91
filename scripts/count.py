#!/usr/bin/env python3
"""Counts what docs/contributing.md sets limits for.

    scripts/count.py

Product files and lines, classes with many data members or private methods, words and long lines of the documents,
inputs of the fuzzers. It only counts; nothing fails.
"""
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRODUCT = ("common", "simulation", "scene", "trace", "viewer", "server", "precompute", "replay", "device_bridge", "ros_bridge")
MOST_MEMBERS = 15
MOST_METHODS = 12
LONGEST_LINE = 120


def tracked(*patterns):
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--", *patterns], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    return [ROOT / name for name in listed.split("\0") if name]


def bodies(text):
    """Name and text of each class or struct that is defined at any depth, and whether its comment says why it is large."""
    for match in re.finditer(r"\b(?:class|struct) (\w+)[^;{()]*\{", text):
        comment = re.search(r"(?:^ *//[^\n]*\n)*(?:^ *template[^\n]*\n)?[^\n]*\Z", text[: match.start()], re.M)
        depth, end = 1, match.end()
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        yield match.group(1), text[match.end() : end - 1], "/// Large: " in comment.group()


def outer(body):
    """The body without what stands in inner braces and comments."""
    body = re.sub(r"//[^\n]*", "", body)
    while (shorter := re.sub(r"\{[^{}]*\}", "{}", body)) != body and "{" in re.sub(r"\{\}", "", body):
        body = shorter
    return body


def counted(body):
    """Data members and private methods of a class with members like this_."""
    body = outer(body)
    members = len(re.findall(r"\b\w+_(?:\[[^\]]*\])?\s*(?:=[^;]*|\{\})?;", body))
    private = body.split("private:", 1)[1] if "private:" in body else ""
    methods = len(re.findall(r"\b(?!operator)\w+\([^;{}]*\)\s*(?:const)?\s*(?:noexcept)?\s*(?:;|\{\})", private))
    return members, methods


def main():
    sources = tracked(*(f"{folder}/*.[ch]pp" for folder in PRODUCT))
    lines = {path: path.read_text().count("\n") for path in sources}
    print(f"product: {len(sources)} C++ files, {sum(lines.values())} lines,",
          f"{sum(1 for n in lines.values() if n < 50)} files below 50 lines")
    for path in sources:
        if path.suffix != ".hpp":
            continue
        for name, body, argued in bodies(path.read_text()):
            members, methods = counted(body)
            if members > MOST_MEMBERS or methods > MOST_METHODS:
                print(f"  {path.relative_to(ROOT)}: {name}: {members} data members, {methods} private methods"
                      + ("" if argued else "; its comment does not say why"))
    pages = tracked("docs/*.md")
    words = {path: len(path.read_text().split()) for path in [*pages, ROOT / "README.md", ROOT / "CHANGELOG.md"]}
    print(f"documents: docs {sum(words[page] for page in pages)} words in {len(pages)} pages,",
          f"README {words[ROOT / 'README.md']}, CHANGELOG {words[ROOT / 'CHANGELOG.md']}")
    for path in words:
        long = sum(1 for line in path.read_text().splitlines() if len(line) > LONGEST_LINE and not line.startswith("|"))
        if long:
            print(f"  {path.relative_to(ROOT)}: {long} lines above {LONGEST_LINE} characters")
    print(f"fuzzers: {len(tracked('tests/fuzz/seeds/*', 'tests/fuzz/corpus/*'))} inputs")


if __name__ == "__main__":
    main()
