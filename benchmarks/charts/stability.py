"""Where methods fail: our error against the distance from the limit, and the naive formula's.

`make chart-stability`. The curves are those of tests/stability, where ours are held against the
bound; here they are drawn, one picture a place. Errors below rounding are drawn on the lower
edge, and what is no number on the upper.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from drawing import OURS, panels, save, table
from machine import footer

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from tests.stability.curves import Curve

FOLDER = Path(__file__).parents[2] / "tests" / "stability"
LOWEST, HIGHEST = 1e-17, 1e2
#: The naive formula is given up where its error passes this.
DEAD = 1e-6
COLUMNS = 3
#: Letters above a panel.
WIDEST = 52
HEADER = ("place", "curve", "ours, largest", "naive, largest", "naive dies at", "naive formula")


def main() -> None:
    rows: list[tuple[object, ...]] = []
    for path in sorted(FOLDER.glob("test_*.py")):
        module = importlib.import_module(f"tests.stability.{path.stem}")
        if hasattr(module, "CURVES"):
            place = path.stem.removeprefix("test_")
            found = [make() for make in module.CURVES.values()]
            draw(place, found)
            rows += [row(place, each) for each in found]
    table(HEADER, rows, "stability")


def row(place: str, curve: Curve) -> tuple[object, ...]:
    dead = curve.distances[~(curve.naive <= DEAD)]
    at = float(dead.max()) if dead.size else "nowhere"
    worst = float(np.max(np.where(np.isfinite(curve.naive), curve.naive, np.inf)))
    name = curve.title.replace(",", ";")
    return place, name, float(curve.ours.max()), worst, at, curve.naive_formula.replace(",", ";")


def draw(place: str, curves: list[Curve]) -> None:
    """One picture: a panel for every curve."""
    columns = min(COLUMNS, len(curves))
    lines = -(-len(curves) // columns)
    figure, axes = panels(lines, columns, 3.1, 2.6)
    for axis, curve in zip(axes, curves, strict=False):
        panel(axis, curve)
    for axis in axes[len(curves) :]:
        axis.set_axis_off()
    for axis in axes[::columns]:
        axis.set_ylabel("relative error")
    axes[0].legend(fontsize=6.0)
    save(figure, f"stability_{place}", footer())


def panel(axis: Axes, curve: Curve) -> None:
    order = np.argsort(curve.distances)
    x = curve.distances[order]
    axis.loglog(x, drawn(curve.bound[order]), ":", color="0.5", label="bound")
    axis.loglog(x, drawn(curve.naive[order]), "s-", color="0.45", label="the naive formula")
    axis.loglog(x, drawn(curve.ours[order]), "o-", color=OURS, label="ours")
    axis.set_ylim(LOWEST / 2, 2 * HIGHEST)
    axis.set_title(
        f"{wrapped(curve.title)}\n{wrapped('naive: ' + curve.naive_formula)}", fontsize=7.0
    )
    axis.set_xlabel(curve.distance)


def drawn(errors: np.ndarray) -> np.ndarray:
    """Errors within the picture; what is no number at its upper edge."""
    return np.clip(np.where(np.isfinite(errors), errors, HIGHEST), LOWEST, HIGHEST)


def wrapped(title: str) -> str:
    """The title in two lines where it is long."""
    if len(title) <= WIDEST:
        return title
    cut = title.rfind(" ", 0, WIDEST)
    return f"{title[:cut]}\n{title[cut + 1 :]}"


if __name__ == "__main__":
    main()
