"""Moduli and contact points of measured curves lie within their intervals."""

from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core import fit
from mdr_core.profiles import Profile

Array = np.ndarray
#: The unit of length is a typical radius of curvature. Depths reach 0.01.
SHAPES: dict[str, Profile] = {
    "paraboloid": mdr.Paraboloid(1.0),
    "sphere": mdr.Sphere(0.5),
    "cone": mdr.Cone(0.3),
    "power": mdr.Power(2.0, 3.0),
    "hyperboloid": mdr.Hyperboloid(0.4, 0.02),
    "rounded cone": mdr.RoundedCone(0.3, 0.02),
    "rounded punch": mdr.RoundedPunch(0.05, 1.0),
    "flat punch": mdr.FlatPunch(0.1),
}
ALL = ("e_star", "contact_point", "force_offset")
E_STAR, D_0, F_0 = 3.0, 2.3e-3, 1e-5
DEPTH = np.linspace(-5e-3, 1e-2, 200)


def forces(profile: Profile, depth: Array = DEPTH) -> Array:
    pressed = np.maximum(depth - D_0, 0.0)
    return np.asarray(mdr.normal.solve(profile, E_STAR, indentation_depth=pressed).normal_force)


def fitted(profile: Profile, force: Array, **given: Any) -> fit.Fit:
    return fit.solve(profile, indentation_depth=DEPTH, normal_force=force, **given)


@pytest.mark.parametrize("shape", SHAPES)
def test_exact_curve_returns_its_parameters(shape: str) -> None:
    force = forces(SHAPES[shape])
    offset = 0.1 * force.max()
    found = fitted(SHAPES[shape], force + offset, fit=ALL)
    assert found.e_star == pytest.approx(E_STAR, rel=1e-9, abs=0)
    assert found.contact_point == pytest.approx(D_0, rel=1e-9, abs=0)
    assert found.force_offset == pytest.approx(offset, rel=1e-9, abs=0)
    assert found.residual == pytest.approx(0, abs=1e-11 * force.max())
    assert [notice.code for notice in found.warnings if notice.code == "misfit"] == []


W = 2e-4
#: Contact radius -> depth and F/E* without adhesion, in closed form.
REFERENCES = {
    "paraboloid": lambda a: (a**2, 4 / 3 * a**3),
    "cone": lambda a: (np.pi / 2 * 0.3 * a, np.pi / 2 * 0.3 * a**2),
    "sphere": lambda a: (
        a * np.arctanh(2 * a),
        (a**2 + 0.25) * np.arctanh(2 * a) - a / 2,
    ),
}


def jkr(shape: str, radii: Array) -> tuple[Array, Array]:
    """Depth and force of JKR, from 20 points after the pull-off."""
    depth, force = REFERENCES[shape](radii)
    step = np.sqrt(2 * np.pi * radii * W / E_STAR)
    d, f = depth - step, E_STAR * (force - 2 * radii * step)
    return np.append(np.linspace(-0.1, -0.06, 20), d) + D_0, np.append(np.zeros(20), f) + F_0


# The pull-off of the cone is at a = 4.2e-3 under a force, at 4.7e-4 under the depth of a stiff
# instrument; those of the ball at 0.062 and 0.030.
@pytest.mark.parametrize(
    ("given", "shape", "least"),
    [
        ("ball", "paraboloid", 0.062),
        ("sphere", "sphere", 0.04),
        ("known modulus", "cone", 3e-3),
        ("stiff instrument", "cone", 4.8e-4),
    ],
)
def test_exact_adhesive_curve_returns_its_parameters(given: str, shape: str, least: float) -> None:
    depth, force = jkr(shape, np.geomspace(least, 0.15, 60))
    known = {"e_star": E_STAR} if given == "known modulus" else {}
    names = [*ALL, "work_of_adhesion"][len(known) :]
    found = fit.solve(
        SHAPES[shape], indentation_depth=depth, normal_force=force, fit=names, **known
    )
    expected = {"e_star": E_STAR, "contact_point": D_0, "force_offset": F_0, "work_of_adhesion": W}
    for name, value in expected.items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-7, abs=0), name
    assert found.residual == pytest.approx(0, abs=1e-10 * force.max())
    assert isinstance(found.normal, mdr.adhesion.AdhesiveContact)


def test_pull_off_of_a_flat_punch_is_no_fit() -> None:
    with pytest.raises(mdr.InputError, match="only the pull-off of a flat punch"):
        fitted(
            SHAPES["flat punch"], forces(SHAPES["flat punch"]), fit=["work_of_adhesion"], e_star=1
        )


