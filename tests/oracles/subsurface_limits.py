"""Reference subsurface stresses towards limits without a closed form.

`python -m tests.oracles.subsurface_limits` writes `tests/stability/beneath.json`, which takes three
minutes on two cores.
"""

from __future__ import annotations

import json
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from mpmath import mp, mpf

from tests.oracles.subsurface_generate import WORK_DIGITS, shape_of, tensor

STORED = Path(__file__).parents[1] / "stability" / "beneath.json"
NU, FRICTION, COUNT = 0.3, 0.4, 30
# Name, title and axis of a curve, its distances, and for each distance: profile, stick radius, r
# and z.
CURVES: tuple[tuple[str, str, str, list[float], Any], ...] = (
    (
        "flat",
        "rounded punch, b → a, at that distance from the edge",
        "1 − b/a",
        np.geomspace(0.5, 1e-12, COUNT).tolist(),
        lambda gap: (
            {"kind": "rounded_punch", "flat_radius": 1 - gap, "rounding_radius": 2.0},
            None,
            1 + gap / 2,
            gap / 2,
        ),
    ),
    (
        "exponent",
        "power, r = 0.7 a, z = a/1000",
        "n",
        np.geomspace(0.05, 100, COUNT).tolist(),
        lambda n: ({"kind": "power", "coefficient": 0.3, "exponent": n}, 0.8, 0.7, 1e-3),
    ),
)


def records(curve: int) -> str:
    """Return one curve as JSON; the points lie in the plane y = 0, where r is exact."""
    mp.dps = WORK_DIGITS
    name, title, axis, distances, make = CURVES[curve]
    points = []
    for distance in distances:
        profile, c, r, z = make(distance)
        place = r, 0.0, z
        exact = tuple(mpf(float(one)) for one in place)
        stick = None if c is None else mpf(c)
        values = tensor(shape_of(profile), mpf(1), stick, mpf(FRICTION), mpf(NU), exact)
        points.append(
            {
                "profile": profile,
                "stick_radius": c,
                "place": [float(one) for one in place],
                "expected": [mp.nstr(value, 20) for value in values],
            }
        )
    result = {"name": name, "title": title, "distance": axis, "distances": distances}
    return json.dumps({**result, "points": points}, ensure_ascii=False)


def main() -> None:
    with ProcessPoolExecutor(2) as pool:
        lines = list(pool.map(records, range(len(CURVES)), chunksize=1))
    content = "[\n" + ",\n".join(lines) + "\n]\n"
    STORED.write_text(content, encoding="utf-8")


if __name__ == "__main__":
    main()
