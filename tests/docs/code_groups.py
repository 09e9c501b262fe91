"""The indented lines of a Markdown page, in groups that blank lines separate."""

import re
from dataclasses import dataclass


@dataclass
class CodeGroup:
    number: int  # of its first line in the page
    lines: list
    before: str  # the paragraph before it

    @property
    def text(self):
        return "\n".join(self.lines)

    @property
    def language(self):
        first = self.lines[0]
        if re.match(r"(import|with) ", first):
            return "python"
        if first.startswith("["):
            return "toml"
        if re.match(r"\w+\(", first):
            return "cmake"
        return "lines"  # commands, or what they print


def code_groups(page, section=None):
    """All groups; with a section, those from the line with this text to the next heading."""
    inside = section is None
    group, paragraph, paragraph_ends = None, [], True
    for number, line in enumerate(page.splitlines(), 1):
        if section and line == section:
            inside = True
        elif section and line.startswith("#"):
            inside = False
        if inside and line.startswith("    "):
            group = group or CodeGroup(number, [], " ".join(paragraph))
            group.lines.append(line[4:])
            continue
        if group:
            yield group
            group, paragraph_ends = None, True
        if line and paragraph_ends:
            paragraph, paragraph_ends = [], False
        if line:
            paragraph.append(line)
        else:
            paragraph_ends = True
    if group:
        yield group
