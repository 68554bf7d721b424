"""Panels of a picture: which arrays of a result are drawn over which, and their labels."""

import re
from collections.abc import Mapping
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mdr_service.schemas import answers

Array = NDArray[np.float64]
NAMED: Final = 6
"""More curves than this have a colour scale in place of names."""
LINE: Final = 30
"""Fewer points than this are marks without a line."""

_LABELS: Final = {
    "indentation_depth": "indentation depth $d$",
    "normal_force": "normal force $F_N$",
    "contact_radius": "contact radius $a$",
    "tangential_displacement": "tangential displacement $u_x$",
    "tangential_force": "tangential force $F_x$",
    "step": r"load $\mathrm{step}$",
    "stick_radius": "stick radius $c$",
    "wear_radius": r"outer radius of wear $\tilde{a}$",
    "worn_volume": "worn volume $V$",
    "cycles": "number of cycles $N$",
    "radius": "radius $r$",
    "pressure": "pressure $p$",
    "shear_stress": r"shear stress $\tau$",
    "slip": "slip $s$",
    "normal_displacement": "normal displacement $u_z$",
    "foundation_load": "foundation load $q$",
    "foundation_shear": "foundation shear $q_x$",
    "initial_profile": "profile $f$",
    "limiting_profile": "profile $f$",
    "profile": "profile $f$",
    "worn_depth": "worn depth $f-f_0$",
    "x": "coordinate $x$",
    "z": "depth $z$",
    "von_mises": r"von Mises stress $\sigma_v$",
    "maximum_shear": r"maximum shear stress $\tau_{max}$",
    "mean_stress": r"mean stress $\sigma_m$",
    **{f"principal_{i}": rf"principal stress $\sigma_{i}$" for i in (1, 2, 3)},
    **{f"stress_{i}": rf"normal stress $\sigma_{{{i}}}$" for i in ("xx", "yy", "zz")},
    **{f"stress_{i}": rf"shear stress $\tau_{{{i}}}$" for i in ("xy", "xz", "yz")},
}
_DIMENSIONS: Final = {
    name: str(field.json_schema_extra["x-dimension"])
    for model in vars(answers).values()
    if isinstance(model, type) and issubclass(model, answers.Answer)
    for name, field in model.model_fields.items()
    if isinstance(field.json_schema_extra, dict)
}
# Abscissa and ordinates of a result without positions, and the member that separates its curves:
# the first of which the result has all.
_OVER_LOADS: Final = (
    ("cycles", ("worn_volume", "contact_radius"), None),
    ("stick_radius", ("worn_volume", "wear_radius"), None),
    ("tangential_displacement", ("tangential_force",), "normal_force"),
    ("indentation_depth", ("normal_force",), None),
)

# Accuracy of the place of the largest stress, as a share of the contact radius.
_ACCURACY: Final = 1e-3


class Units(NamedTuple):
    """Names of the units of a request."""

    length: str
    force: str
    pressure: str


class Curve(NamedTuple):
    """Points (x, y), with name and value of their load; a reference has no value."""

    x: Array
    y: Array
    name: str = ""
    load: float | None = None


class Panel(NamedTuple):
    """Curves over the quantity `x`, and the load that tells them apart if they have no names."""

    x: str
    y: str
    curves: list[Curve]
    load: str | None = None


class Map(NamedTuple):
    """Values [z][x] of a stress, place (x, z) of the largest of the body, and name of the load."""

    name: str
    at_x: Array
    at_z: Array
    values: Array
    peak: tuple[float, float] | None
    load: str
    x: str = "x"
    y: str = "z"


def panels_of(query: Any, result: Mapping[str, Any], units: Units | None) -> list[Panel | Map]:
    """Return the panels of a picture.

    These are fields over the radius or along a line beneath the surface, maps of stresses in a
    plane under the first load, or forces over displacements.
    """
    if "radius" in result:
        return _over_positions("radius", query, result, units)
    if "x" not in result:
        return _over_loads(result, units)
    if result["x"].size == 1 or result["z"].size == 1:
        return _over_positions("x" if result["z"].size == 1 else "z", query, result, units)
    x, z, maps = np.argsort(result["x"]), np.argsort(result["z"]), list[Panel | Map]()
    (first,) = _names({name: values[:1] for name, values in _varied(query).items()}, units)
    load = f"{first} (1 of {query.loads} loads)" if first else ""
    for name, field in result.items():
        if np.ndim(field) == 3:
            peak = result.get("largest", {}).get(name)
            in_plane = peak and abs(peak["y"][0] - query.y) < _ACCURACY * np.ptp(result["x"])
            place = (peak["x"][0], peak["z"][0]) if in_plane else None
            values = field[0][np.ix_(z, x)]
            maps.append(Map(name, result["x"][x], result["z"][z], values, place, load))
    return maps


