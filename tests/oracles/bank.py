"""Read the stored bank; see ``generate`` for how it was made and ``scenes`` for what it holds.

Numbers of the input are JSON numbers and mean their double exactly. Expected values are strings of
30 digits, or "inf". Condition numbers are relative, |d log(output)/d log(input)|.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parent / "data"
#: normal: d, F_N, a, ... of one load. pressure: p over radii. profile: f, f', g, g' over x.
#: tabulated: all of these for tables.
NAMES = ("normal", "pressure", "profile", "tabulated")

Record = dict[str, Any]


@functools.cache
def load(name: str) -> tuple[Record, ...]:
    """All records of one of `NAMES`, in the stored order."""
    return tuple(json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))
