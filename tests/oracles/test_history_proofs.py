"""The exact histories of the banks are those of single springs, and have their closed forms."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from mpmath import mp, mpf

from tests.core.test_history_paths import DEPTH, MATERIAL, PROFILES
from tests.oracles import slip_reference as slip
from tests.oracles.history_reference import follow, history

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Array = NDArray[np.float64]
    Path = Sequence[tuple[float, float]]

pytestmark = pytest.mark.long

#: Exact up to the quadratures of int g^2 dx.
PROOF = mpf(10) ** -35
DISSIPATED = "dissipated_energy"
few = pytest.mark.parametrize("name", ["paraboloid", "truncated-cone", "sphere", "flat-punch"])


def full_slip_displacement(depth: float) -> float:
    """mu E*/G* d: displacement of full slip (Eq. 5.17)."""
    return MATERIAL.mu * MATERIAL.e_star / MATERIAL.g_star * depth


def random_path(seed: int, load_steps: int) -> Path:
    """Includes separations and some purely normal or purely tangential load steps."""
    random = np.random.default_rng(seed)
    path, d, u = [], 0.0, 0.0
    for kind in random.integers(0, 5, load_steps):
        d = d if kind == 0 else float(DEPTH * random.uniform(-0.1, 1.0))
        u = u if kind == 1 else float(full_slip_displacement(DEPTH) * random.uniform(-1.2, 1.2))
        path.append((d, u))
    return path


def same(left: mpf, right: mpf) -> bool:
    return bool(abs(left - right) <= PROOF * abs(right))


@pytest.mark.parametrize("name", ["paraboloid", "rounded-cone", "truncated-cone"])
def test_sums_over_springs_converge_to_the_exact_history(name: str) -> None:
    path, count = random_path(5, 7), 500
    exact = history(PROFILES[name], path, MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        body = slip.ShapeBody(PROFILES[name])
        edge = body.radius("indentation_depth", mpf(max(d for d, _ in path)))
        width = edge / count
        springs = [follow(body.g((i + mpf(0.5)) * width), path, MATERIAL) for i in range(count)]
        for name_, rows in (("tangential_force", "load"), ("dissipated_energy", "dissipated")):
            sums = [
                2 * width * mp.fsum(row)
                for row in zip(*(getattr(s, rows) for s in springs), strict=True)
            ]
            expected = [getattr(sample, name_) for sample in exact]
            size = max(map(abs, expected))
            assert all(abs(a - b) < 1e-3 * size for a, b in zip(sums, expected, strict=True))


@pytest.mark.parametrize("name", [name for name in PROFILES if name != "flat-punch"])
@pytest.mark.parametrize("rho", [0.07, 0.8])
def test_first_loading_is_partial_slip(name: str, rho: float) -> None:
    """Eqs. (5.19), (5.20), and the dissipated energy as the integral over the annulus."""
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(PROFILES[name], "indentation_depth", DEPTH, MATERIAL)
    known = slip.solve(at, "tangential_displacement", rho * full_slip_displacement(DEPTH)).values
    computed = history(
        PROFILES[name], [(DEPTH, 0.0), (DEPTH, rho * full_slip_displacement(DEPTH))], MATERIAL
    )[-1]
    with mp.workdps(slip.WORK_DIGITS):
        assert same(computed.tangential_force, known["tangential_force"])
        factor = 2 * (at.mu * at.e_star) ** 2 / at.g_star
        assert same(computed.dissipated_energy, factor * slip.overlap(at, known["stick_radius"]))
        assert same(computed.dissipated_energy, known[DISSIPATED])


def cycle(name: str, amplitude: float) -> tuple[mpf, mpf]:
    """Energy dissipated per cycle of u between -amplitude and amplitude, and the largest force."""
    path = [(DEPTH, u) for u in (0.0, amplitude, -amplitude, amplitude)]
    computed = history(PROFILES[name], path, MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        return computed[3].dissipated_energy - computed[1].dissipated_energy, computed[
            1
        ].tangential_force


@pytest.mark.parametrize("rho", [1e-6, 0.3, 1 - 1e-9])
def test_cycle_of_a_power_law(rho: float) -> None:
    """Mindlin and Deresiewicz for the paraboloid, and the other closed forms."""
    amplitude = rho * full_slip_displacement(DEPTH)
    with mp.workdps(slip.WORK_DIGITS):
        e_star, g_star, mu = mpf(MATERIAL.e_star), mpf(MATERIAL.g_star), mpf(MATERIAL.mu)
        front = mu**2 * e_star**2 / g_star
        rest = mpf(DEPTH) - mpf(amplitude) * g_star / (mu * e_star)
        big, t = mpf(PROFILES["paraboloid"]["radius"]), mpf(PROFILES["cone"]["slope"])
        a, c = mp.sqrt(big * mpf(DEPTH)), mp.sqrt(big * rest)
        factored = 16 * front / (15 * big**2) * (a - c) ** 3 * (a**2 + 3 * a * c + c**2)
        dissipated, force = cycle("paraboloid", amplitude)
        assert same(dissipated, factored)
        normal = 4 * e_star * a**3 / (3 * big)
        part = force / (mu * normal)
        bracket = 1 - (1 - part) ** (mpf(5) / 3) - 5 * part / 6 * (1 + (1 - part) ** (mpf(2) / 3))
        assert same(dissipated, 18 * mu**2 * normal**2 / (5 * a * g_star) * bracket)
        a, c = (2 * depth / (mp.pi * t) for depth in (mpf(DEPTH), rest))
        assert same(cycle("cone", amplitude)[0], mp.pi**2 * front * t**2 / 3 * (a - c) ** 3)


@few
def test_cycle_is_four_first_loadings(name: str) -> None:
    if name == "flat-punch":
        return
    for rho in (1e-6, 0.4):
        amplitude = rho * full_slip_displacement(DEPTH)
        with mp.workdps(slip.WORK_DIGITS):
            at = slip.setting(PROFILES[name], "indentation_depth", DEPTH, MATERIAL)
            known = 4 * slip.solve(at, "tangential_displacement", amplitude).values[DISSIPATED]
            # A small dissipated energy is a third difference of quadratures with 42 digits.
            assert abs(cycle(name, amplitude)[0] - known) < PROOF / mpf(rho) ** 3 * known


@few
def test_full_slip_dissipates_friction_times_sliding_distance(name: str) -> None:
    """W = 4 mu F_N u0 - (8 mu^2 E*^2/G*) int (d - g)^2 dx, the integral from the normal energy."""
    amplitude = 1.7 * full_slip_displacement(DEPTH)
    dissipated, force = cycle(name, amplitude)
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(PROFILES[name], "indentation_depth", DEPTH, MATERIAL)
        assert same(force, at.mu * at.e_star * at.n)
        edge = at.body.b if at.body.blunt else mpf(0)
        missing = mpf(0) if at.flat_punch else slip.overlap(at, edge)
        # int (d - g)^2 = d int (d - g) - int (d - g) g.
        square = at.depth * at.n / 2 - missing
        loop = 4 * force * mpf(amplitude) - 8 * (at.mu * at.e_star) ** 2 / at.g_star * square
        assert same(dissipated, loop)


def virgin(at: slip.Setting, u: mpf) -> mpf:
    c = slip.stick_radius(at, "tangential_displacement", u)
    return at.mu * at.e_star * (at.n - at.body.force(c))


def test_unloading_is_the_virgin_curve_scaled_by_two() -> None:
    with mp.workdps(slip.WORK_DIGITS):
        at = slip.setting(PROFILES["sphere"], "indentation_depth", DEPTH, MATERIAL)
        top, back = 0.8 * full_slip_displacement(DEPTH), 0.3 * full_slip_displacement(DEPTH)
        computed = history(
            PROFILES["sphere"], [(DEPTH, 0.0), (DEPTH, top), (DEPTH, back)], MATERIAL
        )
        assert same(computed[1].tangential_force, virgin(at, mpf(top)))
        fall = 2 * virgin(at, (mpf(top) - mpf(back)) / 2)
        assert same(computed[2].tangential_force, computed[1].tangential_force - fall)


@few
@pytest.mark.parametrize("direction", [1, -1])
def test_oblique_loading_sticks_and_shifts_the_friction_limit(name: str, direction: int) -> None:
    """Slope beta < mu from first contact on, then Cattaneo and Mindlin with mu -+ beta."""
    beta = 0.5 * MATERIAL.mu
    u = beta * MATERIAL.e_star / MATERIAL.g_star * DEPTH
    more = direction * 0.2 * full_slip_displacement(DEPTH)
    computed = history(PROFILES[name], [(DEPTH, u), (DEPTH, u + more)], MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        assert computed[0].dissipated_energy == 0
        slope = mpf(u) / mpf(DEPTH) * mpf(MATERIAL.g_star) / mpf(MATERIAL.e_star)
        assert same(computed[0].tangential_force, slope * computed[0].normal_force)
        left = mpf(MATERIAL.mu) - direction * slope
        at = slip.setting(PROFILES[name], "indentation_depth", DEPTH, MATERIAL)
        at = slip.Setting(
            at.body, at.a, at.depth, at.n, at.e_star, at.g_star, left, at.load_rate, at.load
        )
        moved = abs(mpf(u + more) - mpf(u))
        step = 2 * at.g_star * at.a * moved if at.flat_punch else virgin(at, moved)
        expected = computed[0].tangential_force + direction * step
        assert same(computed[1].tangential_force, expected)


@few
def test_normal_load_at_constant_displacement(name: str) -> None:
    """Increasing: no slip. Decreasing: the force of first loading at the lower load."""
    u = 0.3 * full_slip_displacement(DEPTH)
    computed = history(PROFILES[name], [(DEPTH / 2, 0.0), (DEPTH / 2, u), (DEPTH, u)], MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        assert same(computed[2].tangential_force, computed[1].tangential_force)
        assert computed[2].dissipated_energy == computed[1].dissipated_energy
    computed = history(PROFILES[name], [(DEPTH, 0.0), (DEPTH, u), (DEPTH / 2, u)], MATERIAL)
    direct = history(PROFILES[name], [(DEPTH / 2, 0.0), (DEPTH / 2, u)], MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        assert same(computed[2].tangential_force, direct[1].tangential_force)


@few
def test_separation_erases_slip_memory(name: str) -> None:
    """The contact is re-established at its current place, half-way through this load step."""
    u = 0.4 * full_slip_displacement(DEPTH)
    computed = history(PROFILES[name], [(DEPTH, u), (-DEPTH, 2 * u), (DEPTH, 3 * u)], MATERIAL)
    fresh = history(PROFILES[name], [(DEPTH, 3 * u - 2.5 * u)], MATERIAL)
    with mp.workdps(slip.WORK_DIGITS):
        assert computed[1].tangential_force == computed[1].tangential_energy == 0
        # 3 u and 2.5 u are rounded doubles.
        exact = fresh[0].tangential_force
        assert abs(computed[2].tangential_force - exact) < mpf(10) ** -15 * exact
