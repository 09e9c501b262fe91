"""Looks at the page of `irdm-replay compare --html` as another reader than ours: prints how many figures it has, and on
stderr what is wrong with it."""

import html.parser
import re
import sys
import xml.etree.ElementTree as tree

VOID = {"meta"}
page = open(sys.argv[1], encoding="utf-8").read()


class Tags(html.parser.HTMLParser):
    open_tags = []

    def handle_starttag(self, tag, attrs):
        if tag not in VOID:
            self.open_tags.append(tag)
        for name, value in attrs:
            if name in ("src", "href") or "url(" in (value or ""):
                print("needs", value, file=sys.stderr)
        if tag in ("script", "link"):
            print("has a", tag, file=sys.stderr)

    def handle_endtag(self, tag):
        if self.open_tags.pop() != tag:
            print("does not match:", tag, file=sys.stderr)


tags = Tags()
tags.feed(page)
if tags.open_tags:
    print("open at the end:", tags.open_tags, file=sys.stderr)
figures = [tree.fromstring(svg) for svg in re.findall(r"<svg.*?</svg>", page, re.DOTALL)]
for figure in figures:
    labels = [text.text for text in figure.iter("text")]
    numbers = [label for label in labels if re.fullmatch(r"-?[0-9.]+(e[-+][0-9]+)?", label)]
    with_unit = [label for label in labels if re.search(r"\(.+\)$", label)]
    if len(numbers) < 6 or len(with_unit) < 2 or not list(figure.iter("polyline")):
        print("a figure lacks something:", labels, file=sys.stderr)
print(len(figures), "figures")