def test_tip_on_which_adhesion_has_no_pull_off_is_no_fit() -> None:
    depth, force = jkr("paraboloid", np.geomspace(0.062, 0.15, 20))
    names = ["e_star", "work_of_adhesion"]
    with pytest.raises(mdr.InputError, match="does not rise as on this profile"):
        fit.solve(mdr.Power(1.0, 0.4), indentation_depth=depth, normal_force=force, fit=names)


@pytest.mark.parametrize("sign", [0, -1])
def test_curves_without_a_rise_are_no_adhesive_contact(sign: int) -> None:
    force = sign * forces(SHAPES["paraboloid"])
    with pytest.raises(mdr.InputError, match=r"in contact, 0: measure deeper|does not rise"):
        fitted(SHAPES["paraboloid"], force, fit=["e_star", "work_of_adhesion"])


#: Contact radii of adhesive curves, and their pull-off force and depth in closed form.
NOISY = {
    "paraboloid": (
        *(np.geomspace(0.055, 0.15, 80), 1.5 * np.pi * W),
        -0.75 * (np.pi * W / E_STAR) ** (2 / 3),
    ),
    "cone": (
        *(np.geomspace(4e-3, 2e-2, 80), 54 * W**2 / (np.pi * E_STAR * 0.3**3)),
        -W / (E_STAR * 0.3),
    ),
}


def off_by(shape: str, noise: float, seed: int, curves: int) -> Array:
    """Errors over their standard deviations, for noise given over the pull-off force."""
    radii, pull_off, lowest = NOISY[shape]
    depth, force = jkr(shape, radii)
    depth[:20] = np.linspace(3, 1.6, 20) * lowest + D_0
    names, random = (*ALL, "work_of_adhesion"), np.random.default_rng(seed)
    rows = []
    for _ in range(curves):
        noisy = force + noise * pull_off * random.standard_normal(force.size)
        found = fit.solve(SHAPES[shape], indentation_depth=depth, normal_force=noisy, fit=names)
        values = np.array([getattr(found, name) for name in names]) - [E_STAR, D_0, F_0, W]
        rows.append(values / found.standard_errors)
    return np.array(rows)


@pytest.mark.long
def test_points_after_the_pull_off_are_not_left_out_in_noise() -> None:
    """Without them, offset, adhesion and contact point of a cone compensate within noise."""
    assert np.abs(off_by("cone", 0.01, seed=1, curves=2)).max() < 4


@pytest.mark.long
@pytest.mark.parametrize(("shape", "noise"), [("paraboloid", 0.05), ("cone", 0.01)])
def test_intervals_cover_the_work_of_adhesion(shape: str, noise: float) -> None:
    off = off_by(shape, noise, seed=4, curves=20)
    assert np.sum(np.abs(off) > 1.984) <= 12
    assert 0.7 < np.std(off) < 1.3


@pytest.mark.parametrize("order", ["descending", "shuffled", "no approach"])
def test_order_and_approach_change_nothing(order: str) -> None:
    profile, index = SHAPES["hyperboloid"], np.arange(DEPTH.size)
    index = {
        "descending": index[::-1],
        "shuffled": np.random.default_rng(0).permutation(index),
        "no approach": index[DEPTH > D_0 + 1e-3],
    }[order]
    found = fit.solve(
        profile, indentation_depth=DEPTH[index], normal_force=forces(profile)[index], fit=ALL
    )
    assert found.e_star == pytest.approx(E_STAR, rel=1e-8, abs=0)
    assert found.contact_point == pytest.approx(D_0, rel=1e-8, abs=0)


def test_standard_errors_of_the_modulus_alone() -> None:
    # A regression through the origin: sigma/sqrt(sum of squares).
    profile = SHAPES["cone"]
    force = forces(profile, DEPTH + D_0)
    random = np.random.default_rng(3)
    noisy = force + 0.01 * force.max() * random.standard_normal(force.size)
    reduced = force / E_STAR
    found = fitted(profile, noisy, fit=["e_star"])
    expected = reduced @ noisy / (reduced @ reduced)
    assert found.e_star == pytest.approx(expected, rel=1e-12, abs=0)
    sigma = np.sqrt(np.sum((noisy - expected * reduced) ** 2) / (force.size - 1))
    assert found.noise == pytest.approx(sigma, rel=1e-9, abs=0)
    error = sigma / np.sqrt(reduced @ reduced)
    assert found.standard_errors.tolist() == pytest.approx([error], rel=1e-9, abs=0)
    assert found.contact_point == found.force_offset == 0.0


def test_known_modulus_leaves_the_contact_point() -> None:
    profile = SHAPES["sphere"]
    found = fitted(profile, forces(profile), fit=["contact_point"], e_star=E_STAR)
    assert found.contact_point == pytest.approx(D_0, rel=1e-9, abs=0)
    assert found.correlation.tolist() == [[pytest.approx(1.0, rel=1e-9, abs=0)]]


