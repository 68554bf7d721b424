"""Style and output folder of the charts."""

from __future__ import annotations

import csv
import textwrap
from pathlib import Path

import matplotlib as mpl

mpl.use("svg")
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.transforms import Bbox

FOLDER = Path(__file__).parents[2] / "docs" / "charts"
STYLE = {
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 8.5,
    "figure.constrained_layout.use": True,
    "font.size": 7.5,
    "grid.alpha": 0.25,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "mdr",
}
mpl.rcParams.update(STYLE)

#: Colour of MDR on every chart, and of other lines.
MDR_COLOR = "#c1272d"
BLUE, GREEN, BROWN, VIOLET, GREY = "#1f5fa8", "#2b8a3e", "#8a6d3b", "#6f42c1", "0.35"
#: Width of every chart [inch]: 700 pixels, which the manual shows unscaled.
WIDTH = 7.3
#: Characters in a line of the footer.
_FOOT = 125


def panels(rows: int, columns: int, height: float) -> tuple[Figure, list[Axes]]:
    """A figure of rows x columns axes, each `height` inches high."""
    size = WIDTH, rows * height + 0.25
    figure, axes = plt.subplots(rows, columns, figsize=size, squeeze=False)
    return figure, list(axes.ravel())


def _name_lines(ax: Axes) -> None:
    """Write the name of each line beside one of its points, where it covers the least."""
    figure = ax.get_figure(root=True)
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw_without_rendering()
    named = [line for line in ax.get_lines() if not str(line.get_label()).startswith("_")]
    points = {line: ax.transData.transform(np.transpose(line.get_data())) for line in named}
    covered = np.concatenate([_along(each) for each in points.values()])
    boxes: list[Bbox] = []
    for line in named:
        label, color = str(line.get_label()), line.get_color()
        text = ax.annotate(label, (0, 0), (0, 0), "data", "offset points", color=color)
        found = []
        for point in np.transpose(line.get_data()):
            for ha, va, shift in _SIDES:
                text.set(ha=ha, va=va, position=shift)
                text.xy = tuple(point)
                # A browser's font may be wider.
                box = text.get_window_extent(renderer).expanded(_WIDER, 1.0).padded(_MARGIN)
                cost = 999 * sum(box.overlaps(other) for other in boxes) + np.hypot(*shift)
                cost += box.count_contains(covered)
                inside = ax.bbox.count_contains(box.corners()) == len(box.corners())
                found.append((not inside, cost, len(found), tuple(point), ha, va, shift, box))
        *_, text.xy, ha, va, shift, box = min(found)
        text.set(ha=ha, va=va, position=shift)
        boxes.append(box)


#: Width of a name in a browser, at most, and room around it [pixel].
_WIDER, _MARGIN = 1.2, 4
#: Alignment of a name to its point, and its distances [pt].
_SIDES = tuple(
    (ha, va, (x * distance, y * distance))
    for distance in (5.0, 12.0)
    for ha, va, x, y in (
        ("left", "center", 1.0, 0.0),
        ("right", "center", -1.0, 0.0),
        ("center", "bottom", 0.0, 1.0),
        ("center", "top", 0.0, -1.0),
        ("left", "bottom", 0.8, 0.8),
        ("left", "top", 0.8, -0.8),
        ("right", "bottom", -0.8, 0.8),
        ("right", "top", -0.8, -0.8),
    )
)


def _along(points: np.ndarray) -> np.ndarray:
    """Points close to each other on a polyline."""
    part = np.linspace(0, len(points) - 1, 40 * len(points))
    return np.stack([np.interp(part, range(len(points)), each) for each in points.T], axis=-1)


def save(figure: Figure, name: str, foot: str, named: Iterable[Axes] = ()) -> None:
    """Write docs/charts/NAME.svg with a footer line, and names at the lines of some axes."""
    figure.supxlabel(textwrap.fill(foot, _FOOT), fontsize=7.0, color="0.4", x=0.995, ha="right")
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            if axis.get_scale() == "log":
                axis.set_major_formatter(_power_of_ten)
    for ax in named:
        _name_lines(ax)
    FOLDER.mkdir(exist_ok=True)
    figure.savefig(FOLDER / f"{name}.svg", metadata={"Date": None})
    plt.close(figure)


def _power_of_ten(value: float, _position: object) -> str:
    """A power of ten in one size of type: exponents of Matplotlib have 7 pixels."""
    if value == 0:
        # Ticks beyond an axis may underflow.
        return ""
    return "10" + str(round(np.log10(value))).translate(_RAISED)


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


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


#: Relative errors that come with a result: `model_error_pressure` of the README's ball, a modulus,
#: and the `data_error` of examples/tip.csv under 1 µN (docs/gallery.md).
ERRORS = (
    ("model of a ball", 1.8e-4),
    ("modulus to 1 %", 1e-2),
    ("measured points", 9e-2),
)
#: Times [s]: a small request over HTTP (wire.csv), a frame of a screen, what a person notices.
TIMES = (("a request", 6e-4), ("a frame", 1 / 60), ("a person", 0.1))


def sufficient(ax: Axes) -> None:
    """Shade the errors below those of model and input, and mark times that are short enough."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    for name, error in ERRORS:
        ax.axhspan(low, error, color=GREEN, alpha=0.05, lw=0, zorder=0)
        ax.text(right, error, f"{name} ", fontsize=6, color=GREEN, ha="right", va="top")
    for name, time in TIMES:
        if left < time < right:
            ax.axvline(time, color="0.6", lw=0.7, ls=":", zorder=0)
            ax.text(time, low, f" {name}", fontsize=6, color="0.4", rotation=90, va="bottom")
    ax.set(xlim=(left, right), ylim=(low, high))


def rows_of(name: str) -> list[dict[str, str]]:
    """Rows of docs/charts/NAME.csv."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def _short(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
