"""Print performance ratios that do not depend on the machine: `make bench`.

Every ratio is measured within one run, alternating between both sides. The median of the rounds is
printed with its quartiles. With `--gate`, a few short rounds of each show whether an order of
magnitude is lost: the command fails if a ratio misses its bound by more than a factor of three.
Small queries are then measured in process, by processor time.
"""

from __future__ import annotations

import os
import sys

# Set before NumPy is loaded: BLAS threads would compete for the cores.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import beneath_ratio
import core_ratios
import history_ratio
import measure
import small_queries
import stress_wire_ratio
import wear_ratio
import wire_ratio


def main() -> None:
    header = ("what", "state", "ratio", "half lie in", "target", "medians and accuracy")
    rows_ = [
        *core_ratios.rows(),
        *beneath_ratio.rows(),
        *history_ratio.rows(),
        *wear_ratio.rows(),
        *wire_ratio.rows(),
        *stress_wire_ratio.rows(),
        *(small_queries.in_process() if measure.GATE else small_queries.rows()),
    ]
    lines = [
        (
            row.name,
            row.state,
            f"{row.ratio:.3g}",
            f"{row.low:.3g} .. {row.high:.3g}",
            row.target,
            row.detail,
        )
        for row in rows_
    ]
    widths = [max(map(len, column)) for column in zip(header, *lines, strict=True)]
    for line in (header, *lines):
        print("  ".join(map(str.ljust, line, widths)).rstrip())
    lost = [row.name for row in rows_ if row.is_lost]
    if measure.GATE and lost:
        sys.exit("\n".join(["An order of magnitude is lost:", *lost]))


if __name__ == "__main__":
    main()
