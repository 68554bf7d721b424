"""Error against time for one field of every scene: what `pressure` and `traction` share."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from drawing import OURS, panels, save, table
from machine import footer
from measure import medians
from methods import BARE, Way, ways
from scenes import RADII, Scene, errors, scenes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEADER = ("scene", "method", "resolution", "whose", "seconds", "largest error", "median error")
#: Errors below a double's are drawn here.
FLOOR = 1e-17
SECONDS = 12.0
Found = list[tuple[Way, float, float, float]]


def measured(scene: Scene, quantity: str) -> Found:
    """Every way with its seconds, its largest and its median error."""
    found = list(ways(scene, quantity))
    seconds = medians({way.name: way.run for way in found}, SECONDS)
    truth = scene.truth(quantity)
    return [
        (
            way,
            seconds[way.name],
            *((0.0, 0.0) if way.method == BARE else errors(way.run(), truth, scene.checked)),
        )
        for way in found
    ]


def chart(quantity: str, single: str | None = None) -> None:
    """Measure, print and draw all scenes; `single` is drawn once more by itself."""
    figure, axes = panels(2, 4, 3.1, 2.9)
    rows = []
    foot = footer("PyAbel", "openabel")
    for ax, scene in zip(axes, scenes(), strict=False):
        with np.errstate(all="ignore"):
            found = measured(scene, quantity)
        rows += [
            (scene.name, way.method, way.resolution, "ours" if way.ours else "", *numbers)
            for way, *numbers in found
        ]
        _draw(ax, scene.name, found)
        if scene.name == single:
            alone, (own,) = panels(1, 1, 6.4, 3.6)
            _draw(own, f"{quantity} of the {scene.name} at {RADII.size} radii", found)
            own.legend(*_legend(own), loc="center left", bbox_to_anchor=(1.0, 0.5))
            save(alone, f"{quantity}_best", foot)
    axes[-1].axis("off")
    handles: dict[str, object] = {}
    for ax in axes[:-1]:
        handles |= dict(zip(*reversed(_legend(ax)), strict=True))
    axes[-1].legend(handles.values(), handles.keys(), loc="center", fontsize=6.5)
    figure.suptitle(f"{quantity} at {RADII.size} radii", fontsize=10)
    save(figure, quantity, foot)
    table(HEADER, rows, quantity)


def _draw(ax: Axes, title: str, found: Found) -> None:
    lines: dict[str, list[tuple[float, float, float]]] = {}
    for way, *numbers in found:
        lines.setdefault(way.method, []).append(tuple(numbers))
    ours = {way.method for way, *_ in found if way.ours}
    for method, points in lines.items():
        if method == BARE:
            ax.axvline(points[0][0], color="0.3", linestyle=":", label=BARE)
            continue
        seconds, largest, median = np.array(points).T
        color, marker, width = _look(method, ours=method in ours)
        style = "--" if "with its plan" in method or "from the points" in method else "-"
        ax.plot(
            seconds,
            np.maximum(largest, FLOOR),
            style,
            color=color,
            marker=marker,
            linewidth=width,
            label=method,
            zorder=3 if method in ours else 2,
        )
        ax.plot(seconds, np.maximum(median, FLOOR), style, color=color, alpha=0.25, linewidth=width)
    ax.set(xscale="log", yscale="log", ylim=(FLOOR / 2, 3), title=title)
    ax.set_xlabel("processor seconds")
    if ax.get_subplotspec().is_first_col():
        ax.set_ylabel("relative error: largest (dark), median (pale)")


#: One colour for a family, one mark for a member.
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
    "openAbel with its plan, order 2",
    "openAbel with its plan, order 5",
)


def _look(method: str, *, ours: bool) -> tuple[str, str, float]:
    if ours:
        return OURS, "D", 2.0
    family = next(name for name in _FAMILIES if method.startswith(name))
    color, marks = _FAMILIES[family]
    members = [name for name in _MEMBERS if name.startswith(family)]
    return color, marks[members.index(method) % len(marks)] if members else marks[0], 1.0


def _legend(ax: Axes) -> tuple[list[object], list[str]]:
    handles, labels = ax.get_legend_handles_labels()
    return handles, labels
