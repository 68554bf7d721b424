"""Figures of a campaign, with their bounds."""

import sys
from dataclasses import dataclass

MEBIBYTE = 2**20


@dataclass(frozen=True)
class Row:
    """One line of the table."""

    what: str
    found: str
    bound: str
    right: bool
    detail: str = ""
    """What else was counted; it is not in the table."""


def say(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def table(rows: list[Row]) -> str:
    """Return the figures with their bounds, one to a line; missed bounds are marked."""
    heads = ("", "figure", "measured", "bound")
    cells = [("" if row.right else "!", row.what, row.found, row.bound) for row in rows]
    widths = [max(map(len, column)) for column in zip(heads, *cells, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in (heads, tuple("-" * width for width in widths), *cells)
    ]
    missed = sum(not row.right for row in rows)
    return "\n".join([*lines, f"{len(rows)} figures, {missed} beyond their bounds"])
