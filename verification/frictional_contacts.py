"""Partial slip: Cattaneo and Mindlin, load histories of Mindlin and Deresiewicz, CONTACT, wear."""

from collections.abc import Iterator
from typing import Any

from mpmath import acos, asin, cbrt, findroot, gamma, log, mpf, pi, quad, sqrt

from verification.case import QUADRATURE, Case, at, fields, tangential

PATH, HISTORY, FIELD, WEAR = "/v1/tangential", "/v1/tangential/history", "/v1/stress", "/v1/wear"
BALL: dict[str, object] = {"kind": "paraboloid", "radius": 2.0}
MU = mpf(0.3)


def _identical_spheres() -> tuple[dict[str, object], Any, Any, Any]:
    """Two steel spheres in MPa and mm: request, shear modulus, Poisson's ratio, radius a."""
    e, nu, radius, force = mpf(210000), mpf(0.3), mpf(10), mpf(50)
    body = {"youngs_modulus": 210000.0, "poissons_ratio": 0.3}
    request = {
        "profile": {"kind": "paraboloid", "radius": 10.0},
        "material": {"bodies": [body, body]},
        "friction_coefficient": 0.3,
    }
    a = cbrt(3 * force * radius * 2 * (1 - nu**2) / (4 * e))
    return request, e / (2 * (1 + nu)), nu, a


def mindlin() -> Iterator[Case]:
    """Stick radius, displacement and traction of two identical spheres."""
    request, shear, nu, a = _identical_spheres()
    limit = MU * 50
    for ratio in (1e-6, 0.1, 0.5, 0.9, 0.9999):
        force = float(ratio * limit)
        rho = mpf(force) / limit
        body = request | {"load": {"normal_force": 50.0}, "tangential": {"tangential_force": force}}
        c = a * cbrt(1 - rho)
        u = 3 * (2 - nu) * limit / (8 * shear * a) * (1 - (1 - rho) ** (mpf(2) / 3))
        yield Case(
            "cattaneo",
            "sticking circle",
            f"steel on steel, T/(mu N) = {ratio}: stick_radius",
            PATH,
            body,
            at("stick_radius"),
            c,
        )
        yield Case(
            "cattaneo",
            "displacement",
            f"steel on steel, T/(mu N) = {ratio}: tangential_displacement",
            PATH,
            body,
            at("tangential_displacement"),
            u,
            bound=1e-10,
        )
        if ratio == 0.5:
            radii = [float(part * a) for part in (0.0, 0.4, 0.9, 0.99)]
            for i, r in enumerate(map(mpf, radii)):
                peak = 3 * 50 / (2 * pi * a**2)
                inner = c / a * sqrt(1 - (r / c) ** 2) if r < c else 0
                yield Case(
                    "cattaneo",
                    "traction",
                    f"steel on steel: shear_stress at r/a = {float(r / a):.2f}",
                    FIELD,
                    fields(body, "shear_stress", radii),
                    at("shear_stress", 0, i),
                    MU * peak * (sqrt(1 - (r / a) ** 2) - inner),
                    bound=1e-11,
                )


def loops() -> Iterator[Case]:
    """Unloading and reloading branches, residual displacement and the energy of a loop."""
    request, shear, nu, a = _identical_spheres()
    limit = MU * 50
    unit = 3 * (2 - nu) * limit / (8 * shear * a)
    for ratio in (0.05, 0.3, 0.6, 0.95):
        largest = float(ratio * limit)
        rho = mpf(largest) / limit
        # The first point has no tangential load, so that the normal load comes first.
        turns = [0.0, largest, largest / 2, 0.0, -largest / 2, -largest, 0.0]
        path = {"normal": {"normal_force": 50.0}, "tangential": {"tangential_force": turns}}
        body = request | {"history": path}

        def unloading(part: float, rho: Any = rho) -> Any:
            force = rho * mpf(part)
            return unit * (
                2 * (1 - (rho - force) / 2) ** (mpf(2) / 3) - (1 - rho) ** (mpf(2) / 3) - 1
            )

        for i, part in ((2, 0.5), (3, 0.0), (4, -0.5)):
            yield Case(
                "mindlin-deresiewicz",
                "unloading",
                f"T_max/(mu N) = {ratio}, back to {part:+g} T_max: displacement",
                HISTORY,
                body,
                at("tangential_displacement", i),
                unloading(part),
                bound=1e-10,
            )
        yield Case(
            "mindlin-deresiewicz",
            "reloading",
            f"T_max/(mu N) = {ratio}, reloaded to 0: displacement",
            HISTORY,
            body,
            at("tangential_displacement", 6),
            -unloading(0.0),
            bound=1e-10,
        )
        energy = (
            9
            * (2 - nu)
            * limit**2
            / (5 * shear * a)
            * (1 - (1 - rho) ** (mpf(5) / 3) - 5 * rho / 6 * (1 + (1 - rho) ** (mpf(2) / 3)))
        )
        cycles = request | {
            "cycles": {
                "normal": {"normal_force": 50.0},
                "tangential": {"tangential_force": largest},
            }
        }
        yield Case(
            "mindlin-deresiewicz",
            "energy",
            f"T_max/(mu N) = {ratio}: energy_per_cycle",
            HISTORY,
            cycles,
            at("energy_per_cycle"),
            energy,
            bound=1e-10,
        )
    # Rising normal and tangential force in a constant ratio below mu: no slip.
    body = request | {
        "history": {"normal": {"normal_force": [50.0]}, "tangential": {"tangential_force": [10.0]}}
    }
    yield Case(
        "mindlin-deresiewicz",
        "oblique",
        "dT/dN = 0.2 < mu from zero: dissipated_energy",
        HISTORY,
        body,
        at("dissipated_energy", 0),
        0,
        scale=mpf(1e-6),
    )
    u = 3 * (2 - nu) * 10 / (8 * shear * a)
    yield Case(
        "mindlin-deresiewicz",
        "oblique",
        "dT/dN = 0.2 < mu from zero: displacement",
        HISTORY,
        body,
        at("tangential_displacement", 0),
        u,
    )


