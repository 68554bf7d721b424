"""Whether any peer is quicker than ours at an equal or smaller error: `make chart-pareto`.

It reads what `pressure` and `traction` measured. For every scene and every level of error from 1e-2
to 1e-13 the quickest of ours, and the quickest of the peers, whose largest error is no larger are
compared; a table counts from its points on. The exit status is 1 if a peer wins anywhere.
openAbel's plans of the grid and PyAbel's matrices are free for them here.
"""

import sys
from itertools import groupby

from drawing import rows_of, table
from methods import BARE

LEVELS = [10.0**-decade for decade in range(2, 14)]
HEADER = ("quantity", "scene", "largest error", "ours [s]", "best peer [s]", "ratio", "peer")


def quickest(rows: list[dict[str, str]], level: float) -> tuple[float, str]:
    """Least seconds among those whose largest error is at most the level, and by what."""
    good = [
        (float(row["seconds"]), f"{row['method']}, {row['resolution']}")
        for row in rows
        if float(row["largest error"]) <= level
    ]
    return min(good, default=(float("inf"), "none"))


def compared(quantity: str) -> list[tuple[object, ...]]:
    """One line for every scene and level that any method reaches."""
    found = []
    for scene, group in groupby(rows_of(quantity), key=lambda row: row["scene"]):
        rows = [row for row in group if row["method"] != BARE]
        whole = [row for row in rows if "from the points" in row["method"]]
        ours = whole or [row for row in rows if row["whose"] == "ours"]
        theirs = [row for row in rows if row["whose"] != "ours"]
        for level in LEVELS:
            own, _ = quickest(ours, level)
            other, name = quickest(theirs, level)
            if min(own, other) < float("inf"):
                found.append((quantity, scene, f"{level:.0e}", own, other, other / own, name))
    return found


if __name__ == "__main__":
    lines = [line for quantity in ("pressure", "traction") for line in compared(quantity)]
    table(HEADER, lines, "pareto")
    lost = [line for line in lines if line[4] < line[3]]
    print(f"{len(lost)} of {len(lines)} levels where a peer is quicker")
    sys.exit(bool(lost))
