"""Read the stored bank of loading histories; ``history_generate`` made it.

`cycles`: one record per contact and tangential control, with several given amplitudes at constant
normal load; expected values and condition numbers (with respect to the amplitude and to the normal
load) are lists of the same length. `inphase`: the normal load oscillates with the tangential
displacement; expected values are lists over the cycles. `paths`: depth and displacement at the
points of a path, and lists of expected values there. Numbers of the input mean their doubles
exactly; expected values are strings of 30 digits.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parent / "data"
#: Each is stored under its name behind "history_".
NAMES = ("cycles", "inphase", "paths")

Record = dict[str, Any]


@functools.cache
def load(name: str) -> tuple[Record, ...]:
    """All records of one of `NAMES`, in the stored order."""
    return tuple(json.loads((DATA / f"history_{name}.json").read_text(encoding="utf-8")))
