"""Check that no reference code is faster at an equal or smaller error: `make chart-pareto`.

Reads the results of `pressure` and `traction`. For every case and every error level from 1e-2 to
1e-13, MDR and the fastest reference code whose largest error is at most the
level are compared, as a user pays for them: openAbel's time includes its plan for these radii,
MDR's time the fit of a table. PyAbel's matrices are made in advance. The exit status is 1 if a
reference code is faster at an error of 1e-9 or less.

Where arrays lie in memory changes the time of a process by a tenth, of openAbel by more. Methods
within a quarter of each other, and all others of the case that are no more than four times as slow,
are therefore measured again, in fresh processes, by the median.
"""

import json
import subprocess
import sys
from itertools import groupby
from statistics import median

from cases import cases
from drawing import rows_of, table
from measure import medians
from methods import BARE, method_runs

LEVELS = [10.0**-decade for decade in range(2, 14)]
PROMISED = 1e-9
CLOSE, FEW, PROCESSES, SECONDS = 1.25, 4.0, 9, 4.0
HEADER = (
    "quantity",
    "case",
    "largest error",
    "MDR [s]",
    "reference [s]",
    "ratio",
    "reference code",
)
Row = dict[str, str]


def name_of(row: Row) -> str:
    """Name of a method at one resolution."""
    return f"{row['method']}, {row['resolution']}"


def fastest(rows: list[Row], level: float) -> tuple[float, str]:
    """Shortest time at a largest error of at most the level, and its method."""
    accurate = [
        (float(row["seconds"]), name_of(row))
        for row in rows
        if float(row["largest error"]) <= level
    ]
    return min(accurate, default=(float("inf"), "none"))


def contenders(rows: list[Row]) -> tuple[list[Row], list[Row]]:
    """Methods of MDR and of the reference codes that are compared in one case."""
    whole = [row for row in rows if "incl. table setup" in row["method"]]
    without = BARE, "openAbel, order 2", "openAbel, order 5"
    others = [row for row in rows if not row["code"] and row["method"] not in without]
    return whole or [row for row in rows if row["code"] == "MDR"], others


def measure_again(quantity: str, case: str, rows: list[Row]) -> None:
    """Replace the times of all fast methods of a case in which two of them are close."""
    mdr, others = contenders(rows)
    times = [(fastest(mdr, level)[0], fastest(others, level)[0]) for level in LEVELS]
    slower = max((max(pair) for pair in times if max(pair) < CLOSE * min(pair)), default=0.0)
    names = {name_of(row) for row in mdr + others if float(row["seconds"]) < FEW * slower}
    if not names:
        return
    command = [sys.executable, __file__, quantity, case, *sorted(names)]
    found = [
        json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        for _ in range(PROCESSES)
    ]
    for row in rows:
        if name_of(row) in names:
            row["seconds"] = str(median(times[name_of(row)] for times in found))


def seconds_of(quantity: str, name: str, methods: list[str]) -> dict[str, float]:
    """Times of some methods in this process."""
    case = next(case for case in cases() if case.name == name)
    runs = {entry.name: entry.run for entry in method_runs(case, quantity) if entry.name in methods}
    return medians(runs, SECONDS)


def compared(quantity: str) -> list[tuple[object, ...]]:
    """One row per case and level reached by any method."""
    lines = []
    for case, group in groupby(rows_of(quantity), key=lambda row: row["case"]):
        rows = list(group)
        measure_again(quantity, case, rows)
        mdr, others = contenders(rows)
        for level in LEVELS:
            own, _ = fastest(mdr, level)
            other, name = fastest(others, level)
            if min(own, other) < float("inf"):
                lines.append((quantity, case, f"{level:.0e}", own, other, other / own, name))
    return lines


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(seconds_of(*sys.argv[1:3], sys.argv[3:])))
        sys.exit()
    lines = [line for quantity in ("pressure", "traction") for line in compared(quantity)]
    table(HEADER, lines, "pareto")
    slower = [line for line in lines if line[4] < line[3]]
    print(f"{len(slower)} of {len(lines)} levels at which a reference code is faster")
    sys.exit(any(float(str(line[2])) <= PROMISED for line in slower))