def contact_example() -> Iterator[Case]:
    """A polyethylene ball on a plane, N and mm: FN = 9.1954 gives a = 1 mm, F_x = 7/8 mu FN."""
    e = 2 * 200.0 * 1.42
    body = {"youngs_modulus": e, "poissons_ratio": 0.42}
    request = {
        "profile": {"kind": "paraboloid", "radius": 50.0},
        "material": {"bodies": [body, body]},
        "load": {"normal_force": 9.1954},
        "friction_coefficient": 0.4,
        "tangential": {"tangential_force": 0.875 * 0.4 * 9.1954},
    }
    # The force is printed with five digits, and the radius goes with its third root.
    printed = {"contact_radius": 1.0, "stick_radius": 0.5, "slip_width": 0.5}
    for quantity, value in printed.items():
        yield Case(
            "kalker",
            "5.2.1.1",
            f"CONTACT's Cattaneo shift: {quantity}",
            PATH,
            request,
            at(quantity),
            value,
            bound=5e-6,
            uncertainty=2e-6,
        )
    # Computed on 19 x 19 elements, slip across the load included.
    computed = {
        "tangential_displacement": 8.155e-3,
        "indentation_depth": 1.998e-2,
        "maximum_pressure": 4.393,
    }
    for quantity, value in computed.items():
        yield Case(
            *("kalker", "full solution", f"CONTACT's Cattaneo shift: {quantity}", PATH),
            *(request, at(quantity), value),
            bound=5e-3,
            uncertainty=5e-3,
        )


def chapter() -> Iterator[Case]:
    """Chapter 5: powers, cone and rounded punch under a tangential load, local slip."""
    for n, c in ((1.0, 0.7), (2.0, 0.3), (3.5, 0.9), (6.0, 0.5)):
        p = mpf(n)
        profile = {"kind": "power", "coefficient": 0.2, "exponent": n}
        request = tangential(profile, {"contact_radius": 1.0}, {"stick_radius": c}, g_star=0.8)
        kappa = sqrt(pi) * mpf("0.5") * p * gamma(p / 2) / gamma((p + 1) / 2)
        normal_force = 2 * p / (p + 1) * kappa * mpf(0.2)
        yield Case(
            "mdr-5",
            "(5.30)",
            f"r^{n:g}, c/a = {c}: tangential_force",
            PATH,
            request,
            at("tangential_force"),
            MU * normal_force * (1 - mpf(c) ** (p + 1)),
            bound=1e-11,
        )
        yield Case(
            "mdr-5",
            "(5.29)",
            f"r^{n:g}, c/a = {c}: tangential_displacement",
            PATH,
            request,
            at("tangential_displacement"),
            MU / mpf(0.8) * kappa * mpf(0.2) * (1 - mpf(c) ** p),
            bound=1e-11,
        )
    for a in (1.01, 1.25, 3.0):
        b, radius, edge = mpf(1), mpf(20), mpf(a)
        profile = {"kind": "rounded_punch", "flat_radius": 1.0, "rounding_radius": 20.0}
        c = (1 + a) / 2
        request = tangential(profile, {"contact_radius": a}, {"stick_radius": c})

        def depth(x: Any, b: Any = b, radius: Any = radius) -> Any:
            return x / radius * (sqrt(x**2 - b**2) - b * acos(b / x))

        def force(x: Any, b: Any = b, radius: Any = radius) -> Any:
            ratio = b / x
            part = (1 - ratio**2 / 4) * sqrt(1 - ratio**2) - 3 * ratio / 4 * acos(ratio)
            return 4 * x**3 / (3 * radius) * part

        rows = (
            ("(5.59)", "indentation_depth", depth(edge)),
            ("(5.61)", "normal_force", force(edge)),
            ("(5.62)", "tangential_displacement", MU * (depth(edge) - depth(mpf(c)))),
            ("(5.65)", "tangential_force", MU * (force(edge) - force(mpf(c)))),
        )
        for equation, quantity, value in rows:
            yield Case(
                "mdr-5",
                equation,
                f"rounded punch, a/b = {a}: {quantity}",
                PATH,
                request,
                at(quantity),
                value,
                bound=1e-10,
            )
    yield from rounded_punch_stresses()
    request = tangential(BALL, {"contact_radius": 1.0}, {"stick_radius": 0.5})
    radii = (0.55, 0.75, 0.99)
    for i, r in enumerate(map(mpf, radii)):
        c = mpf(0.5)
        value = MU / (2 * pi) * ((2 * c**2 - r**2) * acos(c / r) - c * sqrt(r**2 - c**2))
        yield Case(
            "mdr-5",
            "(5.45)",
            f"paraboloid, c/a = 0.5: slip at r/a = {radii[i]}",
            FIELD,
            fields(request, "slip", radii),
            at("slip", 0, i),
            value,
            bound=1e-11,
        )
    request = tangential(
        {"kind": "cone", "slope": 0.1}, {"contact_radius": 1.0}, {"stick_radius": 0.4}
    )
    yield Case(
        "mdr-5",
        "(5.54)",
        "cone, c/a = 0.4: shear_stress on the axis",
        FIELD,
        fields(request, "shear_stress", [0.0]),
        at("shear_stress", 0, 0),
        MU * mpf(0.1) / 2 * log(1 / mpf(0.4)),
        bound=1e-11,
    )