def test_correlation_of_modulus_and_contact_point() -> None:
    # Of F ~ d^m and its slope at equal steps of d: a guessed contact point misleads.
    random = np.random.default_rng(1)
    for shape, exact in (("paraboloid", np.sqrt(8) / 3), ("cone", np.sqrt(15) / 4)):
        force = forces(SHAPES[shape])
        noisy = force + 0.01 * force.max() * random.standard_normal(force.size)
        found = fitted(SHAPES[shape], noisy)
        assert found.correlation[0, 1] == pytest.approx(exact, rel=0, abs=5e-3)


def study(shape: Profile, fitted_shape: Profile, noise: float, curves: int) -> Array:
    """Errors over their standard deviations, and whether each misfit is reported."""
    force, rows = forces(shape), []
    random = np.random.default_rng(int(1e4 * noise))
    for _ in range(curves):
        noisy = force + noise * force.max() * random.standard_normal(force.size)
        found = fitted(fitted_shape, noisy + F_0, fit=ALL)
        values = np.array([found.e_star, found.contact_point, found.force_offset])
        off = (values - [E_STAR, D_0, F_0]) / found.standard_errors
        rows.append([*off, found.misfit < 0.01])
    return np.array(rows)


@pytest.mark.long
@pytest.mark.parametrize("noise", [0.003, 0.03])
@pytest.mark.parametrize("shape", SHAPES)
def test_intervals_cover_the_parameters(shape: str, noise: float) -> None:
    rows = study(SHAPES[shape], SHAPES[shape], noise, 200)
    covered = np.mean(np.abs(rows[:, :3]) < 1.972, axis=0)
    # 0.95 with a standard deviation of 0.015.
    assert covered.min() >= 0.90, covered
    assert covered.max() <= 0.995, covered
    assert rows[:, 3].mean() <= 0.035


# What was measured, and what is fitted to it.
WRONG = {
    "cone as paraboloid": ("cone", "paraboloid"),
    "paraboloid as cone": ("paraboloid", "cone"),
    "rounded cone as paraboloid": ("rounded cone", "paraboloid"),
    "rounded punch as cone": ("rounded punch", "cone"),
    "power as paraboloid": ("power", "paraboloid"),
    "flat punch as paraboloid": ("flat punch", "paraboloid"),
}


@pytest.mark.parametrize("pair", WRONG)
def test_wrong_shape_is_a_misfit(pair: str) -> None:
    shape, guessed = (SHAPES[each] for each in WRONG[pair])
    rows = study(shape, guessed, 0.003, 20)
    assert rows[:, 3].mean() >= 0.95


def test_noise_that_is_known_is_compared() -> None:
    profile = SHAPES["sphere"]
    force = forces(profile)
    random = np.random.default_rng(5)
    noisy = force + 0.01 * force.max() * random.standard_normal(force.size)
    for factor, wrong in ((1.0, False), (0.5, True), (2.0, True)):
        found = fitted(profile, noisy, noise=0.01 * factor * force.max())
        assert (found.misfit < 0.01) == (wrong and factor < 1), factor
        assert found.noise == 0.01 * factor * force.max()


@pytest.mark.parametrize("unit", [1e-30, 1e-9, 1e20])
def test_change_of_units(unit: float) -> None:
    profile, large = mdr.RoundedPunch(0.05, 1.0), mdr.RoundedPunch(0.05 * unit, unit)
    force = forces(profile)
    force = force + 0.01 * force.max() * np.random.default_rng(2).standard_normal(force.size)
    found = fitted(profile, force, fit=ALL)
    other = fit.solve(large, indentation_depth=unit * DEPTH, normal_force=unit**2 * force, fit=ALL)
    assert other.e_star == pytest.approx(found.e_star, rel=1e-7, abs=0)
    assert other.contact_point == pytest.approx(unit * found.contact_point, rel=1e-7, abs=0)
    scale = [1.0, unit, unit**2]
    assert other.standard_errors == pytest.approx(found.standard_errors * scale, rel=1e-6, abs=0)


def test_separation_in_place_of_depth_is_refused() -> None:
    for profile in SHAPES.values():
        for curve in (forces(profile), forces(profile) + 1.0, adhesive(mdr.Paraboloid(1.0), DEPTH)):
            for names in (ALL[:2], ALL):
                with pytest.raises(mdr.InputError, match="of a separation or height") as error:
                    fit.solve(profile, indentation_depth=-DEPTH, normal_force=curve, fit=names)
                assert error.value.path == ("indentation_depth",)


