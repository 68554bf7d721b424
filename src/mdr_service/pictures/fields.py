"""Fields over the radius."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from mdr_service.convert import Array
from mdr_service.pictures import canvas
from mdr_service.solve import Stress

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_NAMES: Final = {
    "pressure": "pressure $p$",
    "shear_stress": r"shear stress $\tau$",
    "slip": "slip $s$",
    "normal_displacement": "normal displacement $u_z$",
    "foundation_load": "foundation load $q$",
    "foundation_shear": "foundation shear $q_x$",
}
_MAY_BE_INFINITE: Final = frozenset({"pressure", "shear_stress"})
# Lines that can still be told apart.
_MOST_LINES: Final = 8
_SYMBOLS: Final = {
    "indentation_depth": "$d$",
    "normal_force": "$F_N$",
    "contact_radius": "$a$",
    "tangential_force": "$F_x$",
    "tangential_displacement": "$u_x$",
    "stick_radius": "$c$",
}
# A curve that runs to infinity is cut above what it exceeds on the rest of the axis.
_REST, _HEADROOM = 0.03, 1.15
# Marks closer than this share of the axis have one label.
_CLOSE: Final = 0.025


def stress(solved: Stress) -> bytes:
    """Return the fields over the radius, a panel for each, with a, b and c marked."""
    order = np.argsort(solved.radius, kind="stable")
    radius = solved.radius[order]
    loads = len(next(iter(solved.fields.values())))
    shown = range(min(loads, _MOST_LINES))
    with canvas.drawing():
        figure, panels = canvas.panels(len(solved.fields))
        for axes, (name, field) in zip(panels, solved.fields.items(), strict=True):
            values = field[: len(shown), order]
            for index in shown:
                axes.plot(radius, _finite(values[index]), label=_label(solved, index))
            axes.set_ylabel(_NAMES[name])
            axes.set_ylim(*_limits(radius, values, cut=name in _MAY_BE_INFINITE))
            _mark_infinities(axes, radius, values)
            _mark_radii(axes, solved, shown)
        panels[0].set_xlim(*_span(radius))
        _label_radii(panels[0], solved, shown)
        panels[-1].set_xlabel(f"radius $r$   ({canvas.UNITS})")
        if loads > 1:
            title = None if len(shown) == loads else f"the first {len(shown)} of {loads} loads"
            panels[0].legend(title=title, loc="upper right")
        return canvas.written(figure)


def _finite(values: Array) -> Array:
    """Return the values with gaps where they are infinite."""
    return np.where(np.isfinite(values), values, np.nan)


def _label(solved: Stress, index: int) -> str:
    """Return what was given for this load, where it is not the same for all."""
    return ", ".join(
        f"{_SYMBOLS[name]} = {values[index]:.4g}" for name, values in solved.varied.items()
    )


def _span(radius: Array) -> tuple[float, float]:
    return float(radius[0]), float(max(radius[-1], radius[0] + abs(radius[0]) * 1e-6 + 1e-300))


def _limits(radius: Array, values: Array, *, cut: bool) -> tuple[float, float]:
    """Return the ends of the axis: all values, or where `cut`, all but the way to infinity."""
    finite = np.where(np.isfinite(values), values, 0.0)
    weights = np.broadcast_to(np.gradient(radius) if radius.size > 1 else 1.0, values.shape)
    high, low = float(finite.max(initial=0.0)), float(finite.min(initial=0.0))
    if cut:
        high = _end(finite.clip(min=0).ravel(), weights.ravel())
        low = -_end((-finite).clip(min=0).ravel(), weights.ravel())
    margin = 0.05 * (high - low) or 1.0
    return low - margin * (low < 0), high + margin * ((high > 0) | (low == 0))


def _end(values: Array, weights: Array) -> float:
    order = np.argsort(values)
    share = np.cumsum(weights[order])
    usual = values[order][np.searchsorted(share, (1 - _REST) * share[-1]).clip(max=order.size - 1)]
    largest = float(values[order[-1]])
    return largest if largest <= 2 * usual or usual == 0 else float(_HEADROOM * usual)


def _mark_infinities(axes: "Axes", radius: Array, values: Array) -> None:
    for r in radius[np.isinf(values).any(axis=0)]:
        above = bool((values[:, radius == r] == np.inf).any())
        axes.annotate(
            "∞",
            (r, 1.0 if above else 0.0),
            xycoords=("data", "axes fraction"),
            xytext=(8, -9 if above else 3),
            textcoords="offset points",
        )


def _radii(solved: Stress, index: int) -> list[tuple[float, str]]:
    """Return the radii of one load that mean something, with their symbols."""
    found = [(float(b), "b") for b in solved.contact.profile.breaks[:_MOST_LINES]]
    found.append((_one(solved.contact.contact_radius, index), "a"))
    fronts = solved.fronts[index if len(solved.fronts) > 1 else 0]
    if fronts.size <= _MOST_LINES:
        found += [(c, "c") for c in fronts.tolist()]
    return [(r, symbol) for r, symbol in found if r > 0]


def _one(values: Array, index: int) -> float:
    flat = np.ravel(values)
    return float(flat[index if flat.size > 1 else 0])


def _mark_radii(axes: "Axes", solved: Stress, shown: Sequence[int]) -> None:
    for index in shown:
        for r, symbol in _radii(solved, index):
            color = "0.4" if symbol == "b" or len(shown) == 1 else f"C{index}"
            axes.axvline(r, color=color, linestyle=":", linewidth=0.9, zorder=1)


def _label_radii(axes: "Axes", solved: Stress, shown: Sequence[int]) -> None:
    low, high = axes.get_xlim()
    marks = sorted({mark for index in shown for mark in _radii(solved, index)})
    groups: list[list[tuple[float, str]]] = []
    for r, symbol in marks:
        if not low <= r <= high:
            continue
        if groups and r - groups[-1][-1][0] < _CLOSE * (high - low):
            groups[-1].append((r, symbol))
        else:
            groups.append([(r, symbol)])
    for group in groups:
        symbols = ", ".join(dict.fromkeys(f"${symbol}$" for _, symbol in group))
        middle = (group[0][0] + group[-1][0]) / 2
        axes.annotate(
            symbols,
            (middle, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="center",
        )
