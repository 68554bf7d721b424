"""Largest von Mises and shear stress of a contact, and their places."""

from math import ceil, inf, log
from typing import Final, NamedTuple

import numpy as np
from scipy.ndimage import maximum_filter

from mdr_core.errors import InputError
from mdr_core.fields import graded
from mdr_core.subsurface.annuli import Contact, every, shape_of
from mdr_core.subsurface.foundation import Foundation
from mdr_core.subsurface.stress import on_rings
from mdr_core.typing import Array
from mdr_core.validity import infinite_deviator

# Radii, and depths per e-fold, of the first grid. The radii cluster at the axis, the edges and the
# breaks; the depths lie between these parts of the contact radius.
_RADII, _PER_E_FOLD, _SHALLOWEST, _DEEPEST = 24, 2, 1e-4, 2.0
# Directions of the first grid; the field is symmetric.
_DIRECTIONS: Final = np.linspace(0, np.pi, 7)
# Peaks of the first grid that are refined, until one is lower than the highest by half of the size
# of its box.
_PEAKS: Final = 3
# Points across a box around a peak. A round shrinks the box to their distance, and a smooth peak is
# missed by the square of its last size.
_ACROSS: Final = np.linspace(-1, 1, 7)
_SHRINK, _ROUNDS = 1 / 3, 8

MEASURES: Final = ("von_mises", "maximum_shear")


class Peak(NamedTuple):
    """Largest value of a measure of stress under each load, and its place; shape of the loads.

    Where the stress is infinite, the place is a radius of infinite pressure on the surface.
    """

    value: Array
    """[pressure]"""
    x: Array
    """[length]"""
    y: Array
    """[length], >= 0: the field is symmetric."""
    z: Array
    """[length]"""


def largest(
    contact: Contact,
    measure: str = "von_mises",
    *,
    poissons_ratio: float,
    body: int = 1,
    rounds: int = _ROUNDS,
) -> Peak:
    """Return the largest von Mises or shear stress in a body under each load, and its place.

    It is found by a grid over the half-space and its surface, refined around its highest points
    to a relative accuracy of about 2e-5 at worst.

    Source: notes, §14.

    Parameters
    ----------
    contact : a normal contact, or one that is loaded tangentially as well, under any loads; or
        the state at the end of a load history.
    measure : "von_mises" or "maximum_shear".
    poissons_ratio : of this body [1].
    body : 1 for the body of the profile, 2 for the other.
    rounds : refinements of the grid; each reduces the error of a smooth peak by nine.

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
    search = measure, poissons_ratio, body, rounds
    found = [_peak(Foundation(one, exact=False), *search) for one in every(contact)]
    return Peak(*np.array(found).T.reshape(4, *shape_of(contact)))


def _peak(
    under: Foundation, measure: str, nu: float, body: int, rounds: int
) -> tuple[float, float, float, float]:
    """Value and place of the largest stress in one case; parameters: see `largest`."""
    if not under.loaded:
        return 0.0, 0.0, 0.0, 0.0
    profile, edges = under.profile, under.annuli.radius
    for b in profile.infinite_pressure_radii:
        if b <= edges[-1] and infinite_deviator(profile, b, (nu,), under.annuli.slips_from):
            return inf, float(np.asarray(b)), 0.0, 0.0

    def on(axes: list[Array]) -> Array:
        """The measure on a grid of directions, radii and depths; zero where it is infinite."""
        turn = axes[0][:, None]
        r, z = (part.ravel() for part in np.meshgrid(*axes[1:], indexing="ij"))
        place = np.abs(r), z, np.cos(turn) * np.where(r < 0, -1, 1), np.sin(turn)
        values = np.asarray(getattr(on_rings(under, place, nu, body), measure))
        return np.where(np.isinf(values), 0.0, values).reshape([-1, *map(len, axes[1:])])

    def highest(place: Array, box: Array) -> tuple[float, Array]:
        """Return the largest value in a box, and its place."""
        axes = [
            at + half * (_ACROSS if half > 0 else np.zeros(1))
            for at, half in zip(place, box, strict=True)
        ]
        axes[0], axes[2] = np.clip(axes[0], 0.0, np.pi / 2), np.maximum(axes[2], 0.0)
        values = on(axes)
        spot = np.unravel_index(values.argmax(), values.shape)
        return float(values.max()), np.array([x[at] for x, at in zip(axes, spot, strict=True)])

    a = float(edges[-1])
    stops = np.unique([0.0, *edges, *(float(b) for b in profile.breaks if b < a)])
    shallow, deep = min(_SHALLOWEST * a, 0.1 * float(np.diff(stops).min())), _DEEPEST * a
    axes = [
        _DIRECTIONS if under.annuli.sheared else np.zeros(1),
        graded(np.append(stops, 1.5 * a), max(_RADII, 4 * stops.size)),
        np.append(0.0, np.geomspace(shallow, deep, ceil(_PER_E_FOLD * log(deep / shallow)))),
    ]
    steps = [np.maximum(np.diff(x, append=x[-1]), np.diff(x, prepend=x[0])) for x in axes]
    values = on(axes)
    top, turn = values.max(axis=0), values.argmax(axis=0)
    i, j = np.nonzero(top == maximum_filter(top, 3))
    peaks = []
    for n in np.argsort(-top[i, j])[:_PEAKS]:
        spot = turn[i[n], j[n]], i[n], j[n]
        place, box = (
            np.array([x[at] for x, at in zip(each, spot, strict=True)]) for each in (axes, steps)
        )
        if place[0] > np.pi / 2:
            # Radii of the other sign make a peak next to the axis one of a grid across it.
            place[:2] = np.pi - place[0], -place[1]
        peaks.append((float(top[i[n], j[n]]), place, box))
    for size in _SHRINK ** np.arange(rounds):
        least = (1 - size / 2) * max(value for value, _, _ in peaks)
        peaks = [
            (*highest(place, size * box), box) for value, place, box in peaks if value >= least
        ]
    value, (angle, r, z), _ = max(peaks, key=lambda peak: peak[0])
    return value, float(r * np.cos(angle)), float(np.abs(r) * np.sin(angle)), float(z)
