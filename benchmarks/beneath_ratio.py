"""Subsurface stresses against Hamilton's closed form in bare NumPy."""

from __future__ import annotations

import measure
import numpy as np

from mdr_core.normal import solve
from mdr_core.profiles import Paraboloid, Profile, RoundedPunch, Tabulated
from mdr_core.subsurface import stress
from mdr_service.dispatch import respond
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.serializers import JSON

Array = np.ndarray
POINTS, NU, E_STAR = 100, 0.3, 3.0
X, Z = np.meshgrid(np.linspace(-1.5, 1.5, POINTS), np.linspace(0.0, 1.5, POINTS))
Y = np.full(X.shape, 0.1)
RADII = np.linspace(0, 1.2, 200)
PROFILES: dict[str, tuple[Profile, str]] = {
    "paraboloid": (Paraboloid(2.0), "<= 50"),
    "rounded punch": (RoundedPunch(0.5, 2.0), "<= 400"),
    "table of 200 points": (Tabulated(RADII, RADII**2 / 4), "<= 200"),
}
MODELS: dict[str, dict[str, object]] = {
    "paraboloid": {"profile": {"kind": "paraboloid", "radius": 2.0}},
    "rounded punch": {
        "profile": {"kind": "rounded_punch", "flat_radius": 0.5, "rounding_radius": 2.0}
    },
    "table of 200 points": {
        "profile": {"kind": "tabulated", "r": RADII.tolist(), "f": (RADII**2 / 4).tolist()}
    },
}
GIVEN = {
    "material": {"e_star": E_STAR, "poissons_ratio": NU},
    "load": {"contact_radius": 1.0},
    "points": POINTS,
}


def hamilton(x: Array, y: Array, z: Array, peak: float) -> list[Array]:
    """Hamilton 1983: xx, yy, zz, xy, xz, yz under p_0 sqrt(1 - r^2/a^2), a = 1."""
    r2 = x * x + y * y
    A = r2 + z * z - 1
    S = np.sqrt(A * A + 4 * z * z)
    M, N = np.sqrt((S + A) / 2), np.sqrt((S - A) / 2)
    G, H = M * M - N * N + z * M - N, 2 * M * N + M + z * N
    bracket = (1 - NU) * N * z * z - (1 - 2 * NU) / 3 * (N * S + 2 * A * N + 1) - NU * M * z
    side, part = (1 + NU) * z * np.arctan2(1.0, M), (y * y - x * x) / r2 * bracket
    xx = side + (part - N * (x * x + 2 * NU * y * y) - M * x * x * z / S) / r2
    yy = side + (-part - N * (y * y + 2 * NU * x * x) - M * y * y * z / S) / r2
    xy = (1 - 2 * NU) * (-N * r2 + 2 / 3 * N * (S + 2 * A) - z * (z * N + M) + 2 / 3)
    xy = x * y / (r2 * r2) * (xy + z * (-M * r2 / S - z * N + M))
    along = -z * (N / S - z * H / (G * G + H * H))
    return [peak * part for part in (xx, yy, -N + z * M / S, xy, x * along, y * along)]


def rows() -> list[measure.Row]:
    """A map of 10^4 points, and a whole request for it."""
    rows_ = []
    for name, (profile, target) in PROFILES.items():
        contact = solve(profile, E_STAR, contact_radius=1.0)
        peak = float(solve(Paraboloid(2.0), E_STAR, contact_radius=1.0).maximum_pressure)

        def mdr(contact=contact) -> object:
            return stress(contact, X, Y, Z, poissons_ratio=NU)

        def bare(peak=peak) -> object:
            return hamilton(X, Y, Z, peak)

        rounds = measure.interleaved(mdr, bare, 2.0)
        detail = ""
        if isinstance(profile, Paraboloid):
            exact = np.array(hamilton(X[1:], Y[1:], Z[1:], peak))
            own = np.array(stress(contact, X[1:], Y[1:], Z[1:], poissons_ratio=NU))
            detail = f"both agree to {np.abs(own - exact).max() / peak:.0e} of p_0"
        what = f"subsurface stress, {name}, 1e4 points / Hamilton's formulas in bare NumPy"
        rows_.append(measure.row(what, "", rounds, target, detail))

        def request(model=MODELS[name]) -> object:
            return respond("subsurface", SubsurfaceQuery.model_validate(GIVEN | model), JSON)

        rounds = measure.interleaved(request, mdr, 2.0)
        what = f"whole subsurface request, {name}, 1e4 points / its stresses alone"
        rows_.append(measure.row(what, "", rounds, "<= 2"))
    return rows_
