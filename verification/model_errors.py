"""Estimates of the model's own error against fuller models, within a factor of three.

Transverse slip changes the forces by less than its estimate, which is the bound of its cases.
"""

from collections.abc import Iterator
from typing import Any

from mpmath import log, mpf, pi

from verification import compressed_ball, transverse_slip
from verification.case import Case, at

# An estimate is right within a factor of three.
_FACTOR = 2.0


def _material(nu: float) -> dict[str, Any]:
    return {"bodies": ["rigid", {"youngs_modulus": 1.0, "poissons_ratio": nu}]}


def steep_cones() -> Iterator[Case]:
    """Force over Sneddon's, by the radial displacement that the half-space model neglects."""
    scenes = (0.0, 0.1), (0.0, 0.3), (0.1, 0.2), (0.2, 0.2), (0.3, 0.1), (0.3, 0.36), (0.4, 0.1)
    for nu, slope in scenes:
        k = (1 - 2 * mpf(nu)) / (4 * (1 - mpf(nu)))
        rise = pi / 4 + mpf("0.15483073") * k * slope
        fall = pi / 2 - mpf("0.83119312") * k * slope
        request = {
            "profile": {"kind": "cone", "slope": slope},
            "material": _material(nu),
            "load": {"indentation_depth": 1.0},
        }
        yield Case(
            *(
                "hay",
                "force ratio",
                f"rigid cone of slope {slope}, ν = {nu}: model_error",
                "/v1/normal",
            ),
            *(request, at("model_error"), pi * rise / fall**2 - 1),
            bound=_FACTOR,
            as_ratio=True,
        )


def balls() -> Iterator[Case]:
    """Force of a ball at prescribed depth by the same radial displacement, to first order.

    The surface moves inwards by u_r = 4 k M/(E* r), M = int_0^r p s ds, and meets a profile that is
    lower by f' u_r; the force rises by 2 E* int_0^a f' u_r r/sqrt(a^2 - r^2) dr = 3 k a/(pi R) F.
    """
    for nu, slope in ((0.0, 0.02), (0.0, 0.1), (0.3, 0.02), (0.3, 0.1), (0.4, 0.02)):
        k = (1 - 2 * mpf(nu)) / (4 * (1 - mpf(nu)))
        request = {
            "profile": {"kind": "paraboloid", "radius": 1.0},
            "material": _material(nu),
            "load": {"contact_radius": slope},
        }
        case = f"rigid ball, a/R = {slope}, ν = {nu}: model_error"
        yield Case(
            *("hay", "radial displacement", case, "/v1/normal"),
            *(request, at("model_error"), 3 * k * slope / pi),
            bound=_FACTOR,
            as_ratio=True,
        )


def compressed_balls() -> Iterator[Case]:
    """Force at a given depth of an elastic ball between two rigid planes, over Hertz's.

    The diameter is the thickness of the body, as given, or by the kind `sphere`. For nu = 0 and
    a/R < 0.2 two errors of opposite sign nearly cancel: those cases are left out.
    """
    known = {0.0: (0.2, 0.4), 0.3: (0.02, 0.05, 0.1, 0.2, 0.4), 0.45: (0.02, 0.1, 0.4)}
    for nu, caps in known.items():
        for cap in caps:
            depth, ratio = compressed_ball.force_ratio(nu, cap)
            for kind, given in (("paraboloid", {"body_thickness": 2.0}), ("sphere", {})):
                material = {"bodies": _material(nu)["bodies"][::-1]} | given
                request = {
                    "profile": {"kind": kind, "radius": 1.0},
                    "material": material,
                    "load": {"indentation_depth": depth},
                }
                case = f"elastic {kind} between planes, a/R = {cap}, ν = {nu}: model_error"
                yield Case(
                    *("compressed-ball", "series", case, "/v1/normal"),
                    *(request, at("model_error"), round(ratio - 1, 5)),
                    bound=_FACTOR,
                    uncertainty=2e-3,
                    as_ratio=True,
                )


def stuck_punches() -> Iterator[Case]:
    """Force of a bonded punch over Boussinesq's, by the coupling of normal and shear stress."""
    for nu in (0.0, 0.1, 0.2, 0.3, 0.4):
        request = {
            "profile": {"kind": "flat_punch", "radius": 1.0},
            "material": _material(nu),
            "load": {"normal_force": 1.0},
            "friction_coefficient": 1e3,
            "tangential": {"tangential_force": 0.0},
        }
        value = (1 - mpf(nu)) * log(3 - 4 * mpf(nu)) / (1 - 2 * mpf(nu)) - 1
        yield Case(
            *("spence", "bonded punch", f"stuck punch, ν = {nu}: model_error", "/v1/tangential"),
            *(request, at("model_error"), value),
            bound=_FACTOR,
            as_ratio=True,
        )


def transverse_slips() -> Iterator[Case]:
    """Force at a given displacement in Cattaneo's problem, with slip across the load."""
    for nu in (0.1, 0.3, 0.5):
        across = (nu / (4 - 2 * nu)) ** 2
        for stick in (0.05, 0.2, 0.5, 0.8, 0.95):
            a, c, mu, ratio = mpf("1e-3"), mpf(stick), mpf("0.3"), mpf(nu)
            body = {"youngs_modulus": 1.0, "poissons_ratio": nu}
            shift = mu * (2 - ratio) / (2 * (1 - ratio)) * a**2 * (1 - c**2)
            request = {
                "profile": {"kind": "paraboloid", "radius": 1.0},
                "material": {"bodies": [body, body]},
                "load": {"contact_radius": 1e-3},
                "friction_coefficient": 0.3,
                "tangential": {"tangential_displacement": float(shift)},
            }
            force = mu * 2 / (3 * (1 - ratio**2)) * a**3 * (1 - c**3)
            force *= round(transverse_slip.force_ratio(nu, stick), 6)
            case = f"partial slip, ν = {nu}, c/a = {stick}: tangential_force"
            yield Case(
                *("transverse-slip", "32 x 32 elements", case, "/v1/tangential"),
                *(request, at("tangential_force"), force),
                bound=0.2 * across,
                uncertainty=0.01 * across,
            )


def cases() -> Iterator[Case]:
    """Yield all cases of this module."""
    yield from steep_cones()
    yield from balls()
    yield from compressed_balls()
    yield from stuck_punches()
    yield from transverse_slips()
