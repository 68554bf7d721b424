"""Limits within which neglected effects change a result by no more than a tolerance.

Each limit follows from the contact radius a and F_N(a). Slip and thickness are of first order in
the tolerance t:

* adhesion: w = E* l^2/(2 pi a'), 2 E* a' l = F_N(a') - F_N(a), changes the contact radius under a
  given force to a' = a (1 + t), at most the end of the profile; a flat punch has the same depth
  under its force, and at w = E* (t d)^2/(2 pi a) pulls off at t d;
* slip: F_x/mu = F_N(a) - F_N(a (1 - 2 t)) changes the tangential compliance;
* thickness: h at which a rigid base changes the force at a given depth;
* yield: Y = 2 tau_max below a paraboloid (Tresca);
* shape: the contact radius at which a paraboloid of the same curvature replaces a sphere.

Source: manual, Which model does my case need?
"""

from functools import lru_cache
from math import atan, atanh, pi
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from mdr_core.elementwise import full, where
from mdr_core.errors import InputError
from mdr_core.half_space import ASSUMED_RATIO, stiffening
from mdr_core.normal import NormalContact
from mdr_core.profiles import Paraboloid, Sphere
from mdr_core.typing import Array
from mdr_core.validation import LEAST_CHANGE, MOST_CHANGE, single

# Depths z/a between which the largest shear stress below a paraboloid lies: at 0.38 for nu = 0, and
# at 0.54 for nu = 1/2. Source: johnson, section 4.2.
_DEPTHS: Final = (0.37, 0.55)


class Threshold(NamedTuple):
    """Limit within which the model may leave out an effect."""

    effect: str
    """`adhesion`, `slip`, `thickness`, `yield` or `shape`."""
    quantity: str
    """Name of the quantity that is limited."""
    value: Array
    """The limit, of each load."""
    changes: str
    """Result that changes by the tolerance at the limit."""
    instead: str
    """Model beyond the limit, or for `shape` the kind that does within it."""

    @property
    def is_least(self) -> bool:
        """True if the model holds from the value on, false if it holds up to the value."""
        return self.effect in {"thickness", "yield"}


def of_contact(contact: NormalContact, tolerance: float) -> tuple[Threshold, ...]:
    """Return the limits of a contact of a half-space without adhesion, where they are known.

    Yield is known for paraboloids, and the shape for spheres. The thickness is for a body bonded
    to a rigid base, of Poisson's ratio 0.3 where it is unknown.

    Parameters
    ----------
    contact : contact of `normal.solve`.
    tolerance : relative change of a result, from 1e-4 to 0.1.

    Raises
    ------
    InputError : a tolerance out of range, or a contact from another function.

    Examples
    --------
    >>> from mdr_core.profiles import Paraboloid
    >>> from mdr_core.normal import solve
    >>> slip = of_contact(solve(Paraboloid(1.0), 1.0, contact_radius=0.1), 0.01)[1]
    >>> round(float(slip.value) / (4e-3 / 3), 4)
    0.0588
    """
    if not LEAST_CHANGE <= single(("holds_within",), tolerance) <= MOST_CHANGE:
        detail = f"must lie from {LEAST_CHANGE} to {MOST_CHANGE}"
        raise InputError(("holds_within",), detail)
    if type(contact) is not NormalContact:
        detail = (
            "needs a contact of half-spaces without adhesion: the limits are those of its results"
        )
        raise InputError(("holds_within",), detail)
    profile, e_star, a = contact.profile, contact.e_star, contact.contact_radius
    flat, force = profile.is_flat_punch, contact.normal_force
    wide, within, retraction = a, np.zeros_like(a), tolerance * contact.indentation_depth
    with np.errstate(all="ignore"):
        if not flat:
            wide = np.minimum(a * (1 + tolerance), profile.domain)
            stick = np.maximum(a * (1 - 2 * tolerance), profile.first_radius)
            ends = np.ravel([stick, wide])
            within, beyond = e_star * profile.force_within(ends).reshape(2, *a.shape)
            retraction = (beyond - force) / (2 * e_star * wide)
        work = where(contact.loaded, e_star * np.square(retraction) / (2 * pi * wide), 0.0)
    slip, friction = force - within, "tangential_force / friction_coefficient"
    changes = "pull_off_depth" if flat else "contact_radius"
    thickness = a / stiffening(tolerance, contact.material)
    found = [
        Threshold("adhesion", "work_of_adhesion", work, changes, "adhesion"),
        Threshold("slip", friction, slip, "tangential_displacement", "tangential"),
        Threshold("thickness", "thickness", thickness, "normal_force", "layer"),
    ]
    depth = "indentation_depth"
    if isinstance(profile, Paraboloid):
        nu = min(contact.material.poissons_ratios, default=ASSUMED_RATIO)
        least = 2 * _shear_below(nu) * contact.maximum_pressure
        found.append(Threshold("yield", "yield_strength", least, depth, "elastic_plastic"))
    if isinstance(profile, Sphere):
        radius = full(_like_paraboloid(tolerance), a) * profile.radius
        found.append(Threshold("shape", "contact_radius", radius, depth, "paraboloid"))
    return tuple(found)


@lru_cache(maxsize=64)
def _shear_below(nu: float) -> float:
    """tau_max/p(0) on the axis below a paraboloid. Source: johnson, section 4.2."""

    def opposite(z: float) -> float:
        return (1 + nu) * (1 - z * atan(1 / z)) / 2 - 0.75 / (1 + z * z)

    return -float(minimize_scalar(opposite, bounds=_DEPTHS, method="bounded").fun)


@lru_cache(maxsize=64)
def _like_paraboloid(tolerance: float) -> float:
    """a/R at which the depths of a sphere and a paraboloid differ under the same force [1]."""

    def excess(x: float) -> float:
        depth = x * atanh(x)
        force = (1 + x * x) * atanh(x) - x
        return depth / (3 * force / 4) ** (2 / 3) - 1 - tolerance

    return float(brentq(excess, 1e-3, 1 - 1e-12))
