"""Normal contact: Hertz, Boussinesq, Love, Sneddon, Galin, Briscoe, Sun, impacts."""

from collections.abc import Iterator

from mpmath import acosh, asin, atan, cbrt, gamma, log, mpf, pi, sqrt

from verification.case import Case, Json, at, fields, normal
from verification.tabulated import HERTZ_STORED

PATH, FIELD = "/v1/normal", "/v1/stress"


def _paraboloid(radius: float) -> dict[str, object]:
    return {"kind": "paraboloid", "radius": radius}


def hertz() -> Iterator[Case]:
    """Contact radius, depth, peak pressure and energy of spheres, from the force."""
    scenes = (
        ("steel ball on steel, R = 10 mm, F = 10 N", (210e9, 0.3, 210e9, 0.3), 0.01, 10.0),
        ("rubber ball on glass, R = 25 mm, F = 2 N", (2e6, 0.5, 70e9, 0.25), 0.025, 2.0),
        ("AFM tip on polymer, R = 20 nm, F = 5 nN", (170e9, 0.28, 2e9, 0.4), 20e-9, 5e-9),
    )
    for name, (e1, nu1, e2, nu2), radius, force in scenes:
        bodies = [{"youngs_modulus": e, "poissons_ratio": nu} for e, nu in ((e1, nu1), (e2, nu2))]
        e_star = 1 / ((1 - mpf(nu1) ** 2) / e1 + (1 - mpf(nu2) ** 2) / e2)
        a = cbrt(3 * mpf(force) * radius / (4 * e_star))
        request = {
            "profile": _paraboloid(radius),
            "material": {"bodies": bodies},
            "load": {"normal_force": force},
        }
        expected = {
            "contact_radius": a,
            "indentation_depth": a**2 / radius,
            "maximum_pressure": 3 * force / (2 * pi * a**2),
            "elastic_energy": mpf(2) / 5 * force * a**2 / radius,
        }
        for quantity, value in expected.items():
            yield Case(
                "hertz", "(4.22)-(4.24)", f"{name}: {quantity}", PATH, request, at(quantity), value
            )


def stored() -> Iterator[Case]:
    """Values that the tests of ContactMechanics store."""
    request = normal(_paraboloid(4.0), {"normal_force": 7.0}, 5.0)
    for quantity, value in HERTZ_STORED.items():
        yield Case(
            "contactmechanics",
            "test_Hertz_refVals",
            f"E* = 5, R = 4, F = 7: {quantity}",
            PATH,
            request,
            at(quantity),
            value,
            bound=1e-7,
            uncertainty=1e-7,
        )


def flat_punch() -> Iterator[Case]:
    """Force, pressure and displacement beside a flat punch."""
    profile, d = {"kind": "flat_punch", "radius": 2.0}, mpf("0.01")
    request = normal(profile, {"indentation_depth": float(d)}, 3.0)
    yield Case(
        "boussinesq",
        "rigid flat punch",
        "flat punch: normal_force",
        PATH,
        request,
        at("normal_force"),
        2 * 3 * 2 * d,
    )
    radii = (0.0, 1.0, 1.9)
    for i, r in enumerate(radii):
        yield Case(
            "boussinesq",
            "rigid flat punch",
            f"flat punch: pressure at r/a = {r / 2}",
            FIELD,
            fields(request, "pressure", radii),
            at("pressure", 0, i),
            3 * d / (pi * sqrt(4 - mpf(r) ** 2)),
        )
    outside = (2.5, 4.0, 20.0)
    for i, r in enumerate(outside):
        yield Case(
            "boussinesq",
            "rigid flat punch",
            f"flat punch: surface displacement at r/a = {r / 2}",
            FIELD,
            fields(request, "normal_displacement", outside),
            at("normal_displacement", 0, i),
            2 * d / pi * asin(2 / mpf(r)),
        )


