"""Compares the lines that a page shows with those that were printed: each is there, in this order, with the same words
and with numbers within a tolerance. There may be others between them."""

import re

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TOLERANCE = 0.02  # relative
ANY = re.compile(r"(:|about )$")  # before a number: a port, a time of a machine


def difference(shown, printed, numbers=True):
    """What is wrong, in words; empty: the page is right. Without numbers only the words count."""
    rest = iter(printed.splitlines())
    for line in shown:
        closest = None
        for candidate in rest:
            if without_numbers(candidate) != without_numbers(line):
                continue
            closest = closest or candidate
            if not numbers or near(line, candidate):
                break
        else:
            got = f"'{closest.strip()}' was printed" if closest else "nothing like it was printed"
            return f"the page shows '{line.strip()}', {got}"
    return ""


def without_numbers(line):
    return NUMBER.sub("#", " ".join(line.split()))


def near(shown, printed):
    pairs = zip(NUMBER.finditer(shown), NUMBER.findall(printed))
    return all(abs(float(wanted[0]) - float(got)) <= TOLERANCE * abs(float(wanted[0]))
               for wanted, got in pairs if not ANY.search(shown[: wanted.start()]))
