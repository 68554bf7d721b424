"""Read the stored bank of partial slip; ``slip_generate`` made it.

`tangential`: one record per contact and tangential control, with several given values; expected
values and condition numbers are lists of the same length. `slip_fields`: one record per state,
with lists over its radii. Numbers of the input mean their doubles exactly; expected values are
strings of 30 digits, or "inf". Condition numbers are relative, None where they have no meaning.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parent / "data"
NAMES = ("tangential", "slip_fields")

Record = dict[str, Any]


@functools.cache
def load(name: str) -> tuple[Record, ...]:
    """All records of one of `NAMES`, in the stored order."""
    return tuple(json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))


def normal_load(record: Record) -> dict[str, float]:
    """The keyword that the normal query is asked with."""
    return {record["control"]: record["load"]}
