"""A single load has the same results as a history, as a tangential query and as a cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from mdr_core import history, normal, profiles, tangential

if TYPE_CHECKING:
    from mdr_core.profiles import Profile

E_STAR, G_STAR, MU = 1.3, 1.1, 0.35
#: Tangential loads in units of full slip.
RATIOS = (1e-9, 1e-6, 1e-3, 0.03, 0.2, 0.5, 0.9, 0.99, 1.0, 1.5)
KINDS: dict[str, Profile] = {
    "paraboloid": profiles.Paraboloid(1.0),
    "cone": profiles.Cone(0.3),
    "power-0.05": profiles.Power(coefficient=0.5, exponent=0.05),
    "power-0.6": profiles.Power(coefficient=0.5, exponent=0.6),
    "power-6": profiles.Power(coefficient=0.5, exponent=6.0),
    "power-50": profiles.Power(coefficient=0.5, exponent=50.0),
    "sphere": profiles.Sphere(5.0),
    "rounded-punch": profiles.RoundedPunch(0.3, 1.0),
    "truncated-cone": profiles.TruncatedCone(0.3, 0.3),
    "truncated-paraboloid": profiles.TruncatedParaboloid(0.3, 1.0),
    "rounded-cone": profiles.RoundedCone(0.3, 1.0),
    "spherical-tip-cone": profiles.SphericalTipCone(1.0, 0.3),
    "hyperboloid": profiles.Hyperboloid(1.0, 0.3),
    "capped-paraboloid": profiles.CappedParaboloid(cap_radius=0.2, tip_radius=4.0, radius=1.0),
    "flat-punch": profiles.FlatPunch(0.3),
}


def disagreements(
    profile: Profile, depth: float, ratios: tuple[float, ...], controls: int
) -> list[str]:
    """Return the disagreements with the tangential query for some pairs of controls."""
    contact = normal.solve(profile, E_STAR, indentation_depth=depth)
    loads = {"indentation_depth": depth, "normal_force": float(contact.normal_force)}
    full = {
        "tangential_displacement": MU * E_STAR / G_STAR * depth,
        "tangential_force": MU * loads["normal_force"],
    }
    pairs = [(by, along) for by in loads for along in full]
    # Pairs of prescribed displacements, or forces, come first.
    pairs = [pairs[i] for i in (0, 3, 1, 2)][:controls]
    computed = []
    for by, along in pairs:
        pressed = normal.solve(profile, E_STAR, **{by: loads[by]})
        for ratio in ratios:
            if ratio <= 1 or along == "tangential_displacement":
                monotonic = tangential.solve(pressed, G_STAR, MU, **{along: ratio * full[along]})
                computed += single_load_disagreements(profile, monotonic, by, along, ratio)
    return computed


def single_load_disagreements(
    profile: Profile, monotonic: tangential.TangentialContact, by: str, along: str, ratio: float
) -> list[str]:
    """Return the disagreements for one load, and for a cycle of this amplitude."""
    pressed = float(getattr(monotonic.normal, by))
    pushed = float(getattr(monotonic, along))
    points: Any = {by: [pressed, pressed], along: [0.0, pushed]}
    material = monotonic.normal.e_star, monotonic.g_star, monotonic.friction_coefficient
    way = history.solve(profile, *material, **points)
    case = f"{by} {pressed:.3g}, {along} {ratio:g} of full slip"
    computed = []
    for name in ("tangential_force", "tangential_displacement", "dissipated_energy"):
        expected, result = float(getattr(monotonic, name)), float(getattr(way, name)[1])
        error = abs(result - expected) / abs(expected) if expected else abs(result)
        # Neither estimate includes the rounding error of the load where a displacement is the
        # result.
        most = max(1e-9, 1e-15 / ratio)
        if not error <= min(most, max(way.error_estimate, monotonic.error_estimate)):
            computed.append(f"{case}: {name} {error:.1e}")
    # At full slip the last bit decides the regime of the query.
    if ratio != 1 and way.regime[1] != str(monotonic.regime):
        computed.append(f"{case}: {way.regime[1]}, not {monotonic.regime}")
    # Without a front the annulus is too narrow to resolve.
    fronts = [*way.slip_fronts.tolist(), float(monotonic.normal.contact_radius)]
    if ratio < 1 and not np.isclose(fronts[0], float(monotonic.stick_radius), rtol=1e-9, atol=0.0):
        computed.append(f"{case}: stick radius {fronts[0]}, not {monotonic.stick_radius}")
    if not (way.tangential_energy[0] == 0 and way.tangential_energy[1] > 0):
        computed.append(f"{case}: tangential energies {way.tangential_energy}")
    if ratio <= 1:
        given: Any = {by: pressed, along: pushed}
        loops = history.cycles(profile, *material, **given, count=2).energy_per_cycle
        quarter = float(monotonic.dissipated_energy)
        if not np.allclose(loops, 4 * quarter, rtol=1e-9, atol=0.0):
            computed.append(f"{case}: cycles {loops}, not {4 * quarter}")
    return computed


@pytest.mark.every(2)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("depth", [0.028, 0.2])
def test_single_load_agrees_with_tangential_query(kind: str, depth: float) -> None:
    assert not disagreements(KINDS[kind], depth, RATIOS, 4)


@pytest.mark.parametrize("kind", ["cone", "power-6", "truncated-cone", "flat-punch"])
@pytest.mark.parametrize("along", ["tangential_force", "tangential_displacement"])
def test_regimes_agree_next_to_full_slip(kind: str, along: str) -> None:
    for by, load in (("indentation_depth", 0.0333), ("normal_force", 0.02)):
        pressed = normal.solve(KINDS[kind], E_STAR, **{by: load})
        depth, force = float(pressed.indentation_depth), float(pressed.normal_force)
        full = MU * force if along == "tangential_force" else MU * E_STAR / G_STAR * depth
        for units in (0, 2, 8, 50, 1000):
            pushed = full * (1 - units * np.finfo(float).eps)
            monotonic = tangential.solve(pressed, G_STAR, MU, **{along: pushed})
            points: Any = {by: [load, load], along: [0.0, pushed]}
            way = history.solve(KINDS[kind], E_STAR, G_STAR, MU, **points)
            # A load that rounding may have put below the limit is at it.
            expected = "full_slip" if units <= 8 else str(monotonic.regime)
            assert way.regime[1] == expected, (by, units)


@pytest.mark.parametrize("share", [0.3, 0.999, 1 - 1e-9, 1 - 1e-15, 1.0])
@pytest.mark.parametrize("radius", [0.45, 0.52, 0.9, 50.0])
@pytest.mark.parametrize(
    "profile",
    [
        profiles.RoundedCone(0.5, 1.0),
        profiles.SphericalTipCone(0.5, 1.0),
        profiles.CappedParaboloid(0.5, 2.0, 1.0),
    ],
    ids=lambda profile: str(profile.kind),
)
def test_dissipation_of_forces_past_a_break_and_down_to_the_axis(
    profile: Profile, radius: float, share: float
) -> None:
    """The measure of the springs, |d(1/2a)|, is infinite on the axis, where nothing is dissipated.

    A reversal dissipates twice as much as the first loading: its amplitude is half of its range.
    """
    force = float(normal.solve(profile, 1.0, contact_radius=radius).normal_force)
    pushed = 0.4 * force * share
    contact = normal.solve(profile, 1.0, normal_force=force)
    once = float(tangential.solve(contact, 0.8, 0.4, tangential_force=pushed).dissipated_energy)
    computed = history.solve(
        profile,
        1.0,
        0.8,
        0.4,
        normal_force=[force] * 3,
        tangential_force=[0.0, pushed, -pushed],
    )
    bound = computed.error_estimate
    assert computed.dissipated_energy == pytest.approx([0.0, once, 3 * once], rel=bound, abs=0)
