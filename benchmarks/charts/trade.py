"""Error against time for one field of every case, shared by `pressure` and `traction`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from cases import RADII, Case, cases, errors
from drawing import MDR_COLOR, panels, save, table
from machine import footer
from measure import medians
from methods import BARE, MethodRun, method_runs

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEADER = ("case", "method", "resolution", "code", "seconds", "largest error", "median error")
#: Errors below rounding error are drawn here.
FLOOR = 1e-17
SECONDS = 12.0
Measured = list[tuple[MethodRun, float, float, float]]


def measured(case: Case, quantity: str) -> Measured:
    """Every method with its time, its largest and its median error."""
    results = list(method_runs(case, quantity))
    seconds = medians({entry.name: entry.run for entry in results}, SECONDS)
    truth = case.reference_values(quantity)
    return [
        (
            entry,
            seconds[entry.name],
            *((0.0, 0.0) if entry.method == BARE else errors(entry.run(), truth, case.checked)),
        )
        for entry in results
    ]


def chart(quantity: str, single: str | None = None) -> None:
    """Measure, print and draw all cases; draw the case `single` also in a separate figure."""
    figure, axes = panels(2, 4, 3.1, 2.9)
    rows = []
    foot = footer("PyAbel", "openabel")
    for ax, case in zip(axes, cases(), strict=False):
        with np.errstate(all="ignore"):
            results = measured(case, quantity)
        rows += [
            (case.name, entry.method, entry.resolution, "MDR" if entry.is_mdr else "", *numbers)
            for entry, *numbers in results
        ]
        _draw(ax, case.name, results)
        if case.name == single:
            single_figure, (single_axes,) = panels(1, 1, 6.4, 3.6)
            _draw(single_axes, f"{quantity} of the {case.name} at {RADII.size} radii", results)
            single_axes.legend(*_legend(single_axes), loc="center left", bbox_to_anchor=(1.0, 0.5))
            save(single_figure, f"{quantity}_best", foot)
    axes[-1].axis("off")
    handles: dict[str, object] = {}
    for ax in axes[:-1]:
        handles |= dict(zip(*reversed(_legend(ax)), strict=True))
    axes[-1].legend(handles.values(), handles.keys(), loc="center", fontsize=6.5)
    figure.suptitle(f"{quantity} at {RADII.size} radii", fontsize=10)
    save(figure, quantity, foot)
    table(HEADER, rows, quantity)


def _draw(ax: Axes, title: str, results: Measured) -> None:
    lines: dict[str, list[tuple[float, float, float]]] = {}
    for entry, *numbers in results:
        lines.setdefault(entry.method, []).append(tuple(numbers))
    mdr = {entry.method for entry, *_ in results if entry.is_mdr}
    for method, points in lines.items():
        if method == BARE:
            ax.axvline(points[0][0], color="0.3", linestyle=":", label=BARE)
            continue
        seconds, largest, median = np.array(points).T
        color, marker, width = _style(method, is_mdr=method in mdr)
        style = "--" if "incl. plan" in method or "incl. table setup" in method else "-"
        ax.plot(
            seconds,
            np.maximum(largest, FLOOR),
            style,
            color=color,
            marker=marker,
            linewidth=width,
            label=method,
            zorder=3 if method in mdr else 2,
        )
        ax.plot(seconds, np.maximum(median, FLOOR), style, color=color, alpha=0.25, linewidth=width)
    ax.set(xscale="log", yscale="log", ylim=(FLOOR / 2, 3), title=title)
    ax.set_xlabel("CPU time [s]")
    if ax.get_subplotspec().is_first_col():
        ax.set_ylabel("relative error: maximum (dark), median (light)")


#: One colour per family, one marker per member.
_FAMILIES = {
    "scipy": ("#1f5fa8", "ov^"),
    "tanh-sinh": ("#2b8a3e", "s"),
    "PyAbel": ("#8a6d3b", "osv^<>"),
    "openAbel": ("#6f42c1", "odxP"),
}
_MEMBERS = (
    "scipy quad_vec, t² = x² − r²",
    "scipy quad_vec, x − max(r, b, c) ~ u²",
    "scipy quad, t² = x² − r²",
    "PyAbel two_point",
    "PyAbel three_point",
    "PyAbel hansenlaw",
    "PyAbel direct",
    "PyAbel basex",
    "PyAbel daun",
    "openAbel, order 2",
    "openAbel, order 5",
    "openAbel incl. plan, order 2",
    "openAbel incl. plan, order 5",
)


def _style(method: str, *, is_mdr: bool) -> tuple[str, str, float]:
    if is_mdr:
        return MDR_COLOR, "D", 2.0
    family = next(name for name in _FAMILIES if method.startswith(name))
    color, marks = _FAMILIES[family]
    members = [name for name in _MEMBERS if name.startswith(family)]
    return color, marks[members.index(method) % len(marks)] if members else marks[0], 1.0


def _legend(ax: Axes) -> tuple[list[object], list[str]]:
    handles, labels = ax.get_legend_handles_labels()
    return handles, labels