def cone() -> Iterator[Case]:
    """Force, mean pressure, pressure and displacement of a cone."""
    slope, a = mpf(0.1), mpf(3)
    request = normal({"kind": "cone", "slope": 0.1}, {"contact_radius": 3.0}, 2.0)
    expected = {
        "indentation_depth": pi / 2 * a * slope,
        "normal_force": pi / 2 * 2 * slope * a**2,
        "mean_pressure": 2 * slope / 2,
    }
    for quantity, value in expected.items():
        yield Case(
            "love", "cone", f"cone, slope 0.1: {quantity}", PATH, request, at(quantity), value
        )
    radii = (0.03, 1.5, 2.7)
    for i, r in enumerate(radii):
        yield Case(
            "love",
            "cone",
            f"cone: pressure at r/a = {r / 3:.2f}",
            FIELD,
            fields(request, "pressure", radii),
            at("pressure", 0, i),
            slope * acosh(a / mpf(r)),
        )
    outside = (3.3, 6.0, 30.0)
    for i, r in enumerate(outside):
        r_ = mpf(r)
        shape = asin(a / r_) - r_ / a + sqrt((r_ / a) ** 2 - 1)
        yield Case(
            "love",
            "cone",
            f"cone: surface displacement at r/a = {r / 3:.1f}",
            FIELD,
            fields(request, "normal_displacement", outside),
            at("normal_displacement", 0, i),
            slope * a * shape,
        )


def sphere() -> Iterator[Case]:
    """Exact sphere and ellipsoid: d and F, up to the equator."""
    for ratio in (0.01, 0.1, 0.5, 0.9, 0.99):
        a, radius = mpf(ratio), mpf(1)
        logarithm = log((radius + a) / (radius - a)) / 2
        request = normal({"kind": "sphere", "radius": 1.0}, {"contact_radius": ratio})
        yield Case(
            "sneddon",
            "sphere",
            f"sphere, a/R = {ratio}: indentation_depth",
            PATH,
            request,
            at("indentation_depth"),
            a * logarithm,
        )
        # Both terms are nearly equal for a small sphere; 30 digits suffice for the reference.
        yield Case(
            "sneddon",
            "sphere",
            f"sphere, a/R = {ratio}: normal_force",
            PATH,
            request,
            at("normal_force"),
            (a**2 + radius**2) * logarithm - a * radius,
        )


def cone_and_paraboloid() -> Iterator[Case]:
    """F over d of the cone and the paraboloid."""
    for depth in (1e-6, 1e-3):
        d = mpf(depth)
        request = normal({"kind": "cone", "slope": 0.05}, {"indentation_depth": depth}, 7.0)
        yield Case(
            "sneddon",
            "cone",
            f"cone, d = {depth}: normal_force",
            PATH,
            request,
            at("normal_force"),
            2 * 7 * d**2 / (pi * mpf(0.05)),
        )
        request = normal(_paraboloid(2.0), {"indentation_depth": depth}, 7.0)
        yield Case(
            "sneddon",
            "paraboloid",
            f"paraboloid, d = {depth}: normal_force",
            PATH,
            request,
            at("normal_force"),
            mpf(4) / 3 * 7 * sqrt(2) * d ** mpf("1.5"),
        )


def galin() -> Iterator[Case]:
    """Power-law punches f = B r^n."""
    for n in (0.5, 1.5, 3.0, 4.0, 6.5, 10.0):
        b, a, p = mpf(0.2), mpf(1.5), mpf(n)
        request = normal(
            {"kind": "power", "coefficient": 0.2, "exponent": n}, {"contact_radius": 1.5}, 2.0
        )
        ratio = gamma(p / 2) ** 2 / gamma(p)
        depth = b * p * 2 ** (p - 2) * ratio * a**p
        force = 2 * b * p**2 / (p + 1) * 2 ** (p - 1) * ratio * a ** (p + 1)
        yield Case(
            "galin",
            "power-law punch",
            f"r^{n:g}: indentation_depth",
            PATH,
            request,
            at("indentation_depth"),
            depth,
        )
        yield Case(
            "galin",
            "power-law punch",
            f"r^{n:g}: normal_force",
            PATH,
            request,
            at("normal_force"),
            force,
        )


def truncated_cone(profile: Json, a: float, b: float, radius: object) -> tuple[object, object]:
    """Briscoe's d and F at E* = 1; `radius` is that of the cap, None for a flat end."""
    a_, b_, slope = mpf(a), mpf(b), mpf(profile["slope"])
    angle, root = pi / 2 - asin(b_ / a_), sqrt(a_**2 - b_**2)
    cap = 0 if radius is None else 1 / mpf(radius)
    depth = a_ * slope * angle + a_ * cap * (a_ - root)
    force = 2 * (
        a_ * depth
        - a_**2 / 2 * slope * angle
        - a_**3 / 3 * cap
        + root * (b_ / 2 * slope + (a_**2 - b_**2) / 3 * cap)
    )
    return depth, force


