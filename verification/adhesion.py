"""Adhesive contact: Johnson, Kendall and Roberts, Kendall's punch, cones, Maugis' sphere."""

from collections.abc import Iterator

from mpmath import atanh, cbrt, gamma, linspace, mpf, pi, sqrt

from verification.case import Case, Json, at

PATH = "/v1/normal"
W, E_STAR = 0.05, 2e6


def _request(profile: Json, load: Json) -> dict[str, Json]:
    material = {"e_star": E_STAR, "work_of_adhesion": W}
    return {"profile": profile, "material": material, "load": load}


def _retraction(a: mpf) -> mpf:
    return sqrt(2 * pi * a * W / mpf(E_STAR))


def ball() -> Iterator[Case]:
    """Contact radius and depth under three forces, and both pull-offs."""
    radius = mpf("0.001")
    part, e_star = 3 * pi * W * radius, mpf(E_STAR)
    forces = [-2e-4, 0.0, 1e-3]
    request = _request({"kind": "paraboloid", "radius": 0.001}, {"normal_force": forces})
    name = "silicone, R = 1 mm, w = 50 mJ/m²"
    for i, force in enumerate(forces):
        apparent = force + part + sqrt(2 * part * force + part**2)
        a = cbrt(3 * radius * apparent / (4 * e_star))
        for quantity, value in (
            ("contact_radius", a),
            ("indentation_depth", a**2 / radius - _retraction(a)),
        ):
            case = f"{name}, F = {force:g} N: {quantity}"
            yield Case("jkr", "under a load", case, PATH, request, at(quantity, i), value, 1e-11)
    depth = -mpf(3) / 4 * cbrt((pi * W / e_star) ** 2 * radius)
    for quantity, value in (("pull_off_force", -part / 2), ("pull_off_depth", depth)):
        yield Case("jkr", "pull-off", f"{name}: {quantity}", PATH, request, at(quantity), value)


def punch() -> Iterator[Case]:
    """Kendall's force of a flat punch."""
    radius = 2e-4
    request = _request({"kind": "flat_punch", "radius": radius}, {"normal_force": 0.0})
    force = -sqrt(8 * pi * mpf(E_STAR) * W * mpf(radius) ** 3)
    for quantity, value in (
        ("pull_off_force", force),
        ("pull_off_depth", -_retraction(mpf(radius))),
    ):
        case = f"silicone, a = 0.2 mm: {quantity}"
        yield Case("kendall", "flat punch", case, PATH, request, at(quantity), value)


def cones() -> Iterator[Case]:
    """Pull-off of cones under force, and the contact radius there."""
    for slope in (0.05, 0.2):
        request = _request({"kind": "cone", "slope": slope}, {"normal_force": 0.0})
        value = -54 * mpf(W) ** 2 / (pi * mpf(E_STAR) * mpf(slope) ** 3)
        case = f"silicone, slope {slope}: pull_off_force"
        yield Case("popov-adhesion", "cone", case, PATH, request, at("pull_off_force"), value)


def powers() -> Iterator[Case]:
    """Pull-off of f = C r^n under force and depth, and cones without a load."""
    c, material = sqrt(2 * pi * W / mpf(E_STAR)), mpf(E_STAR)
    for n, coefficient in ((1.5, 1.0), (3.0, 1e3), (4.0, 1e6), (6.0, 1e12)):
        p = mpf(n)
        rate = sqrt(pi) * p / 2 * gamma(p / 2) / gamma((p + 1) / 2) * mpf(coefficient)
        # g = rate a^n; a g' is 3/2 of the retraction at pull-off under force, 1/2 under depth.
        wide, narrow = (
            (part * c / (p * rate)) ** (1 / (p - mpf("0.5"))) for part in (mpf(1.5), mpf("0.5"))
        )
        force = 2 * p / (p + 1) * material * rate * wide ** (p + 1) - 2 * material * c * wide**1.5
        depth = rate * narrow**p - c * sqrt(narrow)
        profile = {"kind": "power", "coefficient": coefficient, "exponent": n}
        request = _request(profile, {"normal_force": 0.0})
        for quantity, value in (("pull_off_force", force), ("pull_off_depth", depth)):
            case = f"silicone, r^{n:g}: {quantity}"
            yield Case("popov-adhesion", "power", case, PATH, request, at(quantity), value, 1e-11)
    for slope in (0.05, 0.2):
        request = _request({"kind": "cone", "slope": slope}, {"normal_force": 0.0})
        a = 32 * mpf(W) / (pi * material * mpf(slope) ** 2)
        case = f"silicone, slope {slope}, no load: contact_radius"
        yield Case("popov-adhesion", "cone", case, PATH, request, at("contact_radius"), a, 1e-11)


def sphere() -> Iterator[Case]:
    """Maugis' sphere, not replaced by a paraboloid, at prescribed contact radii."""
    radius, radii = mpf("0.001"), [2e-4, 6e-4]
    request = _request({"kind": "sphere", "radius": 0.001}, {"contact_radius": radii})
    for i, a in enumerate(map(mpf, radii)):
        step, log = _retraction(a), atanh(a / radius)
        force = mpf(E_STAR) * ((radius**2 + a**2) * log - a * radius - 2 * a * step)
        for quantity, value in (("indentation_depth", a * log - step), ("normal_force", force)):
            case = f"silicone, R = 1 mm, a = {float(a):g} m: {quantity}"
            yield Case("maugis", "sphere", case, PATH, request, at(quantity, i), value)


def curve() -> Iterator[Case]:
    """Modulus, first contact and work of adhesion from a curve of unloading."""
    radius, first, e_star = mpf("0.001"), mpf("1e-5"), mpf(E_STAR)
    radii = linspace(mpf("4.5e-5"), mpf("2e-4"), 60)
    depths = [a**2 / radius - _retraction(a) + first for a in radii]
    forces = [e_star * (4 * a**3 / (3 * radius) - 2 * a * _retraction(a)) for a in radii]
    request = {
        "profile": {"kind": "paraboloid", "radius": 0.001},
        "indentation_depth": [float(d) for d in depths],
        "normal_force": [float(force) for force in forces],
        "fit": ["e_star", "contact_point", "work_of_adhesion"],
    }
    for quantity, value in zip(request["fit"], (e_star, first, mpf(W)), strict=True):
        case = f"silicone, R = 1 mm, curve of unloading: {quantity}"
        yield Case("jkr", "curve", case, "/v1/normal/fit", request, at(quantity), value, 1e-10)


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (ball, punch, cones, powers, sphere, curve):
        yield from part()
