"""A fit names the branch, the noise, the point or the parameter that its curve leaves in doubt."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import mdr_core as mdr
from mdr_core import estimation, fit, residuals

Array = np.ndarray
BALL = mdr.Paraboloid(1.0)
TESTS = ("misfit", "two_branches", "noise_grows", "correlated_noise")


def hertz(depth: Array) -> Array:
    """Force on a ball of radius 1 with E* = 1."""
    return np.asarray(4 / 3 * np.maximum(depth, 0) ** 1.5)


def codes(depth: Array, force: Array, **given: Any) -> set[str]:
    found = fit.solve(BALL, indentation_depth=depth, normal_force=force, **given)
    return {notice.code for notice in found.warnings}


def noise(random: np.random.Generator, force: Array, size: float) -> Array:
    return size * force.max() * random.standard_normal(force.size)


def test_two_branches_are_named() -> None:
    random, found = np.random.default_rng(101), []
    for _ in range(40):
        up, left = np.linspace(0, 1, int(random.integers(30, 200))), random.uniform(0.05, 0.5)
        depth = np.r_[up, up[::-1]]
        force = np.r_[hertz(up), hertz((up[::-1] - left) / (1 - left))]
        size = random.choice([0, 1e-3, 1e-2])
        found.append("two_branches" in codes(depth, force + noise(random, force, size)))
    assert np.mean(found) >= 0.98


def test_message_ends_with_the_cause_and_its_remedy() -> None:
    up = np.linspace(0, 1, 50)
    force = np.r_[hertz(up), hertz((up[::-1] - 0.3) / 0.7)]
    found = fit.solve(
        mdr.Paraboloid(1.0), indentation_depth=np.r_[up, up[::-1]], normal_force=force
    )
    (message,) = [each.message for each in found.warnings if each.code == "two_branches"]
    end = "standard errors do not hold: loading and unloading differ: give the segment to fit"
    assert message.endswith(end)


def test_retraction_of_a_soft_sample_is_named_even_if_sorted() -> None:
    random, found = np.random.default_rng(102), []
    for _ in range(20):
        up, loss = np.linspace(-0.5, 1, 150), random.uniform(0.1, 0.6)
        depth, force = np.r_[up, up[::-1]], np.r_[hertz(up), (1 - loss) * hertz(up[::-1])]
        force[150:] += loss * hertz(up[::-1]) ** 2 / hertz(np.array(1.0))
        force = force + noise(random, force, random.choice([0, 1e-3, 1e-2]))
        order = np.argsort(depth, kind="stable")
        found += [bool(codes(depth, force) & {"two_branches"})]
        found += [bool(codes(depth[order], force[order]) & set(TESTS))]
    assert np.mean(found) >= 0.98


def test_noise_of_one_branch_is_no_warning() -> None:
    random, found = np.random.default_rng(103), []
    for trial in range(200):
        depth = np.linspace(random.uniform(-0.5, 0), 1, int(random.choice([20, 60, 200])))
        if trial % 3:
            depth = depth[::-1] if trial % 3 == 1 else random.permutation(depth)
        force = hertz(depth)
        found.append(bool(codes(depth, force + noise(random, force, 0.01)) & set(TESTS)))
    # 1 % of 200, and three standard deviations of the count.
    assert sum(found) <= 6


def test_correlated_noise_is_named() -> None:
    random, found = np.random.default_rng(104), []
    depth = np.linspace(-0.5, 1, 200)
    for _ in range(20):
        errors = random.standard_normal(200)
        for i in range(1, 200):
            errors[i] += 0.7 * errors[i - 1]
        found.append(bool(codes(depth, hertz(depth) + 0.01 * errors) & set(TESTS)))
    assert np.mean(found) >= 0.95


@pytest.mark.parametrize("names", [("e_star", "contact_point"), fit.PARAMETERS[:3]])
def test_upper_part_of_a_curve_is_right_or_in_doubt(names: tuple[str, ...]) -> None:
    random, silent = np.random.default_rng(105), 0
    for _ in range(100):
        depth = np.linspace(random.uniform(0.5, 0.95), 1, int(random.integers(30, 200)))
        force = hertz(depth)
        noisy = force + noise(random, force, 10 ** random.uniform(-3, -0.8))
        try:
            found = fit.solve(BALL, indentation_depth=depth, normal_force=noisy, fit=names)
        except mdr.InputError:
            continue
        off = np.array([found.e_star - 1, found.contact_point]) / found.standard_errors[:2]
        named = {notice.code for notice in found.warnings} & {"undetermined", *TESTS}
        silent += bool(np.abs(off).max() > 4) and not named
    assert silent == 0


def test_exact_upper_part_is_fitted() -> None:
    depth = np.linspace(0.9, 1, 21)
    found = fit.solve(BALL, indentation_depth=depth, normal_force=hertz(depth))
    assert found.e_star == pytest.approx(1, rel=1e-9, abs=0)
    assert found.contact_point == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("shift", [0.0, 10.0])
def test_offset_and_contact_point_of_a_flat_punch_cannot_be_told_apart(shift: float) -> None:
    depth = np.arange(1.0, 6.0)
    with pytest.raises(mdr.InputError, match=r"contact_point and force_offset.*told apart"):
        fit.solve(
            mdr.FlatPunch(1.0),
            indentation_depth=depth + shift,
            normal_force=2 * depth,
            fit=fit.PARAMETERS[:3],
        )


def test_two_depths_do_not_determine_three_parameters() -> None:
    depth, force = np.repeat([0.5, 1.0], 5), np.repeat([0.4, 1.3], 5)
    force = force + 0.01 * np.random.default_rng(106).standard_normal(10)
    with pytest.raises(mdr.InputError, match="does not determine"):
        fit.solve(BALL, indentation_depth=depth, normal_force=force, fit=fit.PARAMETERS[:3])


@pytest.mark.long
def test_no_adhesion_is_held_at_zero_and_said() -> None:
    random, covered, held = np.random.default_rng(107), [], 0
    names, depth = ("e_star", "work_of_adhesion"), np.linspace(0, 1, 40)
    for _ in range(40):
        force = hertz(depth)
        force = force + noise(random, force, 0.01)
        found = fit.solve(BALL, indentation_depth=depth, normal_force=force, fit=names)
        assert found.standard_errors.min() > 0
        held += "bound" in {notice.code for notice in found.warnings}
        off = np.array([found.e_star - 1, found.work_of_adhesion]) / found.standard_errors
        covered.append(np.abs(off) < 2.02)
    # Noise favours a negative w in half of the curves.
    assert 8 <= held <= 36
    assert np.mean(covered, axis=0).min() >= 0.85


def test_adhesion_alone_is_held_at_zero() -> None:
    depth = np.linspace(0, 1, 40)
    force = hertz(depth) + noise(np.random.default_rng(110), hertz(depth), 0.01)
    found = fit.solve(
        BALL, indentation_depth=depth, normal_force=force + 0.01, fit=["work_of_adhesion"], e_star=1
    )
    assert {"bound"} <= {notice.code for notice in found.warnings}
    assert found.standard_errors.min() > 0


#: Contact radius -> depth and force without adhesion, with E* = 1.
CLOSED = {
    "ball": (BALL, lambda a: (a**2, 4 / 3 * a**3)),
    "cone": (mdr.Cone(0.5), lambda a: (np.pi / 4 * a, np.pi / 4 * a**2)),
}


def retraction(shape: str, c: float, start: float, count: int) -> tuple[Array, Array]:
    """Depths and forces of JKR from a depth to 1, without a contact below the least depth."""
    radii = np.geomspace(1e-4, 3, 100_000)
    depth, force = CLOSED[shape][1](radii)
    depth, force = depth - c * np.sqrt(radii), force - 2 * c * radii**1.5
    least = int(depth.argmin())
    depths = np.linspace(start, 1, count)
    inside = np.interp(depths, depth[least:], force[least:])
    return depths, np.where(depths > depth[least], inside, 0.0)


@pytest.mark.parametrize("shape", CLOSED)
def test_states_that_only_a_stiff_instrument_holds_do_not_bias_the_fit(shape: str) -> None:
    c, names = 0.5, (*fit.PARAMETERS,)
    depth, force = retraction(shape, c, -1.0, 100)
    for seed in range(3):
        noisy = force + noise(np.random.default_rng(seed), force, 0.003)
        found = fit.solve(
            CLOSED[shape][0], indentation_depth=depth, normal_force=noisy + 0.1, fit=names
        )
        values = np.array([getattr(found, name) for name in names])
        off = (values - [1, 0, 0.1, c**2 / (2 * np.pi)]) / found.standard_errors
        assert np.abs(off).max() < 4


def test_errors_with_adhesion_held_at_zero_cover_a_weak_adhesion() -> None:
    c, names = 0.05, ("e_star", "contact_point", "work_of_adhesion")
    depth, force = retraction("cone", c, 0.0, 100)
    off = []
    for seed in range(10):
        noisy = force + noise(np.random.default_rng(seed), force, 0.003)
        found = fit.solve(CLOSED["cone"][0], indentation_depth=depth, normal_force=noisy, fit=names)
        if "bound" in {notice.code for notice in found.warnings}:
            values = np.array([getattr(found, name) for name in names])
            off.append((values - [1, 0, c**2 / (2 * np.pi)]) / found.standard_errors)
    assert off
    assert np.abs(off).max() < 2


@pytest.mark.parametrize(("start", "size"), [(-1.0, 0.03), (0.05, 0.003)])
def test_offset_beside_adhesion_is_determined_by_points_before_contact(
    start: float, size: float
) -> None:
    # The larger noise hides the pull-off.
    depth, force = retraction("ball", 0.05, start, 60)
    for seed in range(8):
        noisy = force + noise(np.random.default_rng(seed), force, size)
        found = fit.solve(
            BALL, indentation_depth=depth, normal_force=noisy + 0.1, fit=fit.PARAMETERS
        )
        warned = "undetermined" in {notice.code for notice in found.warnings}
        assert warned == (start > 0)
        error = found.standard_errors[found.fit.index("force_offset")]
        assert abs(found.force_offset - 0.1) < 4 * error
        assert error < 0.2 or warned


def test_point_that_decides_alone_is_named() -> None:
    # The contact, and a single point far before it, on which the offset rests.
    depth = np.append(-1.0, np.linspace(0.9, 1, 20))
    force = hertz(depth) + noise(np.random.default_rng(108), hertz(depth), 1e-3)
    found = fit.solve(
        BALL, indentation_depth=depth, normal_force=force, fit=("e_star", "force_offset")
    )
    (notice,) = (each for each in found.warnings if each.code == "one_point")
    assert "depth -1:" in notice.message
    # Without the point the offset has the error of the others alone.
    others = fit.solve(
        BALL, indentation_depth=depth[1:], normal_force=force[1:], fit=("e_star", "force_offset")
    )
    growth = others.standard_errors[1] / others.noise / (found.standard_errors[1] / found.noise)
    assert notice.value == pytest.approx(growth, rel=1e-6, abs=0)


def test_directions_ignore_reversals_of_the_noise() -> None:
    up = np.linspace(0, 1, 50)
    depth = np.r_[up, up[::-1]] + 0.005 * np.random.default_rng(109).standard_normal(100)
    signs = residuals.directions(depth)
    assert np.sum(np.diff(signs) != 0) == 1
    assert abs(int(np.argmax(np.diff(signs) != 0)) - 49) <= 3


@pytest.mark.parametrize("names", [("e_star",), ("e_star", "force_offset")])
def test_curve_that_is_met_exactly_has_errors_of_rounding(names: tuple[str, ...]) -> None:
    depth = np.repeat([0.25, 1.0], 3)
    force = np.repeat([1.0, 8.0], 3)
    found = fit.solve(BALL, indentation_depth=depth, normal_force=force, fit=names)
    assert found.standard_errors.min() > 0
    assert found.error_estimate < 1e-12


@pytest.mark.parametrize("indenter", ["rigid", mdr.Body(150e9, 0.2)])
@pytest.mark.parametrize("base", [None, "bonded"])
def test_error_of_the_model_is_that_of_the_fitted_bodies(indenter: Any, base: Any) -> None:
    layer = None if base is None else mdr.Layer(4e-6, base, 0.5)
    depth, probe = np.linspace(0.0, 1e-6, 41), mdr.Paraboloid(5e-6)
    material = mdr.from_bodies([indenter, mdr.Body(2e3, 0.5)], layer=layer)
    solve = mdr.normal.solve if layer is None else mdr.layer.solve
    known = solve(probe, material, indentation_depth=depth)
    found = fit.solve(
        probe,
        indentation_depth=depth,
        normal_force=known.normal_force,
        fit=["e_star"],
        layer=layer,
        poissons_ratio=0.5,
        indenter=indenter,
    )
    assert found.youngs_modulus == pytest.approx(2e3, rel=1e-6, abs=0)
    for name in ("model_error", "model_error_radius", "model_error_pressure"):
        expected = getattr(known, name)[-1]
        assert np.ravel(getattr(found, name)) == pytest.approx([expected], rel=1e-5, abs=0)
    # The curve interpolates a layer, and has no noise that would hide it.
    codes = {each.code for each in found.warnings} - {"misfit"}
    assert codes == {each.code for each in known.warnings}


@pytest.mark.parametrize(
    ("shape", "layer"),
    [(mdr.Paraboloid(1.0), mdr.Layer(1.0, "frictionless")), (mdr.FlatPunch(1.0), None)],
)
def test_misfit_names_parameters_that_can_be_fitted(shape: mdr.Profile, layer: Any) -> None:
    depth = np.linspace(0.0, 0.1, 30)
    # Neither contact has this curve.
    given = {"indentation_depth": depth, "normal_force": depth**3 + depth}
    (found,) = [
        each for each in fit.solve(shape, layer=layer, **given).warnings if each.code == "misfit"
    ]
    assert "force_offset" in found.message
    assert "work_of_adhesion" not in found.message


@pytest.mark.parametrize("exponent", [2.0, 100.0])
def test_fit_warns_of_its_own_error(exponent: float) -> None:
    # The force on a layer is interpolated over the depth, least well under the bluntest powers.
    depth, layer = np.linspace(0.0, 0.01, 60), mdr.Layer(1.0, "frictionless")
    probe = mdr.Power(1.0, exponent)
    material = mdr.from_bodies(["rigid", mdr.Body(1.0, 0.4)], layer=layer)
    force = mdr.layer.solve(probe, material, indentation_depth=depth).normal_force
    given = {"indentation_depth": depth, "normal_force": force, "layer": layer}
    found = fit.solve(probe, fit=["e_star"], **given)
    assert abs(found.e_star / material.e_star - 1) <= found.error_estimate
    is_warned = "accuracy" in {each.code for each in found.warnings}
    assert is_warned == (found.error_estimate > 1e-9) == (exponent > 2)


def test_curve_before_contact_with_a_layer_is_refused() -> None:
    layer = mdr.Layer(thickness=1.0, base="frictionless")
    depth = np.linspace(-2, -1, 20)
    # The interpolated force is not exactly 0 at a depth of 0.
    with pytest.raises(mdr.InputError, match="does not rise"):
        fit.solve(
            BALL, indentation_depth=depth, normal_force=depth + 3, fit=["e_star"], layer=layer
        )


@pytest.mark.parametrize("shape", [mdr.FlatPunch(1.0), mdr.TruncatedCone(1.0, 0.5)])
def test_flat_face_that_is_too_large_for_a_layer_is_refused(shape: mdr.Profile) -> None:
    depth = np.linspace(0, 1e-9, 20)
    with pytest.raises(mdr.InputError, match="of the radius of the flat face"):
        fit.solve(
            shape,
            indentation_depth=depth,
            normal_force=depth,
            fit=["e_star"],
            layer=mdr.Layer(thickness=1e-9, base="frictionless"),
        )


@pytest.mark.long
def test_intervals_cover_all_parameters_without_adhesion() -> None:
    random, covered, curves = np.random.default_rng(111), [], 50
    names, depth = ("e_star", "contact_point", "work_of_adhesion"), np.linspace(0, 1, 24)
    for _ in range(curves):
        force = hertz(depth)
        force = force + noise(random, force, 0.01)
        found = fit.solve(BALL, indentation_depth=depth, normal_force=force, fit=names)
        off = np.array([getattr(found, name) for name in names]) - [1, 0, 0]
        # Quantile of Student's t for 20 degrees of freedom, fewer than those of any of the fits.
        covered.append(np.abs(off) < 2.086 * found.standard_errors)
    # 0.95 less three standard deviations of the count.
    assert np.mean(covered, axis=0).min() >= 0.95 - 3 * np.sqrt(0.95 * 0.05 / curves)


def test_one_depth_beyond_the_least_force_is_refused() -> None:
    depth, force = np.repeat([0.0, 1.0], 6), np.tile([1.0, 2.0, 3.0], 4)
    force[0] = -1.0
    force[6] = -2.0
    names = ("e_star", "work_of_adhesion")
    with pytest.raises(mdr.InputError, match="different depths in contact"):
        fit.solve(BALL, indentation_depth=depth, normal_force=force, fit=names)


@pytest.mark.parametrize("least", [0.0, -1.0])
def test_zero_forces_beyond_the_least_force_are_refused(least: float) -> None:
    force = np.append(least, np.zeros(29))
    with pytest.raises(mdr.InputError, match="told apart"):
        fit.solve(
            mdr.Cone(0.4),
            indentation_depth=np.linspace(-1.0, 1.0, 30),
            normal_force=force,
            fit=("force_offset", "work_of_adhesion"),
            e_star=1.0,
        )


@pytest.mark.parametrize("size", [0.0, 1e-4, 1e-2])
def test_fit_reaches_minimum_to_rounding_error(size: float) -> None:
    depth = np.linspace(-0.1, 0.5, 300)
    force = hertz(depth - 0.01)
    force += noise(np.random.default_rng(1), force, size)
    assert fit.solve(BALL, indentation_depth=depth, normal_force=force).error_estimate < 1e-12


class Scaled(estimation.CurveModel):
    """Forces that are the parameters, with slopes that are not numbers beyond a limit."""

    argument = "indentation_depth"

    def __init__(self, limit: float, *force: float) -> None:
        self.limit, self.force = limit, np.array(force)
        self.fit = tuple("ab"[: len(force)])

    @property
    def best(self) -> dict[str, float]:
        return {}

    def at(self, parameters: dict[str, float]) -> tuple[Array, Array]:
        x = np.array([parameters[name] for name in self.fit])
        return x, np.where(x.max() < self.limit, np.eye(x.size), np.nan)


EVERYWHERE = dict.fromkeys("ab", (-np.inf, np.inf, 1.0))


def test_search_ends_where_residuals_vanish() -> None:
    exact = {"a": 1.0, "b": 2.0}
    assert Scaled(np.inf, 1.0, 2.0).minimum(exact, EVERYWHERE) == exact


def test_step_beyond_the_model_is_not_taken_and_prints_nothing(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    stopped = SimpleNamespace(x=np.zeros(1))
    monkeypatch.setattr(estimation, "least_squares", lambda *_, **__: stopped)
    assert Scaled(0.5, 1.0).minimum({"a": 0.0}, EVERYWHERE) == {"a": 0.0}
    assert capfd.readouterr() == ("", "")
