"""The worn shape over the radius, in the end or over the cycles."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mdr_core.wear.evolving import WearEvolution
from mdr_core.wear.limit import LimitingWear
from mdr_service.convert import Array
from mdr_service.pictures import canvas
from mdr_service.worn import Worn, few, grid, limit_of, profile

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HEIGHT: Final = 4.0
# Lines that can still be told apart.
_MOST_LINES: Final = 6
# Points of a curve that looks smooth, besides its edges.
_POINTS: Final = 300
# A pressure that runs to infinity is cut above what it exceeds at so many of the radii.
_SHOWN, _HEADROOM = 97.0, 1.3

_Mark = tuple[float, str, str]


def wear(solved: Worn[LimitingWear]) -> bytes:
    """Return the first and the limiting profile over the radius, with c and the wear radius."""
    worn = few(solved.result, _MOST_LINES)
    radius = worn.grid(_POINTS + _edges(worn))
    loads = worn.wear_radius.size
    shapes = np.reshape(worn.limiting_profile(radius), (loads, -1))
    ends = np.isfinite(np.ravel(worn.wear_radius))
    with canvas.drawing():
        figure, (axes,) = canvas.panels(1, _HEIGHT)
        first = worn.initial_profile(radius)
        axes.plot(radius, first, "--", color="0.5", label="before")
        names = _names(worn)
        marks: list[_Mark] = []
        for index, (name, shape) in enumerate(zip(names, shapes, strict=True)):
            color = f"C{index}"
            label = name if ends[index] else f"{name}: no end"
            axes.plot(radius, np.where(np.isfinite(shape), shape, np.nan), color=color, label=label)
            if ends[index]:
                marks += _marks(worn, index, color)
        _finish(axes, radius, marks)
        axes.set_ylabel("profile $f$")
        asked = solved.result.wear_radius.size
        title = None if loads == asked else f"the first {loads} of {asked} loads"
        axes.legend(title=title, loc="lower right")
        return canvas.written(figure)


def evolution(solved: Worn[WearEvolution]) -> bytes:
    """Return the profiles and pressures over the cycles, and the limiting shape if there is one."""
    worn = solved.result
    size = worn.cycles.size
    shown = np.unique(np.linspace(0, size - 1, min(size, _MOST_LINES)).round().astype(int))
    radius = grid(worn, _POINTS + len(profile(worn).breaks))
    with canvas.drawing():
        figure, (above, below) = canvas.panels(2, 3.2)
        above.plot(radius, profile(worn).f(radius), "--", color="0.5", label="before")
        shapes, pressures = worn.profile(radius), worn.pressure(radius)
        for index in shown:
            label = f"$N$ = {worn.cycles[index]:.4g}"
            above.plot(radius, shapes[index], label=label)
            below.plot(radius, np.where(np.isfinite(pressures[index]), pressures[index], np.nan))
        marks = _draw_limit(above, worn, radius)
        _cut(below, pressures[shown])
        _finish(above, radius, marks)
        above.set_ylabel("profile $f$")
        below.set_ylabel("pressure $p$")
        below.set_xlabel(above.get_xlabel())
        above.set_xlabel("")
        title = None if shown.size == size else f"{shown.size} of {size} numbers of cycles"
        above.legend(title=title, loc="lower right")
        return canvas.written(figure)


def _edges(worn: LimitingWear) -> int:
    """Return at how many radii the grid must have a point."""
    return 3 * worn.wear_radius.size + len(worn.first.normal.profile.breaks)


def _names(worn: LimitingWear) -> list[str]:
    """Return what tells the limits apart: their loads and amplitudes, where these differ."""
    if worn.wear_radius.size == 1:
        return ["in the limit"]
    symbols = {
        "indentation_depth": "$d$",
        "normal_force": "$F_N$",
        "tangential_displacement": "$u_x$",
        "tangential_force": "$F_x$",
    }
    given = {
        worn.first.normal.control: getattr(worn.first.normal, worn.first.normal.control),
        worn.amplitude: getattr(worn.first, worn.amplitude),
    }
    varied = {symbols[name]: np.ravel(v) for name, v in given.items() if np.size(v) > 1}
    return [
        ", ".join(f"{symbol} = {values[index]:.4g}" for symbol, values in varied.items())
        for index in range(worn.wear_radius.size)
    ]


def _draw_limit(axes: "Axes", worn: WearEvolution, radius: Array) -> list[_Mark]:
    """Draw what the wear tends to; return its marks, or of the course where there is none."""
    limit = limit_of(worn)
    if limit is None or not np.isfinite(limit.wear_radius).all():
        return [(float(worn.stick_radius[-1]), "$c$", "0.4")]
    axes.plot(radius, np.ravel(limit.limiting_profile(radius)), ":", color="k", label="limit")
    return _marks(limit, 0, "0.4")


def _marks(worn: LimitingWear, index: int, color: str) -> list[_Mark]:
    """Return c and the wear radius of one load, where they are two."""
    c, end = (float(np.ravel(r)[index]) for r in (worn.stick_radius, worn.wear_radius))
    return [(c, "$c$", color), (end, r"$\tilde{a}$", color)][: 1 + (end > c)]


def _cut(axes: "Axes", pressures: Array) -> None:
    """End the axis below a narrow peak."""
    finite = np.where(np.isfinite(pressures), pressures, 0.0)
    usual = float(max(np.percentile(line, _SHOWN) for line in finite))
    if usual > 0:
        axes.set_ylim(0.0, min(_HEADROOM * usual, 1.05 * float(finite.max())))


def _finish(axes: "Axes", radius: Array, marks: Sequence[_Mark]) -> None:
    """Mark what has a meaning, and end the picture where the grid does."""
    for r, symbol, color in marks:
        axes.axvline(r, color=color, linestyle=":", linewidth=0.9, zorder=1)
        axes.annotate(
            symbol,
            (r, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
            color=color,
        )
    axes.set_xlim(0.0, float(radius[-1]))
    axes.set_xlabel(f"radius $r$   ({canvas.UNITS})")
