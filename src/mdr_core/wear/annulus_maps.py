"""Matrices of the worn annulus: from slip to the equivalent profile, and on to the pressure.

In s = sqrt(r^2 - c^2) and X = sqrt(x^2 - c^2) all transforms have the root sqrt(X^2 - s^2),
whatever the stick radius c is. With sigma = s v and gamma = x omega they map even functions of s/b
to even functions, and their matrices depend on neither c nor b = sqrt(a^2 - c^2). In full slip
c = 0, and sigma = b v and gamma = b omega are even themselves.

Source: mdr-5, Eqs. (5.41), (5.74), (5.79); notes, §11.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mdr_core.doubles import EPS, TINY
from mdr_core.quadrature import piecewise_rule
from mdr_core.typing import Array, Indices

# The distance of the nodes from the stick edge grows by about exp(STRETCH); errors are 100 to
# 10,000 times larger without this grading. Both constants by trial: notes, §11.
STRETCH: Final = 5.0
# The last part 1/EDGE of b^2, next to the contact's edge, has separate nodes; the error of the
# volume is 30 to 40 times larger without them.
EDGE: Final = 50.0
# Nodes of a local polynomial: with six the error at 48 nodes is 10 times larger, with ten the same.
# As many Gauss points between two nodes integrate the polynomial times a smooth factor.
_STENCIL: Final = 8


@dataclass(frozen=True)
class AnnulusMaps:
    """Maps between values at the nodes z_j = (s_j/b)^2; the last node is the contact's edge.

    No node lies on the stick edge, where the slip is zero at all times.
    """

    squares: Array
    """z_j, (n, 1)."""
    cosine: Array
    """cos(theta_j): a pressure is an even function about the contact's edge times this, (n,)."""
    to_slip: Array
    """omega to v: v(z) = (2/pi) int_0^1 omega(z (1 - u^2)) du, (n, n); in full slip with the
    weight 1/sqrt(1 - u^2)."""
    from_slip: Array
    """v to omega, the inverse of `to_slip`, (n, n)."""
    to_pressure: Array
    """gamma to p b/E* = (1/pi) int gamma'(z') dz'/sqrt(z' - z), (n, n)."""
    inward: Array
    """2 z d/dz for material that moves inwards past the nodes, (n, n); unused at the last node."""
    outward: Array
    """2 z d/dz for material that moves outwards past the nodes, (n, n)."""
    points: Array
    """z at the points of a composite Gauss rule, (m,)."""
    steps: Array
    """d/dz at the points times the weights of int_0^1 dz, (m, n)."""
    mean: Array
    """Row: (1/2) int_0^1 values dz, (n,); in full slip int_0^1 values dzeta, zeta = sqrt(z)."""
    at_stick: Array
    """Row: the value at z = 0, (n,)."""
    volume: Array
    """Row: int_0^1 values zeta^2 dzeta, (n,); in full slip int_0^1 values zeta dzeta."""

    def at(self, values: Array, squares: Array) -> Array:
        """Return the interpolant of nodal values at any z in [0, 1], shape (m,)."""
        index, weights, _ = _stencils(_angle(squares), self.squares.size)
        return np.asarray((values[index] * weights).sum(axis=-1))


