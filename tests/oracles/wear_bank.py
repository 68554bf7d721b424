"""Read the stored bank of wear limits; ``wear_generate`` made it.

One record per contact and pair of held and oscillating quantity, with several amplitudes; expected
values and condition numbers are lists of the same length. `fields` are those of some amplitudes,
by index. Numbers of the input mean their doubles exactly; expected values are strings of 30 digits,
or "inf". Condition numbers are relative, None where they have no meaning.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parent / "data"

Record = dict[str, Any]


@functools.cache
def load() -> tuple[Record, ...]:
    """All records, in the stored order."""
    return tuple(json.loads((DATA / "wear_limit.json").read_text(encoding="utf-8")))
