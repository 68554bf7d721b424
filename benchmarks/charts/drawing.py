"""Style and output folder of the charts."""

from __future__ import annotations

import csv
from pathlib import Path

import matplotlib as mpl

mpl.use("svg")
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FOLDER = Path(__file__).parents[2] / "docs" / "charts"
STYLE = {
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 9.0,
    "figure.constrained_layout.use": True,
    "font.size": 8.0,
    "grid.alpha": 0.25,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "mdr",
}
mpl.rcParams.update(STYLE)

#: Colour of MDR on every chart.
MDR_COLOR = "#c1272d"


def panels(rows: int, columns: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """A figure of rows x columns axes, each `width` x `height` inches."""
    figure, axes = plt.subplots(
        rows, columns, figsize=(columns * width, rows * height + 0.25), squeeze=False
    )
    return figure, list(axes.ravel())


def save(figure: Figure, name: str, foot: str) -> None:
    """Write docs/charts/NAME.svg with a footer line."""
    figure.supxlabel(foot, fontsize=6.0, color="0.4", x=0.995, ha="right")
    FOLDER.mkdir(exist_ok=True)
    figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)


def table(header: Sequence[str], rows: Iterable[Sequence[object]], name: str | None = None) -> None:
    """Print the rows and write them to docs/charts/NAME.csv."""
    lines = [[_short(value) for value in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(header, *lines, strict=True)]
    for line in (header, *lines):
        print("  ".join(map(str.ljust, line, widths)).rstrip())
    if name is not None:
        FOLDER.mkdir(exist_ok=True)
        with (FOLDER / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([header, *lines])


def rows_of(name: str) -> list[dict[str, str]]:
    """Rows of docs/charts/NAME.csv."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _short(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