def _over_positions(
    x: str, query: Any, result: Mapping[str, Any], units: Units | None
) -> list[Panel | Map]:
    """Return a panel for each field, with a curve for each load."""
    loads = {"cycles": result["cycles"]} if "cycles" in result else _varied(query)
    names = _names(loads, units)
    load = max(loads, key=lambda name: len(set(loads[name])), default=None)
    order = np.argsort(result[x], kind="stable")
    at, panels = np.asarray(result[x])[order], dict[str, Panel]()
    # A reference follows the curves of the loads.
    for y in sorted(result, key="initial_profile".__eq__):
        field = result[y]
        if np.ndim(field) < 2 and y != "initial_profile":
            continue
        rows = np.reshape(field, (-1, at.size))[:, order]
        if y == "initial_profile":
            curves = [Curve(at, rows[0], "initial")]
        elif len(rows) > 1 and (rows == rows[0]).all():
            curves = [Curve(at, rows[0], "all loads")]
        else:
            values = loads[load] if load else [0.0]
            curves = [Curve(at, *each) for each in zip(rows, names, values, strict=True)]
        panel = Panel(x, y, [], None if any(names) else load)
        panels.setdefault(_LABELS[y], panel).curves.extend(curves)
    return list(panels.values())


def _over_loads(result: Mapping[str, Any], units: Units | None) -> list[Panel | Map]:
    """Return curves over the loads: one for each normal force with several tangential loads."""
    x, ordinates, load = next(
        (x, ys, load) for x, ys, load in _OVER_LOADS if {x, *ys, load or x} <= result.keys()
    )
    at = np.asarray(result[x], dtype=float)
    values, group = np.unique(result[load] if load else np.zeros(at.size), return_inverse=True)
    is_path = "step" in result
    if is_path or values.size == 1 or 2 * values.size > at.size:
        load, values, group = None, np.zeros(1), np.zeros_like(group)
    # The samples of a history follow each other as on its path.
    order = np.lexsort((np.arange(at.size) if is_path else at, group))
    parts = np.split(order, np.flatnonzero(np.diff(group[order])) + 1)
    panels = list[Panel | Map]()
    for y in ordinates:
        field = np.asarray(result[y])
        loads = {x: at, y: field} if at.size == 1 else {load: values} if load else {}
        names = _names(loads, units)
        curves = [
            Curve(at[part], field[part], name, value)
            for part, name, value in zip(parts, names, values.tolist(), strict=True)
        ]
        panels.append(Panel(x, y, curves, None if any(names) else load))
    return panels


def _varied(query: Any) -> dict[str, list[float]]:
    """Return the loads of a query that are different numbers, by their names."""
    lists = {each.control: each.value for each in query.controls.values() if each.count > 1}
    return {name: values for name, values in lists.items() if len(set(values)) > 1}


def _names(loads: Mapping[str, Any], units: Units | None) -> list[str]:
    """Return a name for each load; an empty one if there are too many."""
    count = len(next(iter(loads.values()), [0.0]))
    if not loads or count > NAMED:
        return [""] * count
    unit = {name: _unit(name, units) if units else "" for name in loads}
    parts = (
        [f"{_symbol(name)} = {value:.4g} {unit[name]}".strip() for value in values]
        for name, values in loads.items()
    )
    return [", ".join(each) for each in zip(*parts, strict=True)]


def label(name: str, units: Units | None, *, with_words: bool = True) -> str:
    """Return words, on a line of their own, and symbol and unit of a quantity, or dimension."""
    unit = _unit(name, units)
    symbol = f"{_symbol(name)} ({unit})" if unit else _symbol(name)
    return f"{_LABELS[name].partition('$')[0].strip()}\n{symbol}" if with_words else symbol


def _symbol(name: str) -> str:
    return "$" + _LABELS[name].partition("$")[2]


def _unit(name: str, units: Units | None) -> str:
    """Return the unit of a quantity, by default its dimension."""
    text = _DIMENSIONS[name].replace("*", " ").replace("^3", "³").replace("1", "")
    return re.sub(r"[a-z]+", lambda found: str(getattr(units, found[0], found[0])), text)
