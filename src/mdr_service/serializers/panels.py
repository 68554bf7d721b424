"""Panels of a picture: which arrays of a result are drawn over which, and their labels."""

import re
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdr_service.schemas import answers
from mdr_service.schemas.contacts import Axes
from mdr_service.schemas.quantities import described, heading

Array = NDArray[np.float64]
# Maximum number of loads drawn; of more, an evenly spaced selection is drawn.
_DRAWN: Final = 6
LINE: Final = 30
"""Fewer points than this are marks without a line."""
FRAME: Final = 35
"""Height of what surrounds the panels [mm]."""

# Label and dimension of each quantity.
_QUANTITIES: Final = {
    name: (heading(meaning), dimension)
    for model in vars(answers).values()
    if isinstance(model, type) and issubclass(model, answers.Answer)
    for name, field in model.model_fields.items()
    for meaning, dimension in [described(field.description)]
    if dimension
}
# Quantities that share a panel.
_SHARED: Final = {"initial_profile": "profile", "limiting_profile": "profile"}


class Units(NamedTuple):
    """Names of the units of a request."""

    length: str
    force: str
    pressure: str


class DrawnCurve(NamedTuple):
    """Points (x, y), and the name of their load.

    A reference is dashed, and measured points are marks, however many they are.
    """

    x: Array
    y: Array
    name: str = ""
    is_reference: bool = False
    is_measured: bool = False


class Panel(NamedTuple):
    """Curves of the quantity `y` over the quantity `x`."""

    x: str
    y: str
    curves: list[DrawnCurve]


class Map(NamedTuple):
    """Values [z][x] of a stress."""

    name: str
    at_x: Array
    at_z: Array
    values: Array
    x: str = "x"
    y: str = "z"


def panels_of(
    query: Any, result: Mapping[str, Any], units: Units | None
) -> tuple[str, list[Panel | Map]]:
    """Return the title and the panels of a picture.

    These are fields over the radius or along a line beneath the surface, maps of stresses in a
    plane under the first load, or forces over displacements.
    """
    if query.axes.is_measured:
        return "", _fitted(query.axes, result)
    if "x" not in result and "radius" not in result:
        return _over_loads(query.axes, result, units)
    control, loads = _varied(query, result)
    if "radius" in result:
        return _over_positions("radius", control, loads, result, units)
    if result["x"].size == 1 or result["z"].size == 1:
        axis = "x" if result["z"].size == 1 else "z"
        return _over_positions(axis, control, loads, result, units)
    x, z, maps = np.argsort(result["x"]), np.argsort(result["z"]), list[Panel | Map]()
    for name, field in result.items():
        if np.ndim(field) == 3:
            maps.append(Map(name, result["x"][x], result["z"][z], field[0][np.ix_(z, x)]))
    title = f"{_name(control, loads[0], units)} (1 of {len(loads)} loads)" if control else ""
    return title, maps


def _over_positions(
    x: str, control: str, loads: Sequence[float], result: Mapping[str, Any], units: Units | None
) -> tuple[str, list[Panel | Map]]:
    """Return a panel for each field, with a curve for each load."""
    order = np.argsort(result[x], kind="stable")
    at, panels = np.asarray(result[x])[order], dict[str, Panel]()
    title, chosen = _selection(len(loads))
    # A reference follows the curves of the loads.
    for y in sorted(result, key="initial_profile".__eq__):
        field = result[y]
        if np.ndim(field) < 2 and y != "initial_profile":
            continue
        rows = np.reshape(field, (-1, at.size))[:, order]
        if y == "initial_profile":
            curves = [DrawnCurve(at, rows[0], "initial", is_reference=True)]
        elif len(rows) > 1 and (rows == rows[0]).all():
            curves = [DrawnCurve(at, rows[0], "all loads", is_reference=True)]
        else:
            curves = [DrawnCurve(at, rows[i], _name(control, loads[i], units)) for i in chosen]
        name = _SHARED.get(y, y)
        panels.setdefault(name, Panel(x, name, [])).curves.extend(curves)
    return title, list(panels.values())


def _over_loads(
    axes: Axes, result: Mapping[str, Any], units: Units | None
) -> tuple[str, list[Panel | Map]]:
    """Return curves over the loads, with a curve for each value that several entries share."""
    at, control = np.asarray(result[axes.x], dtype=float), ""
    parts, values = [np.arange(at.size) if axes.in_order else np.argsort(at)], np.zeros(1)
    if axes.curves:
        unique, group = np.unique(result[axes.curves], return_inverse=True)
        if 1 < unique.size <= at.size / 2:
            control, values = axes.curves, unique
            parts = [parts[0][group[parts[0]] == i] for i in range(unique.size)]
    title, chosen = _selection(len(parts))
    named = [(parts[i], _name(control, values[i], units)) for i in chosen]
    panels = list[Panel | Map]()
    for y in axes.y:
        of_all = np.asarray(result[y])
        curves = [DrawnCurve(at[part], of_all[part], name) for part, name in named]
        panels.append(Panel(axes.x, y, curves))
    return title, panels


def _fitted(axes: Axes, result: Mapping[str, Any]) -> list[Panel | Map]:
    """Return the panels of a measured curve with the fitted one, and of its residuals."""
    order = slice(None) if axes.in_order else np.argsort(result[axes.x])
    at, fit, residual = (np.asarray(result[name])[order] for name in (axes.x, *axes.y))
    measured = DrawnCurve(at, fit + residual, "measured", is_measured=True)
    fitted, left = DrawnCurve(at, fit, "fitted"), DrawnCurve(at, residual, is_measured=True)
    return [Panel(axes.x, axes.y[0], [measured, fitted]), Panel(axes.x, axes.y[1], [left])]


def _selection(count: int) -> tuple[str, list[int]]:
    """Return a title, if some are left out, and the indices of the loads that are drawn."""
    chosen = np.unique(np.linspace(0, count - 1, min(count, _DRAWN)).astype(int)).tolist()
    return (f"{_DRAWN} of {count} loads" if count > _DRAWN else ""), chosen


def _varied(query: Any, result: Mapping[str, Any]) -> tuple[str, list[float]]:
    """Return name and values of the load that distinguishes curves: it has the most values."""
    if query.axes.x == "cycles":
        return "cycles", result["cycles"]
    lists = [(each.control, each.value) for each in query.controls.values() if each.count > 1]
    name, values = max(lists, key=lambda each: len(set(each[1])), default=("", [0.0]))
    return (name, values) if len(set(values)) > 1 else ("", [0.0])


def _name(control: str, value: float, units: Units | None) -> str:
    """Return the name of a load, with its unit if units are given."""
    if not control:
        return ""
    mantissa, _, exponent = f"{value:.4g}".partition("e")
    if exponent and abs(int(exponent)) > 6:
        number = f"{mantissa}·10$^{{{int(exponent)}}}$"
    else:
        number = np.format_float_positional(float(f"{value:.4g}"), trim="-")
    return f"{control.replace('_', ' ')} = {number} {_unit(control, units)}".strip()


def label(name: str, units: Units | None, width: int) -> str:
    """Return the words of a quantity in lines of a width, and below its unit if units are given."""
    unit = _unit(name, units)
    words = textwrap.fill(_QUANTITIES[name][0], width)
    return f"{words}\n({unit})" if unit else words


def _unit(name: str, units: Units | None) -> str:
    """Return the unit of a quantity, if units are given."""
    if units is None:
        return ""
    text = _QUANTITIES[name][1].replace("*", " ").replace("^3", "³").replace("1", "")
    return re.sub(r"[a-z]+", lambda found: str(getattr(units, found[0], found[0])), text)