def rounded_punch_stresses() -> Iterator[Case]:
    """Problem 4: pressure and shear stress as integrals, here by tanh-sinh quadrature."""
    b, radius, a, c = 1.0, 20.0, 1.25, 1.125
    profile = {"kind": "rounded_punch", "flat_radius": b, "rounding_radius": radius}
    request = tangential(profile, {"contact_radius": a}, {"stick_radius": c})
    radii = (0.0, 0.5, 0.99, 1.0625, 1.2)

    def stress(r: Any, start: Any) -> Any:
        """Return the integral, with u = sqrt(x^2 - r^2) in the place of x."""

        def integrand(u: Any) -> Any:
            x = sqrt(u**2 + r**2)
            return (2 * sqrt(x**2 - 1) - acos(1 / x)) / x if x > 1 else mpf(0)

        ends = [sqrt(x**2 - r**2) for x in (max(r, start), mpf(a))]
        return quad(integrand, ends) / (pi * radius)

    for equation, quantity, factor, start in (
        ("(5.68)", "pressure", mpf(1), mpf(b)),
        ("(5.70)", "shear_stress", MU, mpf(c)),
    ):
        for i, r in enumerate(radii):
            yield Case(
                "mdr-5",
                equation,
                f"rounded punch, a/b = {a}: {quantity} at r/b = {r}",
                FIELD,
                fields(request, quantity, radii),
                at(quantity, 0, i),
                factor * stress(mpf(r), start),
                bound=QUADRATURE,
            )


def wear() -> Iterator[Case]:
    """Limiting state of fretting wear of a paraboloid, R = 2, d = 0.5: a = 1, u from c."""
    for ratio in (0.1, 0.4, 0.7, 0.95):
        c, d, radius = mpf(ratio), mpf(0.5), mpf(2)
        amplitude = float(MU * (d - c**2 / radius))
        # The amplitude is rounded to a double; c follows from it.
        c = sqrt(radius * (d - mpf(amplitude) / MU))
        radii = [0.97, 1.0]
        request = {
            "profile": BALL,
            "material": {"e_star": 1.0, "g_star": 1.0},
            "friction_coefficient": 0.3,
            "load": {"indentation_depth": 0.5},
            "oscillation": {"tangential_displacement": amplitude},
            "radius": radii,
        }

        def limiting(r: Any, c: Any = c, d: Any = d, radius: Any = radius) -> Any:
            return (
                d
                - 2 / pi * (d - r**2 / (2 * radius)) * asin(c / r)
                - c * r / (pi * radius) * sqrt(1 - (c / r) ** 2)
            )

        edge = findroot(
            lambda r, f=limiting: f(r) - r**2 / 4, (mpf("1.0001"), mpf("1.42")), solver="anderson"
        )
        rows: tuple[tuple[str, str, tuple[str | int, ...], Any], ...] = (
            ("(5.80)", "stick_radius", at("stick_radius"), c),
            ("(5.88)", "wear_radius", at("wear_radius"), edge),
            ("(5.90)", "normal_force", at("normal_force"), 2 * (d * c - c**3 / (3 * radius))),
            ("(5.85)", "limiting_profile at r = 1", at("limiting_profile", 0, 1), limiting(mpf(1))),
        )
        for equation, quantity, place, value in rows:
            yield Case(
                "mdr-5",
                equation,
                f"wear of a paraboloid, c/a = {ratio}: {quantity}",
                WEAR,
                request,
                place,
                value,
                bound=QUADRATURE,
            )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (mindlin, loops, contact_example, chapter, wear):
        yield from part()
