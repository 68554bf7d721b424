"""Where an answer leaves what the model holds for: notices with stable codes.

The codes: `half_space`, `table_end`, `plastic`, `friction`, `yield`, `yield_unknown`; `singular`
and `accuracy` come with the contact, `elastic_similarity` with the material.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import atan
from typing import Final

import numpy as np
from scipy.optimize import minimize_scalar

from mdr_core.errors import Notice
from mdr_core.profiles import Paraboloid, Profile
from mdr_core.profiles.rounded import Spheroid
from mdr_core.typing import Array, Flags, Parameter

# The half-space is flat and the slopes are small up to about here; a judgement, see notes, §8.
_STEEPEST: Final = 0.3
# Part of a table's length from which its end is near.
_NEAR_END: Final = 0.95
# From here on the small transverse slip of compressible bodies is felt; a judgement.
_LARGE_FRICTION: Final = 1.0
_INCOMPRESSIBLE: Final = 1.5
# Poisson's ratio taken where the bodies are unknown, that of most metals.
_USUAL_RATIO: Final = 0.3


def normal_notices(profile: Profile, contact_radius: Array) -> tuple[Notice, ...]:
    """Return what has to be said of a normal contact.

    `half_space`: the profile is steeper than 0.3 at the contact's edge. `table_end`: the contact
    comes near the last radius of a table. `plastic`: the pressure is infinite somewhere, so that
    no real material stays elastic there.

    Source: notes, §8.
    """
    largest = top(contact_radius)
    found = []
    steepest = _steepest(profile, contact_radius, largest)
    if steepest > _STEEPEST:
        found.append(
            Notice(
                "half_space",
                f"the profile's slope reaches {steepest:.2g} in the contact: beyond about "
                f"{_STEEPEST} bodies are no flat half-spaces, and the errors are of its square",
            )
        )
    if near_end(profile, np.asarray(largest)):
        found.append(
            Notice(
                "table_end",
                f"the contact reaches {largest / float(profile.domain):.3f} of the table's last "
                "radius: what the body does beyond may matter",
            )
        )
    least = [float(np.min(b)) for b in profile.infinite_pressure_radii]
    if radii := [b for b in least if b <= largest]:
        places = ", ".join(f"{b:.12g}" for b in radii)
        found.append(
            Notice(
                "plastic",
                f"the elastic pressure is infinite at radius {places}: a real material is "
                "plastic there from the first load on",
            )
        )
    return tuple(found)


def steep(profile: Profile, contact_radius: Array) -> Flags:
    """Return which contacts of many are too steep: those that `half_space` is about."""
    largest = top(contact_radius)
    if profile.slips_at_once or not largest > 0:
        return np.zeros(contact_radius.shape, dtype=bool)
    touches = contact_radius > 0
    slope = profile.df(np.where(touches, contact_radius, largest))
    return np.asarray(touches & (slope > _STEEPEST))


def near_end(profile: Profile, contact_radius: Array) -> Flags:
    """Return which contacts of many come near the end of a table."""
    if profile.kind != "tabulated":
        return np.zeros(contact_radius.shape, dtype=bool)
    return np.asarray(contact_radius > _NEAR_END * float(profile.domain))


def plastic(profile: Profile, contact_radius: Array) -> Flags:
    """Return which contacts of many have an infinite pressure somewhere."""
    found = np.zeros(contact_radius.shape, dtype=bool)
    for b in profile.infinite_pressure_radii:
        found |= np.asarray(b <= contact_radius)
    return found


def _steepest(profile: Profile, contact_radius: Array, largest: float) -> float:
    if profile.slips_at_once or not largest > 0:
        return 0.0
    # No slope is asked for where nothing touches; a single radius is the largest, and does.
    all_touch = contact_radius.ndim == 0 or contact_radius.all()
    touching = contact_radius if all_touch else np.maximum(contact_radius, largest)
    return top(profile.df(touching))


def top(values: Array) -> float:
    """Largest value; of a single one, without the cost of a reduction."""
    return float(values) if values.ndim == 0 else float(values.max())


def transverse(friction_coefficient: Parameter, e_star: Parameter, g_star: Parameter) -> Flags:
    """Return which contacts of many slip across the load: those that `friction` is about."""
    compressible = np.asarray(e_star) < _INCOMPRESSIBLE * (1 - 1e-9) * np.asarray(g_star)
    return np.asarray(compressible & (np.asarray(friction_coefficient) >= _LARGE_FRICTION))


def friction_notices(
    friction_coefficient: Parameter, e_star: Parameter, g_star: Parameter
) -> tuple[Notice, ...]:
    """Return `friction` where mu >= 1 meets compressible bodies, E*/G* < 3/2.

    There the transverse slip that the model leaves out is felt. Source: notes, §8.
    """
    if not np.any(transverse(friction_coefficient, e_star, g_star)):
        return ()
    return (
        Notice(
            "friction",
            "with a friction coefficient of 1 or more and compressible bodies the small slip "
            "across the load, which the model leaves out, is felt",
        ),
    )


def yield_notices(
    profile: Profile,
    e_star: Parameter,
    contact_radius: Array,
    yield_strength: float,
    *,
    poissons_ratios: Sequence[float] = (),
    friction_coefficient: Parameter = 0.0,
    full_slip: Flags | None = None,
) -> tuple[Notice, ...]:
    """Return `yield` where Tresca's criterion is met, from the onset at max shear = Y/2.

    Under a body round at the tip the largest shear stress lies on the axis, c(nu) p_0 with
    c = max of [3/2/(1 + s^2) - (1 + nu)(1 - s arctan(1/s))]/2 over s = z/a: 0.310 for nu = 0.3.
    In full sliding the surface carries mu p_0 as well. `yield_unknown` says that for this shape
    the place of the largest shear stress is not known in closed form.

    Source: johnson, Eqs. (3.45), (4.4), (7.15); notes, §8.
    """
    if profile.infinite_pressure_radii:
        return (Notice("yield", "the pressure is infinite: plastic from the first load on"),)
    if not isinstance(profile, Paraboloid | Spheroid):
        return (
            Notice(
                "yield_unknown",
                f"the onset of yield is not assessed for a {profile.kind}: its largest shear "
                "stress need not lie on the axis",
            ),
        )
    peak = _peak(profile, e_star, contact_radius)
    onset = _onset(yield_strength, poissons_ratios)
    found = []
    if np.any(peak >= onset):
        found.append(
            Notice(
                "yield",
                f"the peak pressure {float(np.max(peak)):.4g} exceeds the onset of yield, "
                f"{onset:.4g}: the material is plastic under the surface",
            )
        )
    if np.any(_yields_at_surface(peak, yield_strength, friction_coefficient, full_slip)):
        found.append(
            Notice("yield", "in full sliding the shear stress exceeds yield at the surface")
        )
    return tuple(found)


def yields(
    profile: Profile,
    e_star: Parameter,
    contact_radius: Array,
    yield_strength: float,
    *,
    poissons_ratios: Sequence[float] = (),
    friction_coefficient: Parameter = 0.0,
    full_slip: Flags | None = None,
) -> dict[str, Flags]:
    """Return which contacts of many `yield` and `yield_unknown` are about, by these codes.

    Parameters as of `yield_notices`.
    """
    shape = contact_radius.shape
    if not isinstance(profile, Paraboloid | Spheroid):
        sharp = np.zeros(shape, dtype=bool)
        for b in profile.infinite_pressure_radii:
            sharp |= np.isfinite(b)
        return {"yield": sharp, "yield_unknown": ~sharp}
    peak = _peak(profile, e_star, contact_radius)
    beneath = peak >= _onset(yield_strength, poissons_ratios)
    found = beneath | _yields_at_surface(peak, yield_strength, friction_coefficient, full_slip)
    return {"yield": np.broadcast_to(found, shape)}


def _onset(yield_strength: float, poissons_ratios: Sequence[float]) -> float:
    """The pressure on the axis with which the largest shear stress beneath it is Y/2."""
    factor = max(largest_shear(nu) for nu in (poissons_ratios or (_USUAL_RATIO,)))
    return yield_strength / (2 * factor)


def _yields_at_surface(
    peak: Array, yield_strength: float, friction_coefficient: Parameter, full_slip: Flags | None
) -> Flags:
    """Where a sliding contact carries a shear stress mu p_0 of Y/2 or more at the surface."""
    carries = 2 * np.asarray(friction_coefficient) * peak >= yield_strength
    return np.asarray(carries & (False if full_slip is None else full_slip))


def _peak(profile: Profile, e_star: Parameter, contact_radius: Array) -> Array:
    """The pressure on the axis [pressure]."""
    a = np.asarray(contact_radius, dtype=float)
    at_axis = profile.pressure_kernel(
        np.atleast_1d(profile.coordinate_from_radius(a)), np.zeros(a.size), 1e-6
    )
    return np.asarray(e_star) * at_axis.reshape(a.shape)


@lru_cache(maxsize=64)
def largest_shear(poissons_ratio: float) -> float:
    """Largest shear stress on the axis under Hertz' pressure, over its peak [1].

    Source: johnson, Eq. (3.45).

    >>> round(largest_shear(0.3), 3)
    0.31
    """

    def minus_shear(s: float) -> float:
        radial = (1 + poissons_ratio) * (1 - s * atan(1 / s))
        return -(1.5 / (1 + s * s) - radial) / 2

    return -float(minimize_scalar(minus_shear, bounds=(1e-3, 2.0), method="bounded").fun)