@lru_cache(maxsize=16)
def annulus_maps(nodes: int, *, full_slip: bool = False) -> AnnulusMaps:
    """Return the maps on a number of nodes, evenly spaced in the angle theta of the grading.

    Between the nodes functions are local polynomials in theta, reflected at both ends. Where a
    layer is thinner than the nodes' spacing, they are wrong next to it and nowhere else; one
    polynomial over all nodes would ripple over the whole annulus.

    Source: notes, §11.

    Examples
    --------
    gamma = X^2 gives p = (2/pi) (E*/b) sqrt(1 - z), the pressure of a paraboloid, Eq. (5.38).

    >>> maps = annulus_maps(48)
    >>> p = maps.to_pressure @ maps.squares
    >>> bool(np.allclose(np.pi * p, 2 * np.sqrt(1 - maps.squares), rtol=1e-4, atol=0))
    True
    """
    theta = np.asarray((np.arange(nodes) + 0.5) * (np.pi / (2 * nodes - 1)))
    ends = np.append(0.0, theta)
    squares = _squares(theta)
    to_slip, to_pressure = np.zeros((nodes, nodes)), np.zeros((nodes, nodes))
    for row, node in enumerate(theta):
        # In y, theta = node -+ y^2, the kernels have no root.
        y, weights = piecewise_rule(_STENCIL, np.sqrt(node - ends[row + 1 :: -1]))
        at = node - y * y
        inner = _squares(at)
        lever = inner if full_slip else squares[row]
        kernel = _rate(at) / np.sqrt(lever * (squares[row] - inner))
        to_slip[row] = (kernel * 2 * y * weights / np.pi) @ _interpolation(at, nodes)[0]
        y, weights = piecewise_rule(_STENCIL, np.sqrt(ends[row + 1 :] - node))
        at = node + y * y
        kernel = 1 / np.sqrt(_squares(at) - squares[row])
        to_pressure[row] = (kernel * 2 * y * weights / np.pi) @ _interpolation(at, nodes)[1]
    at, weights = piecewise_rule(_STENCIL, ends)
    points, values, slopes = _squares(at), *_interpolation(at, nodes)
    over_squares = weights * _rate(at)
    inverse = 1 / np.sqrt(points) if full_slip else 1.0
    inner = theta[:-1]
    scale = (2 * squares[:-1] / _rate(inner))[:, None]
    # A stencil leans to the side from which the material comes.
    lean = np.spacing(np.pi)
    inward, outward = (
        np.pad(scale * _interpolation(inner + side, nodes)[1], ((0, 1), (0, 0)))
        for side in (lean, -lean)
    )
    found = AnnulusMaps(
        squares=squares[:, None],
        cosine=np.cos(theta),
        to_slip=to_slip,
        from_slip=np.asarray(np.linalg.inv(to_slip)),
        to_pressure=to_pressure,
        inward=inward,
        outward=outward,
        points=points,
        steps=weights[:, None] * slopes,
        mean=inverse * over_squares / 2 @ values,
        at_stick=_interpolation(np.zeros(1), nodes)[0][0],
        volume=(inverse * over_squares * np.sqrt(points) / 2) @ values,
    )
    for part in vars(found).values():
        part.flags.writeable = False
    return found


def _squares(theta: Array) -> Array:
    """Return z = A/(A + cos^2 theta), A = EDGE sin^2 theta exp(-2 STRETCH cos^2 theta)."""
    weight = _weight(theta)
    return np.asarray(weight / (weight + np.cos(theta) ** 2))


def _weight(theta: Array) -> Array:
    return np.asarray(EDGE * np.sin(theta) ** 2 * np.exp(-2 * STRETCH * np.cos(theta) ** 2))


def _rate(theta: Array) -> Array:
    """Return dz/dtheta."""
    weight, other = _weight(theta), np.cos(theta) ** 2
    twice = np.sin(2 * theta)
    rate = weight * (4 * other / twice + 2 * STRETCH * other * twice)
    return np.asarray(rate / (weight + other) ** 2)


def _angle(squares: Array) -> Array:
    """Return theta of z in [0, 1], by a spline of u = ln(tan theta)."""
    inside = np.clip(squares, TINY, 1 - EPS / 2)
    target = (np.log(inside) - np.log1p(-inside) - np.log(EDGE)) / 2
    # Beyond the grid the slope is 1.
    grid = np.linspace(-2 * STRETCH, 2 * STRETCH, 512)
    share = 1 / (1 + np.exp(2 * grid))
    known, slope = grid - STRETCH * share, 1 + 2 * STRETCH * share * (1 - share)
    within = np.clip(target, known[0], known[-1])
    u = CubicHermiteSpline(known, grid, 1 / slope)(within) + target - within
    return np.asarray(np.arctan(np.exp(u)))


def _interpolation(theta: Array, nodes: int) -> tuple[Array, Array]:
    """Return the matrices from nodal values to values and to theta slopes, each (m, nodes)."""
    index, *weights = _stencils(theta, nodes)
    rows = np.arange(theta.size)[:, None]
    found = np.zeros((2, theta.size, nodes))
    for matrix, part in zip(found, weights, strict=True):
        np.add.at(matrix, (rows, index), part)
    return found[0], found[1]


def _stencils(theta: Array, nodes: int) -> tuple[Indices, Array, Array]:
    """Return the nodes about each angle, and their weights for the value and for the slope.

    All three are of shape (m, width). Nodes beyond either end are reflected into the annulus.
    """
    width = _STENCIL
    place = theta * ((2 * nodes - 1) / np.pi) - 0.5
    first = np.floor(place).astype(np.intp) - (width // 2 - 1)
    middle = (width - 1) / 2
    powers = np.vander(place - first - middle, width, increasing=True)
    slopes = np.zeros_like(powers)
    slopes[:, 1:] = powers[:, :-1] * np.arange(1, width)
    lagrange = np.linalg.inv(np.vander(np.arange(width) - middle, increasing=True))
    index = np.abs(first[:, None] + np.arange(width) + 0.5).astype(np.intp)
    index = np.where(index > nodes - 1, 2 * (nodes - 1) - index, index)
    return index, powers @ lagrange, slopes @ lagrange * ((2 * nodes - 1) / np.pi)
