"""Random queries of the calibration chart, each with its true error and its stated error.

References are the mpmath oracles of the tests, Lebedev and Ufliand's equation of a layer with 30
digits, and closed forms of curves and loops of power profiles. The draws depend on a seed alone.
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf
from tests.core.comparison import profile_from
from tests.core.random_cases import scene
from tests.oracles import history_generate, history_reference, slip_reference, wear_reference
from tests.oracles import subsurface_generate as beneath
from tests.oracles.layer_reference import DIGITS, LayerContact
from tests.oracles.shapes import shape_of

from mdr_core import (
    InputError,
    Layer,
    Material,
    Power,
    fields,
    fit,
    history,
    hysteresis,
    layer,
    normal,
    subsurface,
    tangential,
)
from mdr_core.wear import limit

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from tests.core.random_cases import Scene

Pair = tuple[float, float]
E_STAR, G_STAR, MU = 1.0, 0.8, 0.4
WORK_DIGITS = slip_reference.WORK_DIGITS
MATERIAL = slip_reference.Material(E_STAR, G_STAR, MU)
CONTROLS = ("tangential_force", "tangential_displacement")
FIELDS = ("pressure", "shear_stress", "slip", "normal_displacement")


def largest_error(found: object, expected: Mapping[str, Any]) -> float:
    """Largest relative error of the members of a result."""
    values = {name: mpf(float(np.ravel(getattr(found, name))[-1])) for name in expected}
    with mp.workdps(WORK_DIGITS):
        return max(
            float(abs(values[name] - truth) / (abs(truth) or 1)) for name, truth in expected.items()
        )


def contact(drawn: Scene) -> tuple[normal.NormalContact, slip_reference.Setting]:
    """A contact of the radius one, and its reference."""
    at = slip_reference.setting(drawn.profile, "contact_radius", 1.0, MATERIAL)
    return normal.solve(drawn.made, E_STAR, contact_radius=1.0), at


def amplitude(at: slip_reference.Setting, control: str, part: float) -> float:
    """A part of the tangential force or displacement of full slip."""
    full = at.mu * at.e_star * at.n if control == "tangential_force" else at.shift * at.depth
    return float(full) * part


def pushed(count: int) -> Iterator[Pair]:
    draw = random.Random(3)
    for _ in range(count):
        drawn = scene(draw)
        pressed, at = contact(drawn)
        control = draw.choice(CONTROLS)
        given = amplitude(at, control, draw.uniform(0.001, 0.999))
        expected = slip_reference.solve(at, control, given).values
        found = tangential.solve(pressed, G_STAR, MU, **{control: given})
        yield largest_error(found, expected), found.error_estimate


def cycles(count: int) -> Iterator[Pair]:
    draw = random.Random(4)
    for _ in range(count):
        drawn = scene(draw)
        _, at = contact(drawn)
        control = draw.choice(CONTROLS)
        given = amplitude(at, control, draw.uniform(0.01, 0.99))
        with mp.workdps(WORK_DIGITS):
            expected = history_generate.loop(at, control, mpf(given))
        loads = {"indentation_depth": float(at.depth), control: given}
        found = history.cycles(drawn.made, E_STAR, G_STAR, MU, **loads, count=2)
        names = ("energy_per_cycle", "secant_stiffness")
        error = largest_error(found, dict(zip(names, expected, strict=True)))
        yield error, found.error_estimate


def paths(count: int, steps: int = 3) -> Iterator[Pair]:
    """Paths with contact; forces and energy relative to their largest values."""
    draw = random.Random(5)
    for number in range(count):
        drawn = scene(draw)
        depth = float(contact(drawn)[1].depth)
        most = MU * E_STAR / G_STAR * depth
        path = history_generate.random_path(f"calibration {number}", steps, depth, most)
        depths, shifts = np.transpose(path)
        if not depths.max() > 0:
            continue
        samples = history_reference.history(drawn.profile, path, MATERIAL)
        loads = {"indentation_depth": depths, "tangential_displacement": shifts}
        found = history.solve(drawn.made, E_STAR, G_STAR, MU, **loads)
        error = 0.0
        for name in ("normal_force", "tangential_force", "dissipated_energy"):
            truth = [getattr(sample, name) for sample in samples]
            if size := max(map(abs, truth)):
                values = zip(getattr(found, name), truth, strict=True)
                error = max(error, *(float(abs(mpf(float(v)) - t) / size) for v, t in values))
        yield error, found.error_estimate


def stresses(count: int) -> Iterator[Pair]:
    """Each field of a contact is a query; its error is relative to its largest value."""
    draw = random.Random(6)
    for _ in range(count // len(FIELDS)):
        drawn = scene(draw)
        pressed, at = contact(drawn)
        slid = tangential.solve(pressed, G_STAR, MU, stick_radius=drawn.stick)
        c, radii = mpf(drawn.stick), drawn.radii[:4]
        truths = {
            "pressure": [slip_reference.traction(at, mpf(0), mpf(r)) for r in radii],
            "shear_stress": [at.mu * slip_reference.traction(at, c, mpf(r)) for r in radii],
            "slip": [slip_reference.slip(at, c, mpf(r)) for r in radii],
            "normal_displacement": [slip_reference.displacement(at, mpf(r)) for r in radii],
        }
        for name, truth in truths.items():
            source = slid if name in ("shear_stress", "slip") else pressed
            values = np.ravel(getattr(fields, name)(source, radii))
            size = max(map(abs, truth))
            if not size:
                continue
            errors = [abs(mpf(float(v)) - t) / size for v, t in zip(values, truth, strict=True)]
            stated = max(fields.own_error(source), 1e-13) + fields.edge_error(source, name, radii)
            yield float(max(errors)), stated


def points_beneath(count: int) -> Iterator[Pair]:
    """Four points on each circle about the axis, which share the potentials of the reference."""
    draw = random.Random(7)
    for number in range(count // 4):
        given = beneath.PROFILES[number % len(beneath.PROFILES)]
        shape = shape_of(given)
        first = max(float(shape.b) if shape.blunt else 0.0, 0.05)
        c = first + (1 - first) * draw.uniform(0.1, 0.999)
        r, z = draw.uniform(0.01, 1.6), 10 ** draw.uniform(-3, 0.5)
        pressed = normal.solve(profile_from(given), E_STAR, contact_radius=1.0)
        slid = tangential.solve(pressed, 0.9, MU, stick_radius=c)
        for x, y in ((r, 0.0), (-r, 0.0), (0.0, r), (0.0, -r)):
            nu = draw.uniform(0, 0.5)
            with mp.workdps(beneath.WORK_DIGITS):
                place = mpf(x), mpf(y), mpf(z)
                truth = beneath.tensor(shape, mpf(1), mpf(c), mpf(MU), mpf(nu), place)
            tensor = np.ravel(subsurface.stress(slid, x, y, z, poissons_ratio=nu, body=2))
            expected = np.array(truth, dtype=float)
            error = np.abs(tensor - expected).max() / np.abs(expected).max()
            yield float(error), subsurface.error_estimate(slid, *map(np.array, (x, y, z)))


def worn(count: int) -> Iterator[Pair]:
    """Limiting states of wear; profiles that end within the worn annulus are drawn again."""
    draw, done = random.Random(8), 0
    while done < count:
        drawn = scene(draw)
        _, at = contact(drawn)
        control = draw.choice(CONTROLS)
        given, depth = amplitude(at, control, draw.uniform(0.05, 0.9)), float(at.depth)
        load = ("indentation_depth", depth)
        try:
            reference = wear_reference.solve(
                drawn.profile, load[0], mpf(depth), MATERIAL, control, mpf(given)
            )
            expected = wear_reference.answers(reference)
            pressed = normal.solve(drawn.made, E_STAR, indentation_depth=depth)
            found = limit.solve(pressed, G_STAR, MU, **{control: given})
        except (ArithmeticError, InputError):
            continue
        done += 1
        yield largest_error(found, expected), found.error_estimate


def layers(count: int) -> Iterator[Pair]:
    """Depth and force of layers at the contact radius one, under four powers."""
    draw = random.Random(9)
    for number in range(count):
        thickness, nu = float(10 ** draw.uniform(-0.17, 2)), draw.uniform(0, 0.5)
        base = draw.choice(["bonded", "frictionless"])
        power = {"kind": "power", "coefficient": 1.0, "exponent": 1.0 + number % 4}
        with mp.workdps(DIGITS):
            truths = LayerContact(power, thickness, base, nu).solved
        material = Material(E_STAR, layer=Layer(thickness, base, nu))
        found = layer.solve(profile_from(power), material, contact_radius=1.0)
        # E* is one.
        expected = {name: truths[name] for name in ("indentation_depth", "normal_force")}
        yield largest_error(found, expected), found.error_estimate


def curves(count: int) -> Iterator[Pair]:
    """Fits of F = E* k (d - d0)^m + F0, half of them with noise.

    Errors are relative to E*, the range of the depths and the largest force.
    """
    rng = np.random.default_rng(10)
    for number in range(count):
        profile, depth = Power(1.0, rng.uniform(0.6, 5.0)), np.linspace(-0.5, 1.0, 60)
        m = 1 + 1 / profile.exponent
        k = float(normal.solve(profile, E_STAR, indentation_depth=1.0).normal_force)
        noise = k * 10 ** rng.uniform(-4, -2) if number % 2 else 0.0
        d_0, offset = rng.uniform(0.01, 0.1), k * rng.uniform(0.01, 0.1)
        force = k * np.maximum(depth - d_0, 0) ** m + offset
        force += noise * rng.standard_normal(depth.size)
        found = fit.solve(
            profile,
            indentation_depth=depth,
            normal_force=force,
            fit=("e_star", "contact_point", "force_offset"),
        )
        expected = least_squares(depth, force, k, m, found.contact_point)
        values = found.e_star, found.contact_point, found.force_offset
        sizes = found.e_star, np.ptp(depth), force.max()
        errors = [float(abs(mpf(v) - t)) for v, t in zip(values, expected, strict=True)]
        yield float(np.max(np.divide(errors, sizes))), found.error_estimate


def least_squares(
    depth: np.ndarray, force: np.ndarray, k: float, m: float, start: float
) -> tuple[mpf, mpf, mpf]:
    """Return E*, d0 and F0 of the least squares, with 30 digits."""
    with mp.workdps(30):
        x, y = [mpf(v) for v in depth], [mpf(v) for v in force]
        factor, power = mpf(k), mpf(m)

        def linear(d_0: mpf) -> tuple[mpf, mpf, mpf]:
            """E*, F0, and the rate of the least squares with d0."""
            basis = [factor * (v - d_0) ** power if v > d_0 else mpf(0) for v in x]
            mean, level = mp.fsum(basis) / len(x), mp.fsum(y) / len(x)
            centred = [b - mean for b in basis]
            e_star = mp.fdot(centred, y) / mp.fdot(centred, centred)
            offset = level - e_star * mean
            rates = [power * b / (v - d_0) if b else b for b, v in zip(basis, x, strict=True)]
            left = [v - e_star * b - offset for v, b in zip(y, basis, strict=True)]
            return e_star, offset, mp.fdot(left, rates)

        d_0 = mp.findroot(lambda v: linear(v)[2], (mpf(start), mpf(start) + mpf(10) ** -9))
        e_star, offset, _ = linear(d_0)
        return e_star, d_0, offset


def loops(count: int) -> Iterator[Pair]:
    """Exact loops of power profiles, by Masing's rule from F = mu F_N (1 - (1 - u/u_max)^m)."""
    rng = np.random.default_rng(11)
    phase = np.linspace(0.5, 4.5, 81) * np.pi
    for _ in range(count):
        profile = Power(1.0, rng.uniform(0.6, 5.0))
        pressed = normal.solve(profile, E_STAR, normal_force=1.0)
        g_star, mu = rng.uniform(0.6, 1.0), rng.uniform(0.1, 0.8)
        full = mu / g_star * float(pressed.indentation_depth)
        largest = full * rng.uniform(0.5, 4.0)

        def loading(u: Any, profile=profile, full=full, mu=mu) -> Any:
            return mu * (1 - np.maximum(1 - u / full, 0.0) ** (1 + 1 / profile.exponent))

        u = largest * np.sin(phase)
        rises = np.cos(phase) > 0
        branch = 2 * loading((largest + np.where(rises, u, -u)) / 2) - loading(largest)
        loop = {"tangential_displacement": u, "tangential_force": np.where(rises, branch, -branch)}
        found = hysteresis.solve(pressed, **loop, rig_compliance=0.0)
        expected = {"g_star": mpf(g_star), "friction_coefficient": mpf(mu)}
        yield largest_error(found, expected), found.error_estimate
