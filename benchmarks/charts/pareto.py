"""Check that no reference code is faster at an equal or smaller error: `make chart-pareto`.

Reads the results of `pressure` and `traction`. For every case and every error level from 1e-2 to
1e-13, the fastest method of MDR and the fastest reference code whose largest error is at most the
level are compared. A table is new to both: MDR's time includes resolving it, openAbel's its plan.
Otherwise openAbel's plans are made in advance, and PyAbel's matrices always. The exit status is 1
if a reference code is faster at any level.
"""

import sys
from itertools import groupby

from drawing import rows_of, table
from methods import BARE

LEVELS = [10.0**-decade for decade in range(2, 14)]
HEADER = (
    "quantity",
    "case",
    "largest error",
    "MDR [s]",
    "reference [s]",
    "ratio",
    "reference code",
)


def fastest(rows: list[dict[str, str]], level: float) -> tuple[float, str]:
    """Shortest time at a largest error of at most the level, and its method."""
    accurate = [
        (float(row["seconds"]), f"{row['method']}, {row['resolution']}")
        for row in rows
        if float(row["largest error"]) <= level
    ]
    return min(accurate, default=(float("inf"), "none"))


def compared(quantity: str) -> list[tuple[object, ...]]:
    """One row per case and level reached by any method."""
    rows_ = []
    for case, group in groupby(rows_of(quantity), key=lambda row: row["case"]):
        rows = [row for row in group if row["method"] != BARE]
        whole = [row for row in rows if "incl. table setup" in row["method"]]
        mdr = whole or [row for row in rows if row["code"] == "MDR"]
        others = [row for row in rows if row["code"] != "MDR"]
        if whole:
            others = [row for row in others if not row["method"].startswith("openAbel, ")]
        for level in LEVELS:
            own, _ = fastest(mdr, level)
            other, name = fastest(others, level)
            if min(own, other) < float("inf"):
                rows_.append((quantity, case, f"{level:.0e}", own, other, other / own, name))
    return rows_


if __name__ == "__main__":
    lines = [line for quantity in ("pressure", "traction") for line in compared(quantity)]
    table(HEADER, lines, "pareto")
    slower = [line for line in lines if line[4] < line[3]]
    print(f"{len(slower)} of {len(lines)} levels at which a reference code is faster")
    sys.exit(bool(slower))
