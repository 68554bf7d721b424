"""Largest von Mises and shear stress of a contact, and their places."""

from collections.abc import Callable
from math import ceil, cos, inf, log, sin
from operator import itemgetter
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter

from mdr_core.errors import InputError
from mdr_core.fields import graded
from mdr_core.profiles import Profile
from mdr_core.subsurface.foundation import Contact, Foundation, foundations
from mdr_core.subsurface.stress import on_rings
from mdr_core.typing import Array
from mdr_core.validity import infinite_deviator

# Radii, and depths per e-fold, of a grid in the plane y = 0. The radii cluster at the axis, the
# edges and the breaks; the depths lie between these parts of the contact radius.
_RADII, _PER_E_FOLD, _SHALLOWEST, _DEEPEST = 24, 2, 1e-4, 2.0
# Peaks of the grid that are climbed if they reach this part of the highest one that is known.
_PEAKS, _ALMOST = 3, 0.9
# Points across a box around a peak, the factor by which it shrinks, and its last size over the
# first: a smooth peak is missed by the square of it.
_ACROSS: Final = np.linspace(-1, 1, 5)
_SHRINK, _SMALLEST = 0.3, 1e-3
# Half of the directions in a box that leaves the plane.
_TURN: Final = np.pi / 6
# Relative difference of equal stresses.
_EQUAL: Final = 1e-12

# A measure by direction, radius and depth.
_Measure = Callable[[Array, Array, Array], Array]

MEASURES: Final = ("von_mises", "maximum_shear")


class Peak(NamedTuple):
    """Largest stress under each load [pressure], and its place [length]; shape of the loads.

    The field is symmetric, so that y >= 0. Where the stress is infinite, the place is a radius of
    infinite pressure on the surface.
    """

    value: Array
    x: Array
    y: Array
    z: Array


def largest(
    contact: Contact, measure: str = "von_mises", *, poissons_ratio: float, body: int = 1
) -> Peak:
    """Return the largest von Mises or shear stress in a body under each load, and its place.

    The highest peaks of a grid over the plane y = 0 are climbed, at last in all directions, to a
    relative accuracy of about 1e-5. Parameters: see `stress`.

    Source: notes, §14.

    Parameters
    ----------
    measure : "von_mises" or "maximum_shear".

    Raises
    ------
    InputError : another measure.

    Examples
    --------
    Hertz' contact, nu = 0.3: 0.31 p_0 at the depth 0.481 a, Johnson's section 4.2.

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> peak = largest(contact, "maximum_shear", poissons_ratio=0.3)
    >>> [round(float(one), 3) for one in (peak.value / contact.maximum_pressure, peak.z / 0.1)]
    [0.31, 0.481]
    """
    if measure not in MEASURES:
        raise InputError(("measure",), f"must be one of {', '.join(MEASURES)}")
    under, shape = foundations(contact, body)
    found = [_peak(each, measure, poissons_ratio) for each in under]
    return Peak(*np.array(found).T.reshape(4, *shape))


def infinite_radii(profile: Profile, poissons_ratio: float, slips_from: float) -> list[float]:
    """Return the radii at which the deviatoric stress is infinite once the contact reaches them."""
    radii = [float(np.asarray(b)) for b in profile.infinite_pressure_radii]
    return [b for b in radii if infinite_deviator(profile, b, (poissons_ratio,), slips_from)]


def _peak(under: Foundation, measure: str, nu: float) -> tuple[float, ...]:
    """Value and place of the largest stress in one case; parameters: see `largest`."""
    if not under.loaded:
        return 0.0, 0.0, 0.0, 0.0
    for b in infinite_radii(under.load.profile, nu, under.slips_from):
        if b <= under.load.radius[-1]:
            return inf, b, 0.0, 0.0

    def on(angle: Array, r: Array, z: Array) -> Array:
        """The measure by direction, r of either sign, and z; zero where it is infinite."""
        x, depth = (part.ravel() for part in np.meshgrid(r, z, indexing="ij"))
        e = np.exp(1j * angle[:, None]) * np.where(x < 0, -1, 1)
        values = getattr(on_rings(under, np.abs(x), depth, e, nu), measure)
        return np.nan_to_num(values, posinf=0.0).reshape(angle.size, r.size, z.size)

    r, z = _grid(under)
    (values,) = on(np.zeros(1), r, z)
    tops = np.argwhere(values == maximum_filter(values, 3))
    best = 0.0, np.zeros(3)
    for i, j in tops[np.argsort(-values[tuple(tops.T)])[:_PEAKS]]:
        if values[i, j] >= _ALMOST * best[0]:
            box = np.array([_TURN * under.sheared, np.gradient(r)[i], np.gradient(z)[j]])
            best = max(best, _climbed(on, np.array([0.0, r[i], z[j]]), box), key=itemgetter(0))
    value, (angle, radius, depth) = best
    return value, radius * cos(angle), abs(radius * sin(angle)), depth


def _grid(under: Foundation) -> tuple[Array, Array]:
    """Radii, of either sign if there is a tangential load, and depths."""
    edges = under.load.radius
    a = float(edges[-1])
    stops = np.unique([0.0, *edges, *(float(b) for b in under.load.profile.breaks if b < a)])
    r = graded(np.append(stops, 1.5 * a), max(_RADII, 4 * stops.size))
    if under.sheared:
        r = np.append(-r[:0:-1], r)
    shallow, deep = min(_SHALLOWEST * a, 0.1 * float(np.diff(stops).min())), _DEEPEST * a
    depths = np.geomspace(shallow, deep, ceil(_PER_E_FOLD * log(deep / shallow)))
    return r, np.append(0.0, depths)


def _climbed(on: _Measure, place: Array, box: Array) -> tuple[float, Array]:
    """Return the peak next to a place, and its own place, by boxes of points around it.

    A box moves to its highest point, and shrinks unless that is a higher one on its boundary.
    """
    value, size = 0.0, 1.0
    while size > _SMALLEST:
        axes = place[:, None] + size * box[:, None] * _ACROSS
        axes[2] = np.abs(axes[2])
        values = on(*axes)
        spot = np.unravel_index(values.argmax(), values.shape)
        rises = values[spot] > value * (1 + _EQUAL)
        if rises:
            value, place = float(values[spot]), axes[range(3), spot]
        if not (rises and (np.isin(spot, (0, _ACROSS.size - 1)) & (box > 0)).any()):
            size *= _SHRINK
    return value, place
