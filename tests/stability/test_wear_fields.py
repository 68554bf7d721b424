"""Wear fields over the cycles: true error against a fine reference run, and error estimate."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from mdr_core import normal, tangential
from mdr_core.profiles import (
    Cone,
    Hyperboloid,
    Paraboloid,
    Power,
    Profile,
    RoundedPunch,
    Sphere,
)
from mdr_core.wear import evolution
from mdr_core.wear.annulus_state import Held
from mdr_core.wear.initial_state import InitialState

E_STAR, G_STAR, MU, WEAR = 1.0, 0.8, 0.4, 1e-3
DEPTH, PART = 0.05, 0.5
PROFILES: dict[str, Profile] = {
    "paraboloid": Paraboloid(1.0),
    "cone": Cone(0.3),
    "sphere": Sphere(1.0),
    "power": Power(1.0, 4.0),
    "rounded_punch": RoundedPunch(0.5, 1.0),
    "hyperboloid": Hyperboloid(0.5, 0.5),
}
CONTROLS = {
    "depth, displacement": Held(force=False, displacement=True),
    "forces": Held(force=True, displacement=False),
    "force, displacement": Held(force=True, displacement=True),
    "depth, force": Held(force=False, displacement=False),
}
#: Characteristic numbers of cycles for the decay of the pressure on the annulus.
CYCLES = (0.1, 1.0, 10.0, 100.0, 1000.0)
PAIRS = [(kind, held) for kind in PROFILES for held in CONTROLS]


@cache
def worn(kind: str, name: str, resolution: int, rtol: float = 1e-6) -> evolution.WearEvolution:
    """Wear at half the displacement or force of full slip."""
    profile, held = PROFILES[kind], CONTROLS[name]
    contact = normal.solve(profile, E_STAR, indentation_depth=DEPTH)
    if held.force:
        contact = normal.solve(profile, E_STAR, normal_force=float(contact.normal_force))
    force = PART * MU * float(contact.normal_force)
    sideways = tangential.solve(contact, G_STAR, MU, tangential_force=force)
    amplitude = {"tangential_force": force}
    if held.displacement:
        amplitude = {"tangential_displacement": float(sideways.tangential_displacement)}
    unit = InitialState(sideways, WEAR, held).cycle_unit
    return evolution.solve(
        contact,
        G_STAR,
        MU,
        wear_coefficient=WEAR,
        cycles=unit * np.array(CYCLES),
        resolution=resolution,
        rtol=rtol,
        **amplitude,
    )


@cache
def reference(kind: str, name: str) -> evolution.WearEvolution:
    return worn(kind, name, 96, 1e-8)


@pytest.mark.every(11)
@pytest.mark.parametrize("resolution", [16, 24, 32, 48, 64])
@pytest.mark.parametrize(("kind", "name"), PAIRS)
def test_error_within_estimate(kind: str, name: str, resolution: int) -> None:
    found, exact = worn(kind, name, resolution), reference(kind, name)
    for scalar in evolution.SCALARS:
        value, true = getattr(found, scalar), getattr(exact, scalar)
        assert np.abs(value / true - 1).max() <= found.error_estimate, scalar
    radius = np.linspace(0.0, 1.05, 151)[1:] * exact.contact_radius.max()
    for field in evolution.FIELDS:
        value, true = getattr(found, field)(radius), getattr(exact, field)(radius)
        error = np.abs(value - true).max() / np.abs(value).max()
        assert error <= found.field_error_estimate(radius, [field]), field


@pytest.mark.every(5)
@pytest.mark.parametrize(("kind", "name"), PAIRS)
def test_pressure_does_not_ripple(kind: str, name: str) -> None:
    """Excludes 2 % of a at the edges; relative to the largest pressure of each cycle."""
    found, exact = worn(kind, name, 48), reference(kind, name)
    for cycle, (c, a) in enumerate(zip(exact.stick_radius, exact.contact_radius, strict=True)):
        radius = np.linspace(0.0, 1.05 * a, 400)[1:]
        off = (np.abs(radius - c) > 0.02 * a) & (np.abs(radius - a) > 0.02 * a)
        pressure, true = (run.pressure(radius[off])[cycle] for run in (found, exact))
        assert np.abs(pressure - true).max() <= 1e-3 * true.max(), (cycle, c, a)
