"""Banks of stored reference cases; `scenes` chooses them, and the `generate` modules make them.

Numbers of the input are JSON numbers and mean their double exactly. Expected values are strings of
30 digits, or "inf". Condition numbers are relative, |d log(output)/d log(input)|, and None if they
have no meaning. Lists of given and expected values have the same length.

`normal`: d, F_N, a, ... of one load. `pressure`: p over radii. `profile`: f, f', g, g' over x.
`tabulated`: all of these for tables. `tangential`: one record per contact and tangential control.
`slip_fields`: one record per state, over its radii. `history_cycles`: one record per contact and
tangential control at constant normal load. `history_inphase`: the normal load oscillates with the
tangential displacement; expected values are lists over the cycles. `history_paths`: depth and
displacement at the points of a path. `subsurface`: the stress tensor over E* of one contact in
partial slip, over its points. `wear_limit`: one record per contact and pair of held and
oscillating quantity; `fields` are those of some amplitudes, by index.
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
    """Return all records of one of `NAMES`, in the stored order."""
    return tuple(json.loads((DATA / f"{name}.json").read_text(encoding="utf-8")))