def test_shallow_contact_beneath_noise_is_no_separation() -> None:
    """A tenth of the points is in contact, with forces of the size of single errors."""
    random, profile = np.random.default_rng(3), SHAPES["paraboloid"]
    depth = np.linspace(-0.1, 1e-2, 1000)
    force = forces(profile, depth)
    for _ in range(20):
        noisy = force + random.normal(0, force.max() / 3, depth.size)
        found = fit.solve(profile, indentation_depth=depth, normal_force=noisy)
        assert found.e_star == pytest.approx(E_STAR, rel=0, abs=5 * found.standard_errors[0])


def test_pull_off_alone_is_no_separation() -> None:
    """Three states below zero force, and many points after the pull-off, on any offset."""
    depth = np.append(np.linspace(-4e-2, -4e-3, 60), np.linspace(-1e-3, 2e-4, 12))
    for offset in (-1.0, 0.0, 1.0):
        force = adhesive(mdr.Paraboloid(1.0), depth) + offset
        names = ("e_star", "contact_point", "force_offset", "work_of_adhesion")
        found = fit.solve(
            mdr.Paraboloid(1.0), indentation_depth=depth, normal_force=force, fit=names
        )
        assert found.force_offset == pytest.approx(offset, rel=1e-6, abs=1e-6)


def test_too_few_points_in_contact_are_refused() -> None:
    depth = np.linspace(-1.0, 0.0, 20)
    force = np.zeros(20)
    force[-2:] = 0.5, 1.0
    with pytest.raises(mdr.InputError, match="in contact"):
        fit.solve(mdr.Paraboloid(1.0), indentation_depth=depth, normal_force=force, fit=ALL)


def test_curves_that_leave_parameters_open_are_refused_or_finite() -> None:
    """Noise, constant forces and few points under every shape."""
    random, refused = np.random.default_rng(6), 0
    for profile in SHAPES.values():
        for count, names in ((3, ("e_star",)), (5, ALL[:2]), (7, ALL), (9, ("contact_point",))):
            depth = np.sort(random.uniform(-5e-3, 1e-2, count))
            known = {} if "e_star" in names else {"e_star": E_STAR}
            for force in (random.standard_normal(count), np.ones(count), np.zeros(count)):
                try:
                    found = fit.solve(
                        profile,
                        indentation_depth=depth,
                        normal_force=force,
                        fit=names,
                        **known,
                    )
                except mdr.InputError:
                    refused += 1
                else:
                    assert np.isfinite([found.e_star, *found.standard_errors, found.misfit]).all()
    assert refused


def test_curve_that_is_deeper_than_the_profile_is_refused() -> None:
    table = mdr.Tabulated(np.linspace(0, 0.05, 20), np.linspace(0, 0.05, 20) ** 2)
    with pytest.raises(mdr.InputError, match="beyond the end"):
        fit.solve(
            table, indentation_depth=[0, 0.1, 0.2, 0.3], normal_force=[0, 1, 2, 3.0], fit=["e_star"]
        )


def test_error_of_a_branch_names_the_point_of_the_whole_curve() -> None:
    table = mdr.Tabulated(np.linspace(0, 0.05, 20), np.linspace(0, 0.05, 20) ** 2)
    depth = [0.0, 0.05, 0.1, 0.08, 0.02, 0.0]
    with pytest.raises(mdr.InputError, match="beyond the end") as error:
        fit.solve(
            table,
            indentation_depth=depth,
            normal_force=depth,
            fit=["e_star"],
            segment="unloading",
        )
    assert error.value.path == ("indentation_depth", 3)


def test_misfit_by_an_offset_or_by_adhesion_says_so() -> None:
    profile, depth = mdr.Paraboloid(1.0), np.linspace(-5e-3, 1e-2, 200)
    for force, remedy in (
        (forces(profile) + 1e-3 * forces(profile).max(), "force_offset"),
        (adhesive(profile, depth), "work_of_adhesion"),
    ):
        (misfit,) = (each for each in fitted(profile, force).warnings if each.code == "misfit")
        assert remedy in misfit.message


def adhesive(profile: Profile, depth: Array) -> Array:
    """Forces of a retraction; the pull-off of a ball of radius 1 is 1e-3."""
    energy = 1e-3 / (1.5 * np.pi)
    contact = mdr.adhesion.solve(profile, E_STAR, energy, normal_force=0.0)
    force, pulled = np.zeros_like(depth), depth > float(contact.pull_off_depth)
    contact = mdr.adhesion.solve(profile, E_STAR, energy, indentation_depth=depth[pulled])
    force[pulled] = contact.normal_force
    return force


def test_profile_shorter_than_the_curve_is_said_to_end() -> None:
    short = mdr.Tabulated(np.linspace(0, 1e-2, 21), np.linspace(0, 1e-2, 21) ** 2 / 2)
    with pytest.raises(mdr.InputError, match="profile ends at the depth"):
        fitted(short, forces(mdr.Paraboloid(1.0)))
