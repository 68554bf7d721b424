"""Tables like measured ones: noise, rounded heights, flats and kinks between the points."""

from __future__ import annotations

import pickle
import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pytest

from mdr_core import fields, tangential
from mdr_core.errors import InputError
from mdr_core.normal import solve
from mdr_core.profiles import Tabulated

if TYPE_CHECKING:
    from collections.abc import Callable

    Array = np.ndarray

#: End of the tables, contact radius, and radius of flats and kinks; none is a table point.
END, A, B = 0.7, 0.531, 0.2137
S, PHI = np.sqrt((A - B) * (A + B)), np.arctan2(np.sqrt((A - B) * (A + B)), B)


class Body(NamedTuple):
    """Profile, with depth and force / E* at contact radius A in closed form."""

    f: Callable[[Array], Array]
    depth: float
    force: float


#: Source: notes, §2.
BODIES = {
    "ball": Body(lambda r: r * r / 2, A**2, 4 * A**3 / 3),
    "rounded punch": Body(
        lambda r: np.maximum(r - B, 0) ** 2 / 2,
        A * (S - B * PHI),
        A * A * (S - B * PHI) + S**3 / 3,
    ),
    "truncated cone": Body(
        lambda r: 0.1 * np.maximum(r - B, 0), 0.1 * A * PHI, 0.1 * (A * A * PHI + B * S)
    ),
    "worn ball": Body(
        lambda r: np.maximum(r * r - B * B, 0) / 2, A * S, 2 * S * (2 * A * A + B * B) / 3
    ),
    "cone": Body(lambda r: 0.1 * r, np.pi / 2 * 0.1 * A, np.pi / 2 * 0.1 * A * A),
    "double cone": Body(
        lambda r: 0.05 * r + 0.1 * np.maximum(r - B, 0),
        np.pi / 2 * 0.05 * A + 0.1 * A * PHI,
        np.pi / 2 * 0.05 * A * A + 0.1 * (A * A * PHI + B * S),
    ),
}
#: Noise relative to the last height: standard deviation of random errors, or of a rounding to 3.5
#: times as much.
NOISE = [0.0, 1e-6, 1e-5, 1e-4, 3e-4]


def measured(f: Array, noise: float, *, rounded: bool) -> Array:
    """Heights as returned by an instrument, made monotonic as a user would."""
    size = noise * f[-1]
    if not size:
        return f
    if rounded:
        return np.round(f / (3.5 * size)) * (3.5 * size)
    error = size * np.random.default_rng(5).standard_normal(f.size)
    return np.maximum.accumulate(np.append(0.0, np.maximum(f + error, 0.0)[1:]))


@pytest.mark.every(7)
@pytest.mark.parametrize("errors", ["random", "rounding"])
@pytest.mark.parametrize("noise", NOISE)
@pytest.mark.parametrize("intervals", [50, 200])
@pytest.mark.parametrize("name", BODIES)
def test_measured_table_is_accepted(name: str, intervals: int, noise: float, errors: str) -> None:
    body, r = BODIES[name], np.linspace(0, END, intervals + 1)
    f = measured(body.f(r), noise, rounded=errors == "rounding")
    contact = solve(Tabulated(r, f), 1.0, contact_radius=A)
    # A kink is located to one step, of which depth and force depend quadratically; height errors
    # next to the edge have the weight of an endpoint singularity, sqrt(A/step).
    step = END / intervals / A
    bound = step**2 / 4 + 4 * noise / np.sqrt(step)
    assert contact.indentation_depth == pytest.approx(body.depth, rel=bound, abs=0)
    assert contact.normal_force == pytest.approx(body.force, rel=bound, abs=0)
    # The warnings report the changes that the table makes to the shape.
    codes = {notice.code for notice in contact.warnings}
    smooth = noise == 0 and name in {"ball", "cone", "rounded punch"}
    assert smooth == (not codes & {"interpolation", "rough_table"}) or noise > 0
    # The inverse recovers this depth, and no pressure is negative.
    again = solve(Tabulated(r, f), 1.0, normal_force=contact.normal_force)
    assert again.indentation_depth == pytest.approx(contact.indentation_depth, rel=1e-12, abs=0)
    pressure = fields.pressure(contact, np.linspace(0.01, 0.99, 197) * A)
    assert pressure.min() >= 0


def test_partial_slip_on_a_noisy_table() -> None:
    """Cattaneo-Mindlin for a sphere, within the noise."""
    r = np.linspace(0, END, 201)
    f = measured(r * r / 2, 1e-5, rounded=False)
    contact = solve(Tabulated(r, f), 1.0, normal_force=0.1)
    pushed = tangential.solve(contact, 0.8, 0.3, tangential_force=0.015)
    ratio = pushed.stick_radius / contact.contact_radius
    assert ratio == pytest.approx(0.5 ** (1 / 3), rel=1e-3, abs=0)


