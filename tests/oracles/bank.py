"""Banks of stored reference cases; `cases` selects them and the `generate` modules compute them.

Inputs are JSON numbers and denote exact doubles. Expected values are strings of 30 digits, or
"inf". Condition numbers are relative, |d log(output)/d log(input)|, and None where undefined. Lists
of prescribed and expected values have equal length.

- `normal`: d, F_N, a, ... of one load.
- `pressure`: p at given radii.
- `profile`: f, f', g, g' at given x.
- `tangential`: one record per contact and tangential control.
- `slip_fields`: one record per state, at given radii.
- `history_cycles`: one record per contact and tangential control, constant normal load.
- `history_inphase`: the normal load oscillates in phase with the tangential displacement; expected
  values are lists over the cycles.
- `history_paths`: depth and displacement at the points of a load path.
- `subsurface`: stress tensor over E* of one contact in partial slip, at given points.
- `wear_limit`: one record per contact and pair of constant and oscillating quantity; `fields` are
  indexed by amplitude.
"""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

DATA = Path(__file__).parent / "data"
NAMES = tuple(sorted(path.stem for path in DATA.glob("*.json")))

Record = dict[str, Any]


@functools.cache
def load(name: str) -> tuple[Record, ...]:
    """Return all records of a bank in `NAMES`, in the stored order."""
    return tuple(json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))
