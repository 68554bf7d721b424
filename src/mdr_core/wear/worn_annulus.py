"""Annulus c < r < c + w outside the stick zone, with the relative accuracy of its width w.

The worn depth follows from g - g(c) in the annulus. Near incipient slip the annulus is narrow: its
width is the unknown, and the root at the inner edge follows from it, not from two radii.
Source: notes, §9.
"""

from math import inf
from typing import Final

import numpy as np

from mdr_core.abel.displacement import arccosine, arccosine_growth
from mdr_core.doubles import TINY
from mdr_core.inversion import invert
from mdr_core.profiles import Profile
from mdr_core.quadrature import NODES, composite_rule
from mdr_core.typing import Array

# Largest radius over the end of a profile: its functions may be infinite at the end itself.
ALMOST: Final = 1 - 1e-9


def angle(stick: Array, width: Array) -> Array:
    """Return arccos(c/r), r = c + w [1]."""
    return np.asarray(np.arctan2(_root(stick, width), stick))


def worn_volume(profile: Profile, stick: Array, width: Array, step: Array) -> Array:
    """Return 4 int_c^r (d - g(x)) sqrt(r^2 - x^2) dx = 2 pi int_c^r h r dr [length^3].

    At the outer edge the derivative in the width vanishes with the worn depth h, so that the
    rounding error of the width has no effect. Source: notes, §9.

    Parameters
    ----------
    profile : the unworn profile.
    stick, width : stick radii c and widths of the worn annuli [length], shape (n,).
    step : d - g(c) [length], shape (n,).
    """
    constant = _segment(stick, _root(stick, width))
    inner = profile.annulus_integrals(stick, width, _segment)[0]
    return np.asarray(4 * (step * constant - inner))


def width_where_worn(profile: Profile, stick: Array, step: Array, start: Array) -> Array:
    """Return the width at which the worn depth vanishes; not finite without a root.

    There the mean of g(r cos(t)) - g(c) over 0 < t < arccos(c/r) equals the step d - g(c). It grows
    with the width wherever g does. Source: mdr-5, Eq. (5.88), for any profile; notes, §9.

    Parameters
    ----------
    profile : the unworn profile.
    stick : stick radii c [length], shape (n,).
    step : d - g(c) [length], shape (n,).
    start : widths from which the search starts [length], shape (n,).
    """

    def mean_rise(width: Array) -> tuple[Array, Array]:
        kernels = arccosine, arccosine_growth
        total, growth = profile.annulus_integrals(stick, width, *kernels)
        theta, edge = angle(stick, width), (stick + width) * _root(stick, width)
        return total / theta, width * (growth / total - stick / edge / theta)

    room = np.maximum(ALMOST * float(profile.domain) - stick, TINY)
    start = np.minimum(start, room / 2)
    found = invert(mean_rise, step, start, np.zeros_like(step), room)
    if np.all(found < room / 2):
        return found
    # One rise at the end of the profile can take longer than the whole search.
    with np.errstate(all="ignore"):
        inside = (room == inf) | (step < mean_rise(room)[0])
    return np.where(inside, found, inf)


def _root(stick: Array, width: Array) -> Array:
    """Return sqrt(r^2 - c^2), r = c + w [length]."""
    return np.asarray(np.sqrt(width * (2 * stick + width)))


def _segment(x: Array, root: Array) -> Array:
    """Return int_x^r sqrt(r^2 - t^2) dt = r^2 int_0^arccos(x/r) sin^2 t dt."""
    angle = np.arctan2(root, x)
    nodes, weights = composite_rule(NODES)
    sines = np.sin(np.multiply.outer(angle, nodes))
    return np.asarray((x * x + root * root) * angle * (sines**2 @ weights))
