"""Stresses at many radii, which are interpolated between few: the banks of references hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields
from mdr_core.abel.interpolation import Interpolation
from mdr_core.normal import solve
from tests.core import test_fields_bank, test_pressure_bank
from tests.core.batches import batched
from tests.core.comparison import assert_each, profile_from
from tests.core.evaluations import PROFILES, counted
from tests.core.test_tangential_bank import solved
from tests.oracles import bank

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from mdr_core.typing import Array

KINDS = {
    "rounded_punch",
    "truncated_cone",
    "truncated_paraboloid",
    "rounded_cone",
    "spherical_tip_cone",
    "capped_paraboloid",
}
RADII = 2000
#: Odd functions; the first two are singular at the edge of the strip.
FUNCTIONS: dict[str, tuple[Callable[[Any, Any], Any], float]] = {
    "tanh": (lambda xp, y: xp.tanh(y), 0.0),
    "gudermannian": (lambda xp, y: (xp.arctan if xp is np else xp.atan)(xp.sinh(y)), 0.0),
    "sinh": (lambda xp, y: xp.sinh(y), 1.0),
}


def among_many(radius: list[float], edge: float) -> tuple[Array, Array]:
    """Ascending radii, most of them in the contact, with the given ones and the places of these."""
    every = np.union1d(np.linspace(0.0, edge, RADII), radius)
    return every, np.searchsorted(every, radius)


def cases_of(name: str) -> list[dict[str, Any]]:
    return [case for case in bank.load(name) if case["profile"]["kind"] in KINDS]


def wrong_pressures(case: dict[str, Any]) -> Iterator[str]:
    contact = test_pressure_bank.contact_of(case)
    radius, places = among_many(case["radius"], float(contact.contact_radius))
    result = fields.pressure(contact, radius, rtol=1e-13)[places]
    return test_pressure_bank.misses(case, result)


def wrong_shear_stresses(case: dict[str, Any]) -> Iterator[str]:
    contact = solved(case)
    radius, places = among_many(case["radius"], float(contact.normal.contact_radius))
    result = fields.shear_stress(contact, radius, rtol=1e-13)[places]
    return test_fields_bank.misses(case, "shear_stress", result)


@batched(cases_of("pressure"))
def test_pressure(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, wrong_pressures)


@batched(cases_of("slip_fields"))
def test_shear_stress(cases: list[dict[str, Any]]) -> None:
    assert_each(cases, wrong_shear_stresses)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_many_radii_take_few_evaluations(kind: str) -> None:
    contact = solve(profile_from({"kind": kind, **PROFILES[kind]}), 1.0, contact_radius=1.0)
    with counted() as count:
        fields.pressure(contact, np.linspace(0.0, 0.999, 20_000))
    # Integrals need at least four each, and the sphere at the tip is not interpolated.
    assert count.integrand < (4 if kind == "spherical_tip_cone" else 1) * 20_000


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_order_of_the_radii_does_not_matter(kind: str) -> None:
    contact = solve(profile_from({"kind": kind, **PROFILES[kind]}), 1.0, contact_radius=1.0)
    radius = np.linspace(0.0, 0.999, RADII)
    order = np.random.default_rng(1).permutation(RADII)
    shuffled = fields.pressure(contact, radius[order])
    assert np.allclose(shuffled, fields.pressure(contact, radius)[order], rtol=1e-10, atol=0)


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-10, 1e-13])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_interpolation_of_odd_functions(name: str, rtol: float) -> None:
    function, growth = FUNCTIONS[name]
    parts = [(np.geomspace(1e-9, 4.5, 40), 0.0), (np.array([1.3, 2.0, 3.7]), 1.2)]
    interpolation = Interpolation(parts, rtol, growth)
    result = interpolation(function(np, np.concatenate(interpolation.nodes)))
    for value, y in zip(result, np.concatenate([y for y, _ in parts]).tolist(), strict=True):
        with mp.workdps(30):
            truth = function(mp, mpf(y))
            assert abs((mpf(float(value)) - truth) / truth) <= rtol + 1e-15
