"""Runs the commands of a page in a fresh folder, in their order, and compares what the page shows with what they print.

usage: run_page.py PAGE clone SOURCES BUILD OPTION     a clone, and the folder of its build
       run_page.py PAGE installed TREE OPTION          what was installed
  PAGE: a name of pages.py
  --quick: with smaller models; only the words are compared
  --numbers: with the models of the page; numbers are compared too
  --real-time: as --quick, with servers that are not in lockstep
"""

import os
import pathlib
import shutil
import sys
import tempfile

from code_groups import code_groups
from pages import PAGES
from shown_output import difference
from terminal import Terminal

PYTHON = "/usr/bin/python3 -B"


class Place:
    """Where a reader has pages, data and programs."""

    def __init__(self, kind, folders):
        folders = [pathlib.Path(folder).resolve() for folder in folders]
        if kind == "clone":
            self.pages = self.data = folders[0]
            self.programs, self.python = folders[1] / "bin", folders[1] / "python"
            self.tree = None
        else:
            self.tree = folders[0]
            self.pages, self.data = self.tree / "share/doc/irdm", self.tree / "share/irdm"
            self.programs, self.python = self.tree / "bin", self.tree / "lib/python3/dist-packages"

    @property
    def path(self):
        return f"{self.programs}:{os.environ['PATH']}"

    @property
    def environment(self):
        found = {"PATH": self.path, "PYTHONPATH": str(self.python), "PYTHONDONTWRITEBYTECODE": "1"}
        return found | ({"CMAKE_PREFIX_PATH": str(self.tree)} if self.tree else {})


class Reader:
    """Does what a page says, group by group."""

    def __init__(self, page, place, folder, numbers):
        self.page, self.place, self.folder, self.numbers = page, place, folder, numbers
        self.printed = ""  # by all commands
        self.last = ""  # by those of the last group
        self.seen = 0  # groups that were compared or run

    def prepare(self):
        """The folder looks like a clone, with what the page takes for granted."""
        for name in ("configs", "scripts", "examples"):
            shutil.copytree(self.place.data / name, self.folder / name, ignore=shutil.ignore_patterns("*.h5"))
        for file in [*self.folder.glob("configs/*/*.toml"), *self.folder.glob("examples/tutorial/*")]:
            file.write_text(self.shortened(file.read_text()))
        (self.folder / "build/release").mkdir(parents=True)
        (self.folder / "build/release/bin").symlink_to(self.place.programs)
        (self.folder / "build/release/python").symlink_to(self.place.python)
        for name, content in self.page.files.items():
            given = self.folder / content if "\n" not in content else None
            (self.folder / name).write_text(given.read_text() if given else content)

    def shortened(self, text):
        for old, new in self.page.quick.items() if not self.numbers else ():
            text = text.replace(old, new)
        return text

    def read(self, terminal):
        for command in self.page.first:
            terminal.run(command)
        text = self.shortened((self.place.pages / self.page.file).read_text())
        for group in code_groups(text, self.page.section):
            where = f"{self.page.file}:{group.number}: "
            if self.leaves_out(group):
                print(f"left {where}{group.lines[0]} ...", flush=True)
                continue
            for words, server in self.page.servers.items():
                if words in group.text:
                    terminal.run(server)
            try:
                self.take(terminal, group)
            except RuntimeError as error:
                raise RuntimeError(where + str(error)) from error
            self.seen += 1
            print(f"ok   {where}{group.lines[0]}{' ...' * (len(group.lines) > 1)}", flush=True)
        self.printed += terminal.end_server()

    def leaves_out(self, group):
        words = () if self.place.tree else self.page.installed
        words += self.page.left_out if group.language == "toml" else ()
        return any(word in group.text for word in words)

    def take(self, terminal, group):
        if group.language == "python":
            self.keep(terminal.run(f"{PYTHON} - <<'END'\n{self.page.python}{group.text}\nEND", beside=True))
        elif group.language in ("toml", "cmake"):
            self.find(terminal, group)
        elif self.is_command(group.lines[0]):
            self.keep("".join(self.command(terminal, line) for line in group.lines))
        else:
            wrong = difference(group.lines, self.last, self.numbers)
            if wrong:
                raise RuntimeError(wrong)

    def keep(self, printed):
        self.last = printed
        self.printed += printed

    def is_command(self, line):
        program = line.split()[0]
        return "/" in program or shutil.which(program, path=self.place.path) is not None

    def command(self, terminal, line):
        if any(words in line for words in self.page.left_out):
            print(f"left {line}", flush=True)
            return ""
        for written, mine in ({"/usr/share/irdm": str(self.folder)} | self.page.instead).items():
            line = line.replace(written, mine)
        return terminal.run(line)

    def find(self, terminal, group):
        """A part of a file that is there: its lines, in their order."""
        files = [pathlib.Path(terminal.folder) / word for word in group.before.split("`")[1::2]]
        files += self.folder.glob("examples/*/CMakeLists.txt") if group.language == "cmake" else []
        for file in files:
            rest = iter(file.read_text().splitlines()) if file.is_file() else iter(())
            if all(line in rest for line in group.lines if line):
                return
        raise RuntimeError(f"no file of {[str(file) for file in files]} has these lines")


def main():
    if len(sys.argv) < 5 or sys.argv[1] not in PAGES or sys.argv[-1] not in ("--quick", "--numbers", "--real-time"):
        sys.exit(__doc__)
    page, place, option = PAGES[sys.argv[1]], Place(sys.argv[2], sys.argv[3:-1]), sys.argv[-1]
    for program in page.needs:
        if not shutil.which(program):
            print(f"test left out: no {program}")
            return
    with tempfile.TemporaryDirectory(prefix="irdm-docs-") as name:
        folder = pathlib.Path(name)
        reader = Reader(page, place, folder, option == "--numbers")
        reader.prepare()
        try:
            with Terminal(folder, place.environment, option != "--real-time") as terminal:
                reader.read(terminal)
                page.check(terminal, reader.printed)
        except RuntimeError as error:
            sys.exit(f"FAIL {error}")
        print(f"run_page: {reader.seen} groups of {page.file}")
    sys.exit(0 if reader.seen else "FAIL: there was nothing to run")


main()
