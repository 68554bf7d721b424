"""Stability charts: error of MDR and of a naive formula against the distance from a limit.

`make chart-stability`. The curves are those of tests/stability, which also assert the bounds. There
is one figure per limit. Errors below rounding are drawn at the lower edge of the axes, and results
that are not finite at the upper edge.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from drawing import MDR_COLOR, panels, save, table
from machine import footer

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from tests.stability.curves import Curve

FOLDER = Path(__file__).parents[2] / "tests" / "stability"
LOWEST, HIGHEST = 1e-17, 1e2
#: Error beyond which the naive formula is considered to fail.
FAILED = 1e-6
COLUMNS = 2
#: Longest title line in characters.
TITLE_WIDTH = 60
HEADER = ("limit", "curve", "MDR error", "naive error", "naive fails at", "naive formula")


def main() -> None:
    rows: list[tuple[object, ...]] = []
    for path in sorted(FOLDER.glob("test_*.py")):
        module = importlib.import_module(f"tests.stability.{path.stem}")
        if hasattr(module, "CURVES"):
            limit = path.stem.removeprefix("test_")
            computed = [make() for make in module.CURVES.values()]
            draw(limit, computed)
            rows += [row(limit, each) for each in computed]
    table(HEADER, rows, "stability")


def row(limit: str, curve: Curve) -> tuple[object, ...]:
    failed = curve.distances[~(curve.naive <= FAILED)]
    at = float(failed.max()) if failed.size else "nowhere"
    worst = float(np.max(np.where(np.isfinite(curve.naive), curve.naive, np.inf)))
    name = curve.title.replace(",", ";")
    return limit, name, float(curve.ours.max()), worst, at, curve.naive_formula.replace(",", ";")


def draw(limit: str, curves: list[Curve]) -> None:
    """Draw one figure with a panel for every curve."""
    columns = min(COLUMNS, len(curves))
    lines = -(-len(curves) // columns)
    figure, axes = panels(lines, columns, 2.6)
    for axis, curve in zip(axes, curves, strict=False):
        panel(axis, curve)
    for axis in axes[len(curves) :]:
        axis.set_axis_off()
    for axis in axes[::columns]:
        axis.set_ylabel("relative error")
    save(figure, f"stability_{limit}", footer(), axes[:1])


def panel(axis: Axes, curve: Curve) -> None:
    order = np.argsort(curve.distances)
    x = curve.distances[order]
    axis.loglog(x, drawn(curve.bound[order]), ":", color="0.5", label="bound")
    axis.loglog(x, drawn(curve.naive[order]), "s-", color="0.45", label="naive formula")
    axis.loglog(x, drawn(curve.ours[order]), "o-", color=MDR_COLOR, label="MDR")
    axis.set_ylim(LOWEST / 2, 2 * HIGHEST)
    axis.set_title(
        f"{wrapped(curve.title)}\n{wrapped('naive: ' + curve.naive_formula)}", fontsize=7.5
    )
    axis.set_xlabel(curve.distance)


def drawn(errors: np.ndarray) -> np.ndarray:
    """Errors clipped to the axes; non-finite ones at the upper edge."""
    return np.clip(np.where(np.isfinite(errors), errors, HIGHEST), LOWEST, HIGHEST)


def wrapped(title: str) -> str:
    """Break a long title into two lines."""
    if len(title) <= TITLE_WIDTH:
        return title
    cut = title.rfind(" ", 0, TITLE_WIDTH)
    return f"{title[:cut]}\n{title[cut + 1 :]}"


if __name__ == "__main__":
    main()
