"""Core objects from bank records, and relative errors evaluated in high precision."""

from __future__ import annotations

import json
from decimal import Decimal
from math import inf, isfinite, isinf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mdr_core.normal import NormalContact, solve
from mdr_core.profiles import KINDS, PowerTerm, Profile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

EPS = 2.0**-52
SMALLEST = Decimal("1e-290")
#: Relative rounding error of an input stored as a double.
INPUT = 8 * EPS
#: Largest allowance for the rounding error of the inputs. Results with a larger one are held to
#: this limit as well, since their inputs are exact; tests/oracles/test_bank.py counts them.
LARGEST_ALLOWANCE = 1e-3
#: Kinds whose break is computed from their parameters and carries rounding error.
DERIVED_BREAK = frozenset({"rounded_cone", "spherical_tip_cone"})


def assert_each(
    cases: Iterable[Mapping[str, Any]], failures_of: Callable[[Any], Iterable[str]]
) -> None:
    """Assert that no record of a batch fails; list every failure of every record."""
    computed = [f"{case['id']}: {failure}" for case in cases for failure in failures_of(case)]
    assert not computed, "\n" + "\n".join(computed)


def profile_from(fields: Mapping[str, Any]) -> Profile:
    """Return the core's profile for the `profile` member of a request."""
    given = {name: value for name, value in fields.items() if name != "kind"}
    if fields["kind"] == "series":
        given = {"terms": tuple(PowerTerm(**term) for term in given["terms"])}
    return KINDS[fields["kind"]](**given)


def stored(name: str) -> Any:
    """Return the data of the tests under a name."""
    return json.loads((Path(__file__).parents[1] / "data" / f"{name}.json").read_text("utf-8"))


def contact_of(case: Mapping[str, Any]) -> NormalContact:
    """Return the normal contact of a case of a bank."""
    load = {case["control"]: case["load"]}
    return solve(profile_from(case["profile"]), case["e_star"], **load)


def bound_of(case: Mapping[str, Any], bound: float) -> float:
    """Return the bound of a case, wider next to an edge that a contact radius hardly resolves.

    Within 1e-6 of the edge of a cap it is 1e-9. The estimate is the only bound, and may not be
    below the error, within 1e-9 of the edge of a cap, within 1e-6 of the equator of a spheroid, and
    at the tips of cones steeper than 100.
    """
    kind, regime, edge = case["profile"]["kind"], case["tags"]["regime"], "b(1+1e-9)"
    if kind == "capped_paraboloid":
        return {"extreme": inf, edge: inf, "b(1+1e-6)": 1e-9}.get(regime, bound)
    if kind in {"sphere", "ellipsoid"} and regime == "0.999999":
        return inf
    return inf if kind == "spherical_tip_cone" and regime == "extreme" else bound


def allowance(
    *conditions: float | None, rounding: float = INPUT, largest: float = LARGEST_ALLOWANCE
) -> float:
    """Return the allowance for the rounding error of the inputs.

    Parameters
    ----------
    conditions : condition numbers of the result; None where undefined.
    rounding : relative rounding error of the inputs.
    largest : limit of the allowance.
    """
    return min(rounding * sum(each or 0.0 for each in conditions), largest)


def relative_error(value: float, expected: str) -> float:
    """Return the relative error of a value; infinite for NaN or a wrong infinity."""
    if expected.startswith("-"):
        return relative_error(-value, expected[1:])
    if expected == "inf":
        return 0.0 if isinf(value) and value > 0 else float("inf")
    if not isfinite(value):
        return float("inf")
    exact = Decimal(expected)
    if abs(exact) < SMALLEST and abs(value) < SMALLEST:
        # The expected value underflows.
        return 0.0
    if exact == 0:
        return 0.0 if value == 0 else float("inf")
    return float(abs((Decimal(value) - exact) / exact))


def wrong(
    what: str, value: float, expected: str, bound: float, allowed: float, estimate: float
) -> list[str]:
    """Return the failure of a result: its error, or an estimate below its error.

    Parameters
    ----------
    what : name of the result.
    value, expected : the result and its stored value.
    bound : largest relative error of the method.
    allowed : allowance for the rounding error of the inputs.
    estimate : estimate of the relative error, without the errors of the inputs.
    """
    error = relative_error(value, expected)
    if not error <= bound + allowed:
        return [f"{what}: {error:.2e} > {bound + allowed:.2e}"]
    if not error - allowed <= estimate:
        return [f"{what}: estimate {estimate:.2e} < {error:.2e}"]
    return []


def overstated(estimate: float, allowed: Iterable[float], factor: float) -> list[str]:
    """Return the failure of an estimate above `factor` times the largest admissible error."""
    largest = max(allowed)
    return [f"estimate {estimate:.2e} of at most {largest:.2e}"] * (estimate > factor * largest)
