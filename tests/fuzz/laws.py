"""Laws that every answer obeys, checked without a reference solution."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Answer = Mapping[str, Any]

_ROUNDING: Final = 1e-14
"""Rounding error of the few operations by which two printed numbers are compared."""
_ESTIMATE: Final = 1e-2
"""Largest credible error estimate of an answer without a warning `accuracy`."""
_ESTIMATE_OF_WEAR: Final = 0.3
"""The same of wear over the cycles, at the coarsest resolution."""
_NULL_CODES: Final = frozenset({"singular", "endless_wear"})
_NOT_NUMBERS: Final = frozenset(
    {"method", "error_estimate", "field_error_estimate", "warnings", "regime", "step"}
)
_SIGNED: Final = frozenset({"slip", "shear_stress", "foundation_shear", "normal_displacement"})
_PATH: Final = frozenset({"tangential_force", "tangential_displacement"})


def numbers(answer: Answer) -> dict[str, Array]:
    """Return the numerical members of an answer, `null` as NaN."""
    return {
        name: np.array(values, dtype=float)
        for name, values in answer.items()
        if name not in _NOT_NUMBERS
    }


def slack(answer: Answer) -> float:
    """Return the relative difference that two numbers of an answer may have by its estimate."""
    return 2 * float(answer["error_estimate"]) + _ROUNDING


def broken(name: str, query: Mapping[str, Any], answer: Answer) -> Iterator[str]:
    """Yield the laws that an answer breaks."""
    found = numbers(answer)
    codes = {warning["code"] for warning in answer["warnings"]}
    if any(np.isnan(values).any() for values in found.values()) and not codes & _NULL_CODES:
        yield "null without a warning"
    largest_estimate = _ESTIMATE_OF_WEAR if name == "evolution" else _ESTIMATE
    if not 0 <= answer["error_estimate"] <= largest_estimate and "accuracy" not in codes:
        yield "error_estimate out of range"
    near = slack(answer)
    for quantity, values in found.items():
        is_signed = quantity in _SIGNED | _PATH or (
            quantity == "indentation_depth" and name == "history"
        )
        largest = np.nanmax(np.abs(values), initial=0.0)
        floor = near * largest if values.ndim == 2 else 0.0
        if not is_signed and np.any(values < -floor):
            yield f"negative {quantity}"
    if "regime" in answer and "normal_force" in found and "tangential_force" in found:
        limit = query["friction_coefficient"] * found["normal_force"]
        excess = np.abs(found["tangential_force"]) - limit * (1 + near)
        scale = np.max(limit) if name == "history" else limit
        if np.any(excess > near * scale):
            yield "more tangential force than friction"
    yield from _LAWS[name](query, answer, found, near)


def _differ(left: Array, right: Array, near: float) -> bool:
    return bool(np.any(np.abs(left - right) > near * np.maximum(np.abs(left), np.abs(right))))


def _falls(values: Array, near: float) -> NDArray[np.bool_]:
    return np.asarray(np.diff(values) < -near * np.maximum(values[1:], values[:-1]))


def _normal(
    query: Mapping[str, Any], _answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    force, a, depth = (
        found[each] for each in ("normal_force", "contact_radius", "indentation_depth")
    )
    touching = a > 0
    area = np.pi * a[touching] ** 2
    if _differ(found["mean_pressure"][touching] * area, force[touching], 4 * near):
        yield "mean pressure times area is not the force"
    if np.any(found["elastic_energy"] > force * depth * (1 + 4 * near)):
        yield "more elastic energy than work"
    order = np.argsort(force, kind="stable")
    # Where a rough table's g is constant, contacts of all its radii have one force.
    grows = np.diff(force[order]) > 2 * near * force[order][1:]
    for quantity in ("indentation_depth", "contact_radius", "elastic_energy", "normal_stiffness"):
        if np.any(_falls(found[quantity][order], 2 * near) & grows):
            yield f"{quantity} falls while the force increases"
    (control,) = query["load"]
    given = np.ravel(query["load"][control])
    if not np.array_equal(np.broadcast_to(given, force.shape), found[control]):
        yield "another load than prescribed"


def _tangential(
    query: Mapping[str, Any], answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    yield from _normal(query, answer, found, near)
    a, c, width = (found[each] for each in ("contact_radius", "stick_radius", "slip_width"))
    push, shift = found["tangential_force"], found["tangential_displacement"]
    if np.any(c > a) or np.any(np.abs(a - c - width) > 2 * near * a):
        yield "slip_width is not a - c"
    if np.any(push * shift < 0):
        yield "force against the displacement"
    if np.any(found["dissipated_energy"] > np.abs(push * shift) * (1 + 4 * near)):
        yield "more dissipated energy than work"
    regime = np.array(answer["regime"])
    slips = found["dissipated_energy"] > 0
    if np.any(slips & (regime == "stick")):
        yield "dissipation without slip"
    touching = (found["normal_force"] > 0) & (query["profile"]["kind"] != "flat_punch")
    if np.any(((regime == "full_slip") != (c == 0)) & touching):
        yield "regime is not that of stick_radius"


def _history(
    _query: Mapping[str, Any], answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    if np.any(np.diff(found["dissipated_energy"]) < 0):
        yield "dissipated energy decreases"
    fronts, edge = found["slip_fronts"], found["contact_radius"][-1]
    if np.any(np.diff(fronts) < 0) or np.any(fronts > edge * (1 + near)):
        yield "slip fronts out of order"
    gap = found["indentation_depth"] < 0
    for quantity in ("normal_force", "contact_radius", "tangential_force", "elastic_energy"):
        if np.any(found[quantity][gap] != 0):
            yield f"{quantity} without contact"


def _stress(
    query: Mapping[str, Any], _answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    if "pressure" in found and "shear_stress" in found:
        pressure, shear = found["pressure"], np.abs(found["shear_stress"])
        largest = np.nanmax(pressure, initial=0.0, axis=1, keepdims=True)
        limit = query["friction_coefficient"] * pressure
        if np.any(shear - limit > 2 * near * query["friction_coefficient"] * largest):
            yield "more shear stress than friction"
    if "foundation_load" in found and "foundation_shear" in found:
        load, shear = found["foundation_load"], np.abs(found["foundation_shear"])
        limit = query["friction_coefficient"] * load
        scale = query["friction_coefficient"] * np.max(load, axis=1, keepdims=True, initial=0.0)
        if np.any(shear - limit > 2 * near * scale):
            yield "more load of the foundation than friction"


def _wear(
    _query: Mapping[str, Any], _answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    c, outer = found["stick_radius"], found["wear_radius"]
    if np.any(c > outer * (1 + near)):
        yield "wear_radius inside the stick zone"
    if "initial_profile" in found and "limiting_profile" in found:
        worn = found["limiting_profile"] - found["initial_profile"]
        scale = np.nanmax(np.abs(found["limiting_profile"]), initial=0.0)
        if np.any(worn < -2 * near * scale):
            yield "worn profile above the initial one"


def _evolution(
    query: Mapping[str, Any], _answer: Answer, found: dict[str, Array], near: float
) -> Iterator[str]:
    for quantity in ("worn_volume", "dissipated_energy"):
        if _falls(found[quantity], near).any():
            yield f"{quantity} decreases"
    if _differ(
        found["worn_volume"], query["wear_coefficient"] * found["dissipated_energy"], 4 * near
    ):
        yield "worn volume is not K times the dissipated energy"


_LAWS: Final = {
    "normal": _normal,
    "tangential": _tangential,
    "history": _history,
    "stress": _stress,
    "wear": _wear,
    "evolution": _evolution,
}

_RELATIVE_TO_LARGEST: Final = frozenset({"history", "stress", "evolution", "wear"})


def disagreements(name: str, one: Answer, other: Answer, more: float = 0.0) -> Iterator[str]:
    """Yield the quantities in which two answers to one case differ by more than their estimates.

    Fields and samples of a history are exact relative to their largest value; so are radii at
    which fronts lie. Answers of fields at different radii are not compared.
    """
    left, right = numbers(one), numbers(other)
    near = float(one["error_estimate"] + other["error_estimate"]) + _ROUNDING + more
    of_fields = sum(answer.get("field_error_estimate", 0.0) for answer in (one, other))
    if "radius" in left and not np.array_equal(left["radius"], right.get("radius")):
        return
    for quantity in left.keys() & right.keys():
        a, b = left[quantity], right[quantity]
        if a.shape != b.shape or np.any(np.isnan(a) != np.isnan(b)):
            yield f"{quantity}: another shape"
            continue
        scale = np.maximum(np.abs(a), np.abs(b))
        if name in _RELATIVE_TO_LARGEST and scale.size:
            scale = np.nanmax(scale, initial=0.0)
        if np.any(np.abs(a - b) > (near + of_fields * (a.ndim == 2)) * scale):
            yield f"{quantity} differs"