def briscoe() -> Iterator[Case]:
    """Truncated cones, and cones with a paraboloidal cap."""
    flat = {"kind": "truncated_cone", "flat_radius": 1.0, "slope": 0.3}
    capped = {"kind": "rounded_cone", "slope": 0.25, "tip_radius": 4.0}
    for name, profile, radius in (("truncated", flat, None), ("blunt", capped, 4.0)):
        for a in (1.001, 1.2, 2.0, 10.0):
            depth, force = truncated_cone(profile, a, 1.0, radius)
            request = normal(profile, {"contact_radius": a})
            yield Case(
                "briscoe",
                f"{name} cone",
                f"{name} cone, a/b = {a}: indentation_depth",
                PATH,
                request,
                at("indentation_depth"),
                depth,
            )
            yield Case(
                "briscoe",
                f"{name} cone",
                f"{name} cone, a/b = {a}: normal_force",
                PATH,
                request,
                at("normal_force"),
                force,
            )


def sun() -> Iterator[Case]:
    """Hyperboloids: asymptote of slope t, tip radius R."""
    t, radius = mpf(0.5), mpf(2)
    profile = {"kind": "hyperboloid", "slope": 0.5, "tip_radius": 2.0}
    for ratio in (0.1, 1.0, 5.0, 40.0):
        a = mpf(ratio)
        x = radius * t / a
        angle = pi / 2 + atan((1 / x - x) / 2)
        request = normal(profile, {"contact_radius": ratio})
        yield Case(
            "sun",
            "hyperboloid",
            f"hyperboloid, a/(R t) = {ratio}: indentation_depth",
            PATH,
            request,
            at("indentation_depth"),
            a * t / 2 * angle,
        )
        yield Case(
            "sun",
            "hyperboloid",
            f"hyperboloid, a/(R t) = {ratio}: normal_force",
            PATH,
            request,
            at("normal_force"),
            a**2 * t * (x + (1 - x**2) / 2 * angle),
        )


def impacts() -> Iterator[Case]:
    """Largest force, contact radius and energy of elastic normal impacts, tests 1 and 2."""
    spheres = (
        ("test 1, glass", 4.8e10, 0.2, 2800.0, 0.01, 10.0),
        ("test 1, limestone", 2.0e10, 0.25, 2500.0, 0.01, 10.0),
        ("test 2, aluminium alloy", 7.0e10, 0.3, 2699.0, 0.1, 0.2),
        ("test 2, magnesium alloy", 4.0e10, 0.35, 1800.0, 0.1, 0.2),
    )
    for name, modulus, nu, density, radius, speed in spheres:
        pair = name.startswith("test 1")
        body = {"youngs_modulus": modulus, "poissons_ratio": nu}
        e_star = modulus / (1 - mpf(nu) ** 2) / (2 if pair else 1)
        mass = mpf(4) / 3 * pi * density * mpf(radius) ** 3 / (2 if pair else 1)
        r_star, v = mpf(radius) / (2 if pair else 1), mpf(speed) * (2 if pair else 1)
        depth = (15 * mass * v**2 / (16 * e_star * sqrt(r_star))) ** mpf("0.4")
        request = {
            "profile": _paraboloid(float(r_star)),
            "material": {"bodies": [body, body if pair else "rigid"]},
            "load": {"indentation_depth": float(depth)},
        }
        expected = {
            "normal_force": mpf(4) / 3 * e_star * sqrt(r_star) * depth ** mpf("1.5"),
            "contact_radius": sqrt(r_star * depth),
            "elastic_energy": mass * v**2 / 2,
        }
        for quantity, value in expected.items():
            yield Case(
                "chung-ooi",
                "tests 1, 2",
                f"{name}: {quantity} at the turning point",
                PATH,
                request,
                at(quantity),
                value,
            )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (
        hertz,
        stored,
        flat_punch,
        cone,
        sphere,
        cone_and_paraboloid,
        galin,
        briscoe,
        sun,
        impacts,
    ):
        yield from part()