def test_decreasing_spline_is_rejected_with_its_radius() -> None:
    """A single cubic through four points, whose slope is lowest where f'' is zero."""
    r = np.array([0.0, 0.1, 0.8, 1.0])
    f = np.array([0.0, 0.063, 0.076, 0.3])
    cubic = np.polynomial.Polynomial.fit(r, f, 3).convert()
    lowest = float(cubic.deriv(2).roots()[0])
    assert 0.1 < lowest < 0.8
    assert cubic.deriv()(lowest) < 0
    with pytest.raises(InputError, match="f falls at radius") as refused:
        Tabulated(r, f, "cubic")
    assert refused.value.path == ("profile",)
    (notice,) = Tabulated(r, f).notices
    assert notice.code == "interpolation"
    for text in (str(refused.value), notice.message):
        (radius,) = re.findall(r"falls at radius (\S+)", text)
        assert float(radius) == pytest.approx(lowest, rel=1e-10, abs=0)


@pytest.mark.parametrize("rise", [1e-3, 1e-9])
def test_monotonic_spline_is_accepted(rise: float) -> None:
    """f = (u - 1/2)^3 + rise u has its lowest slope, `rise`, midway between two points."""
    r = np.linspace(0, 1, 6)
    profile = Tabulated(r, (r - 0.5) ** 3 + 0.125 + rise * r, "cubic")
    assert float(profile.df(np.array(0.5))) == pytest.approx(rise, rel=1e-6, abs=1e-12)


def test_contact_smaller_than_the_flat_is_rejected() -> None:
    r = np.array([0.0, 0.2, 0.4, 0.6, 0.8])
    profile = Tabulated(r, np.maximum(r - 0.4, 0.0))
    with pytest.raises(InputError, match="smaller than the flat") as refused:
        solve(profile, 1.0, contact_radius=[0.5, 0.4 * (1 - 1e-15)])
    assert refused.value.path == ("load", "contact_radius", 1)
    assert solve(profile, 1.0, contact_radius=0.4).normal_force == 0


def test_domain_ends_where_the_contact_is_not_a_disc() -> None:
    """f = 1 - exp(-r^2): g = 2 x D(x) with Dawson's integral, largest at x = 1.50197526668."""
    r = np.linspace(0, 2.0, 401)
    profile = Tabulated(r, -np.expm1(-r * r))
    # The radius at which g(2) is first reached [mpmath, findroot].
    assert profile.domain == pytest.approx(1.17659837048667, rel=1e-8, abs=0)
    for load in ({"contact_radius": 1.18}, {"indentation_depth": 1.21}, {"normal_force": 2.0}):
        with pytest.raises(InputError, match=r"beyond radius 1\.17659"):
            solve(profile, 1.0, **load)
    # g(1) = 2 D(1).
    contact = solve(profile, 1.0, contact_radius=1.0)
    assert contact.indentation_depth == pytest.approx(1.0761590138255368, rel=1e-8, abs=0)
    assert not contact.warnings or "rough_table" not in {one.code for one in contact.warnings}


def test_capped_paraboloid_with_blunter_flank_is_rejected_beyond_the_cap() -> None:
    """The slope drops at b = 0.5: g(b) = b^2, and g decreases to 0.2183 beyond it."""
    r = np.linspace(0, 2.0, 41)
    f = np.where(r < 0.5, r * r / 2, 0.125 + (r * r - 0.25) / 6)
    profile = Tabulated(r, f, "cubic", (0.5,))
    assert 0.46 < profile.domain < 0.5
    solve(profile, 1.0, contact_radius=0.46)
    with pytest.raises(InputError, match="ceases to be admissible"):
        solve(profile, 1.0, contact_radius=0.6)


@pytest.mark.parametrize("flat", [0.0, 0.3])
def test_two_and_five_points(flat: float) -> None:
    """Linear tables with few points: a cone, a truncated cone, and a steep flank beyond a flat."""
    r = np.array([0.0, flat, 1.0]) if flat else np.array([0.0, 1.0])
    f = np.maximum(r - flat, 0.0)
    for loads in ({"contact_radius": [flat, 0.5, 1.0]}, {"normal_force": [0.0, 1e-3, 0.5]}):
        contact = solve(Tabulated(r, f, "linear"), 1.0, **loads)
        a = contact.contact_radius
        s, phi = np.sqrt((a - flat) * (a + flat)), np.arccos(flat / np.where(a > 0, a, 1.0))
        depth, force = a * phi, a * a * phi + flat * s
        assert contact.indentation_depth == pytest.approx(depth, rel=1e-7, abs=0)
        assert contact.normal_force == pytest.approx(force, rel=1e-7, abs=0)
        for x in (0.0, 0.1 * flat, flat, 0.4):
            assert not np.isnan(fields.pressure(contact, [x])).any()


