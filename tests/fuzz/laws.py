"""Laws that every result satisfies, checked without a reference solution."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Result = Mapping[str, Any]

_ROUNDING: Final = 1e-14
"""Rounding error of a comparison of two printed numbers."""
_ESTIMATE: Final = 1e-2
"""Largest error estimate without a warning `accuracy`."""
_ESTIMATE_OF_WEAR: Final = 0.3
"""Largest error estimate of wear over the cycles, at the coarsest resolution."""
_NULL_CODES: Final = frozenset({"singular", "endless_wear"})
_UNSTATED: Final = ("yield_onset_force.", "pressure_data_error")
_NOT_NUMBERS: Final = frozenset(
    {
        *("method", "error_estimate", "field_error_estimate", "search_error_estimate"),
        *("warnings", "sources", "holds_while", "regime", "step"),
    }
)
_SIGNED: Final = frozenset(
    {
        *("slip", "shear_stress", "foundation_shear", "normal_displacement"),
        *("x", "y", "mean_stress", "principal_1", "principal_2", "principal_3"),
        *("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz"),
    }
)
_PATH: Final = frozenset({"tangential_force", "tangential_displacement"})


def numbers(result: Result) -> dict[str, Array]:
    """Return the numerical members of a result, and of its members, with `null` as NaN."""
    arrays: dict[str, Array] = {}
    for name, values in result.items():
        if isinstance(values, Mapping):
            arrays |= {f"{name}.{part}": each for part, each in numbers(values).items()}
        elif name not in _NOT_NUMBERS:
            arrays[name] = np.array(values, dtype=float)
    return arrays


def tolerance(result: Result) -> float:
    """Return the relative tolerance of a comparison of two numbers, from the error estimate."""
    return 2 * float(result["error_estimate"]) + _ROUNDING


def violations(name: str, query: Mapping[str, Any], result: Result) -> Iterator[str]:
    """Yield the laws that a result violates."""
    arrays = numbers(result)
    codes = {warning["code"] for warning in result["warnings"]}
    # No load reaches the yield strength; the pressure or its error is infinite.
    finite = [each for quantity, each in arrays.items() if not quantity.startswith(_UNSTATED)]
    if any(np.isnan(values).any() for values in finite) and not codes & _NULL_CODES:
        yield "null without a warning"
    largest_estimate = _ESTIMATE_OF_WEAR if name == "evolution" else _ESTIMATE
    if not 0 <= result["error_estimate"] <= largest_estimate and "accuracy" not in codes:
        yield "error_estimate out of range"
    near = tolerance(result)
    for quantity, values in arrays.items():
        is_signed = quantity.rpartition(".")[2] in _SIGNED | _PATH or (
            quantity == "indentation_depth" and name == "history"
        )
        largest = np.nanmax(np.abs(values), initial=0.0)
        floor = near * largest if values.ndim > 1 else 0.0
        if not is_signed and np.any(values < -floor):
            yield f"negative {quantity}"
    if "regime" in result and "normal_force" in arrays and "tangential_force" in arrays:
        limit = query["friction_coefficient"] * arrays["normal_force"]
        excess = np.abs(arrays["tangential_force"]) - limit * (1 + near)
        scale = np.max(limit) if name == "history" else limit
        if np.any(excess > near * scale):
            yield "more tangential force than friction"
    yield from _LAWS[name](query, result, arrays, near)


def _differ(left: Array, right: Array, near: float) -> bool:
    return bool(np.any(np.abs(left - right) > near * np.maximum(np.abs(left), np.abs(right))))


def _falls(values: Array, near: float) -> NDArray[np.bool_]:
    return np.asarray(np.diff(values) < -near * np.maximum(values[1:], values[:-1]))


def _normal(
    query: Mapping[str, Any], _result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    force, a, depth = (
        arrays[each] for each in ("normal_force", "contact_radius", "indentation_depth")
    )
    touching = a > 0
    area = np.pi * a[touching] ** 2
    if _differ(arrays["mean_pressure"][touching] * area, force[touching], 4 * near):
        yield "mean pressure times area is not the force"
    if np.any(arrays["elastic_energy"] > force * depth * (1 + 4 * near)):
        yield "more elastic energy than work"
    order = np.argsort(force, kind="stable")
    # Where g of a rough table is constant, all contact radii have equal force.
    grows = np.diff(force[order]) > 2 * near * force[order][1:]
    for quantity in ("indentation_depth", "contact_radius", "elastic_energy", "normal_stiffness"):
        if np.any(_falls(arrays[quantity][order], 2 * near) & grows):
            yield f"{quantity} decreases while the force increases"
    (control,) = query["load"]
    given = np.ravel(query["load"][control])
    if not np.array_equal(np.broadcast_to(given, force.shape), arrays[control]):
        yield "load differs from the prescribed one"


def _tangential(
    query: Mapping[str, Any], result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    yield from _normal(query, result, arrays, near)
    a, c, width = (arrays[each] for each in ("contact_radius", "stick_radius", "slip_width"))
    force, displacement = arrays["tangential_force"], arrays["tangential_displacement"]
    if np.any(c > a) or np.any(np.abs(a - c - width) > 2 * near * a):
        yield "slip_width is not a - c"
    if np.any(force * displacement < 0):
        yield "force opposite to the displacement"
    if np.any(arrays["dissipated_energy"] > np.abs(force * displacement) * (1 + 4 * near)):
        yield "more dissipated energy than work"
    regime = np.array(result["regime"])
    slips = arrays["dissipated_energy"] > 0
    if np.any(slips & (regime == "stick")):
        yield "dissipation without slip"
    touching = (arrays["normal_force"] > 0) & (query["profile"]["kind"] != "flat_punch")
    if np.any(((regime == "full_slip") != (c == 0)) & touching):
        yield "regime is not that of stick_radius"


def _history(
    _query: Mapping[str, Any], result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    if np.any(np.diff(arrays["dissipated_energy"]) < 0):
        yield "dissipated energy decreases"
    fronts, edge = arrays["slip_fronts"], arrays["contact_radius"][-1]
    if np.any(np.diff(fronts) < 0) or np.any(fronts > edge * (1 + near)):
        yield "slip fronts out of order"
    gap = arrays["indentation_depth"] < 0
    for quantity in ("normal_force", "contact_radius", "tangential_force", "elastic_energy"):
        if np.any(arrays[quantity][gap] != 0):
            yield f"{quantity} despite separation"


def _stress(
    query: Mapping[str, Any], _result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    if "pressure" in arrays and "shear_stress" in arrays:
        pressure, shear = arrays["pressure"], np.abs(arrays["shear_stress"])
        largest = np.nanmax(pressure, initial=0.0, axis=1, keepdims=True)
        limit = query["friction_coefficient"] * pressure
        if np.any(shear - limit > 2 * near * query["friction_coefficient"] * largest):
            yield "more shear stress than friction"
    if "foundation_load" in arrays and "foundation_shear" in arrays:
        load, shear = arrays["foundation_load"], np.abs(arrays["foundation_shear"])
        limit = query["friction_coefficient"] * load
        scale = query["friction_coefficient"] * np.max(load, axis=1, keepdims=True, initial=0.0)
        if np.any(shear - limit > 2 * near * scale):
            yield "more foundation load than friction"


def _wear(
    _query: Mapping[str, Any], _result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    c, outer = arrays["stick_radius"], arrays["wear_radius"]
    if np.any(c > outer * (1 + near)):
        yield "wear_radius inside the stick zone"
    if "initial_profile" in arrays and "limiting_profile" in arrays:
        worn = arrays["limiting_profile"] - arrays["initial_profile"]
        scale = np.nanmax(np.abs(arrays["limiting_profile"]), initial=0.0)
        if np.any(worn < -2 * near * scale):
            yield "worn profile above the initial one"


def _evolution(
    _query: Mapping[str, Any], _result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    if _falls(arrays["worn_volume"], near).any():
        yield "worn_volume decreases"


def _subsurface(
    _query: Mapping[str, Any], result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    scale = _largest_stress(result)
    if {"principal_1", "principal_2", "principal_3"} <= arrays.keys():
        ordered = np.stack([arrays[f"principal_{number}"] for number in (1, 2, 3)])
        if np.any(np.diff(ordered, axis=0) > 0):
            yield "principal stresses out of order"
    if {"von_mises", "maximum_shear"} <= arrays.keys():
        mises, shear = arrays["von_mises"], arrays["maximum_shear"]
        if np.any(mises > (2 + near) * shear + near * scale):
            yield "von Mises stress above twice the largest shear stress"
        if np.any(mises < (np.sqrt(3) - near) * shear - near * scale):
            yield "von Mises stress below the root of 3 times the largest shear stress"
    for measure in ("von_mises", "maximum_shear"):
        if measure in arrays and f"largest.{measure}.value" in arrays:
            peak = arrays[f"largest.{measure}.value"] * (1 + result["search_error_estimate"])
            if np.any(np.nanmax(arrays[measure], initial=0.0, axis=(1, 2)) > peak + near * scale):
                yield f"{measure} above its largest value"


def _largest_stress(result: Result) -> float:
    """Return the largest stress of a response, to which the errors of all are relative."""
    stresses = [values for values in numbers(result).values() if values.ndim == 3]
    return max(float(np.nanmax(np.abs(values), initial=0.0)) for values in stresses)


def _torsion(
    query: Mapping[str, Any], result: Result, arrays: dict[str, Array], near: float
) -> Iterator[str]:
    yield from _normal(query, result, arrays, near)
    torque, rotation = np.abs(arrays["torque"]), np.abs(arrays["rotation"])
    limit = query["friction_coefficient"] * arrays["normal_force"] * arrays["torsion_arm"]
    if np.any(torque > limit * (1 + 4 * near)):
        yield "more torque than friction"
    if np.any(arrays["dissipated_energy"] > torque * rotation * (1 + 4 * near)):
        yield "more dissipated energy than work"
    if np.any(arrays["torsional_stiffness"] * rotation > torque * (1 + 4 * near)):
        yield "the contact stiffens"
    yield from _stress(query, result, arrays, near)


_LAWS: Final = {
    "normal": _normal,
    "tangential": _tangential,
    "history": _history,
    "stress": _stress,
    "wear": _wear,
    "evolution": _evolution,
    "subsurface": _subsurface,
    "torsion": _torsion,
}

_RELATIVE_TO_LARGEST: Final = frozenset({"history", "stress", "evolution", "wear"})


def disagreements(name: str, one: Result, other: Result, more: float = 0.0) -> Iterator[str]:
    """Yield the quantities in which two results of one case differ by more than their estimates.

    Fields, samples of a history and radii of slip fronts are compared relative to their largest
    value. Fields at different radii are not compared.
    """
    left, right = numbers(one), numbers(other)
    near = float(one["error_estimate"] + other["error_estimate"]) + _ROUNDING + more
    of_fields = sum(result.get("field_error_estimate", 0.0) for result in (one, other))
    if "radius" in left and not np.array_equal(left["radius"], right.get("radius")):
        return
    for quantity in left.keys() & right.keys():
        a, b = left[quantity], right[quantity]
        if quantity.startswith("largest.") and not quantity.endswith(".value"):
            # The place of a flat maximum is inaccurate.
            continue
        searched = one["search_error_estimate"] if "." in quantity else 0.0
        if a.shape != b.shape or np.any(np.isnan(a) != np.isnan(b)):
            yield f"{quantity}: different shape"
            continue
        scale = np.maximum(np.abs(a), np.abs(b))
        relative_to_largest = name in _RELATIVE_TO_LARGEST or quantity in {"x", "z"}
        if relative_to_largest and scale.size:
            scale = np.nanmax(scale, initial=0.0)
        if name == "subsurface" and a.ndim == 3:
            scale = max(_largest_stress(one), _largest_stress(other))
        if np.any(np.abs(a - b) > (near + searched + of_fields * (a.ndim == 2)) * scale):
            yield f"{quantity} differs"
