"""Build the core's objects from bank records, and measure errors without rounding them away."""

from __future__ import annotations

from decimal import Decimal
from math import isfinite, isinf
from typing import TYPE_CHECKING, Any

from mdr_core.profiles import KINDS, PowerTerm, Profile

if TYPE_CHECKING:
    from collections.abc import Mapping

EPS = 2.0**-52
SMALLEST = Decimal("1e-290")
#: An input is a double that stands for its neighbourhood: what the bounds allow per unit of
#: condition number.
INPUT = 8 * EPS
#: Kinds whose break is computed from their parameters, and so is itself known only to rounding.
DERIVED_BREAK = frozenset({"rounded_cone", "spherical_tip_cone"})


def profile_from(fields: Mapping[str, Any]) -> Profile:
    """The core's profile for the fields of a request."""
    given = {name: value for name, value in fields.items() if name != "kind"}
    if fields["kind"] == "series":
        given = {"terms": tuple(PowerTerm(**term) for term in given["terms"])}
    return KINDS[fields["kind"]](**given)


def relative_error(value: float, expected: str) -> float:
    """Distance in units of the expected value; a wrong infinity or a NaN is infinitely far."""
    if expected.startswith("-"):
        return relative_error(-value, expected[1:])
    if expected == "inf":
        return 0.0 if isinf(value) and value > 0 else float("inf")
    if not isfinite(value):
        return float("inf")
    exact = Decimal(expected)
    if abs(exact) < SMALLEST and abs(value) < SMALLEST:
        # No double holds such a number with its digits.
        return 0.0
    if exact == 0:
        return 0.0 if value == 0 else float("inf")
    return float(abs((Decimal(value) - exact) / exact))


def wrong(
    what: str, value: float, expected: str, bound: float, allowance: float, estimate: float
) -> list[str]:
    """What is wrong with an answer: its error, or an estimate of it that understates.

    The allowance is what the rounding of the inputs makes of the answer.
    """
    error = relative_error(value, expected)
    if not error <= bound + allowance:
        return [f"{what}: {error:.2e} > {bound + allowance:.2e}"]
    if not error - allowance <= estimate:
        return [f"{what}: estimate {estimate:.2e} < {error:.2e}"]
    return []