def test_resolved_table_can_be_pickled() -> None:
    r = np.linspace(0, END, 201)
    profile = Tabulated(r, r * r / 2)
    with pytest.raises(ValueError, match="read-only"):
        profile.r[0] = 1.0
    copy = pickle.loads(pickle.dumps(profile))  # noqa: S301 - our own bytes
    assert len(pickle.dumps(profile.resolved)) < 300_000
    x = np.linspace(0.01, 0.6, 50)
    np.testing.assert_array_equal(copy.g(x), profile.g(x))


def rough(seed: int) -> Tabulated:
    """A parabola with noise, whose heights are ordered, as instruments deliver it."""
    rng = np.random.default_rng(seed)
    count, noise = int(rng.integers(12, 60)), 10 ** rng.uniform(-4, -2.3)
    r = np.linspace(0.0, 1.0, count)
    f = np.sort(np.append(0.0, np.maximum(r[1:] ** 2 + noise * rng.normal(size=count - 1), 0.0)))
    return Tabulated(tuple(r), tuple(0.1 * f), ("linear", "pchip", "auto")[seed % 3])


@pytest.mark.parametrize("seed", range(24))
def test_equivalent_profile_of_a_rough_table_never_falls(seed: int) -> None:
    """Not even between the points at which falls are searched for."""
    body = rough(seed)
    g = body.g(np.linspace(0.0, body.domain, 20_001))
    assert (np.diff(g) >= -1e-11 * g.max()).all()


def test_depth_beyond_a_plateau_is_that_of_the_flanks() -> None:
    """Beyond a plateau g is the sum of the steps of the slope again: Σ Jᵢ x arccos(rᵢ/x)."""
    r = np.array([0.0, 0.1482, 0.2277, 0.9474, 0.9689, 1.0])
    # A step down of the slope makes g fall beyond each radius.
    f = np.array([0.0, 0.0131, 0.0194, 0.0724, 0.0743, 0.0771])
    slope = np.diff(f) / np.diff(r)
    jumps = np.append(slope[0], np.diff(slope))
    body = Tabulated(tuple(r), tuple(f), "linear")
    end = float(body.resolved.plateaus[1, 1])
    for x in (end * (1 + 1e-6), 0.3, 0.5, 0.8):
        depth = sum(j * x * np.arccos(b / x) for j, b in zip(jumps, r, strict=False) if b < x)
        contact = solve(body, 1.0, contact_radius=x)
        assert float(contact.indentation_depth) == pytest.approx(depth, rel=2e-14, abs=0)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("control", ["tangential_force", "tangential_displacement"])
def test_contact_radius_on_a_plateau_has_the_load_of_its_inner_end(control: str, seed: int) -> None:
    body = rough(seed)
    plateaus = body.resolved.plateaus
    plateaus = plateaus[plateaus[:, 1] < body.domain]
    for share in (0.0, 1e-16, 1e-12, 1e-3, 0.5, 1 - 1e-9, 1 - 1e-14):
        for begin, end in plateaus[:4]:
            contacts = [
                solve(body, 1.0, contact_radius=begin + part * (end - begin)) for part in (0, 0.4)
            ]
            limit = "normal_force" if control == "tangential_force" else "indentation_depth"
            size = 0.3 * share * float(getattr(contacts[0], limit))
            inner, plateau = (
                tangential.solve(each, 1.0, 0.3, **{control: size}) for each in contacts
            )
            assert float(plateau.dissipated_energy) == float(inner.dissipated_energy) >= 0
            assert float(plateau.tangential_force) == float(inner.tangential_force) >= 0
            assert float(plateau.tangential_displacement) >= 0
            a, c = float(contacts[1].contact_radius), float(plateau.stick_radius)
            assert float(plateau.slip_width) == pytest.approx(a - c, rel=0, abs=1e-14)
            assert (share > 0) == (float(plateau.slip_width) > 0)


def test_slip_front_jumps_across_a_plateau() -> None:
    """On a plateau the width of the slip annulus grows without a force."""
    rng = np.random.default_rng(1)
    r = np.linspace(0.0, 1.0, 200)
    f = np.sort(np.append(0.0, np.maximum(r[1:] ** 2 + 1e-3 * rng.normal(size=199), 0.0)))
    body = Tabulated(tuple(r), tuple(f))
    inner, outer = body.resolved.plateaus[:-1].T
    within = outer < body.domain
    # So far beyond each plateau that a push just crosses it, and one that does not.
    contact = solve(body, 1.0, contact_radius=outer[within] * (1 + 6e-4))
    for share in (0.97, 0.99, 1.01, 1.03):
        plateau = solve(body, 1.0, contact_radius=inner[within])
        force = 0.3 * share * (contact.normal_force - plateau.normal_force)
        pushed = tangential.solve(contact, 0.8, 0.3, tangential_force=force)
        assert pushed.tangential_force == pytest.approx(force, rel=1e-9, abs=0)
        beyond = pushed.stick_radius > outer[within] * (1 - 1e-9)
        assert (beyond == (share < 1)).all()
