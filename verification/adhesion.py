"""Adhesive contact: Johnson, Kendall and Roberts, Kendall's punch, cones, Maugis' sphere."""

from collections.abc import Iterator

from mpmath import atanh, cbrt, mpf, pi, sqrt

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
    value = -sqrt(8 * pi * mpf(E_STAR) * W * mpf(radius) ** 3)
    case = "silicone, a = 0.2 mm: pull_off_force"
    yield Case("kendall", "flat punch", case, PATH, request, at("pull_off_force"), value)


def cones() -> Iterator[Case]:
    """Pull-off of cones under force, and the contact radius there."""
    for slope in (0.05, 0.2):
        request = _request({"kind": "cone", "slope": slope}, {"normal_force": 0.0})
        value = -54 * mpf(W) ** 2 / (pi * mpf(E_STAR) * mpf(slope) ** 3)
        case = f"silicone, slope {slope}: pull_off_force"
        yield Case("popov-adhesion", "cone", case, PATH, request, at("pull_off_force"), value)


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


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    for part in (ball, punch, cones, sphere):
        yield from part()
