"""The worn annulus as a few small matrices: from the slip to the foundation, and to the pressure.

In s = sqrt(r^2 - c^2) and X = sqrt(x^2 - c^2) the roots of all transforms are those of an annulus
that begins at zero, sqrt(X^2 - s^2), whatever c is: with sigma = s v(s^2) and
gamma = x omega(X^2) they take even polynomials to even polynomials, and depend neither on c nor,
in zeta = s/b, on the annulus' end b.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from mdr_core.quadrature import gauss_legendre
from mdr_core.typing import Array

# Of the rules that set up the maps; in z they integrate polynomials exactly with two.
_POINTS_A_NODE: Final = 4


@dataclass(frozen=True)
class AnnulusMaps:
    """Maps between values at the nodes zeta_j; the last node is the contact's edge, zeta = 1.

    No node lies on the stick edge: there the slip is zero for ever and would say nothing.
    """

    zeta: Array
    squares: Array
    """z = zeta^2."""
    coefficients: Array
    """Values to the coefficients of the polynomials."""
    to_slip: Array
    """omega to v: v(z) = (2/pi) int_0^1 omega(z (1 - u^2)) du."""
    from_slip: Array
    """v to omega, its inverse."""
    to_pressure: Array
    """gamma to pi-scaled pressure without its root: p b/E* = sqrt(1 - z) x this."""
    derivative: Array
    """d/dz."""
    at_stick: Array
    """Row: the value at zeta = 0."""
    mean: Array
    """Row: (1/2) int_0^1 values dz."""
    volume: Array
    """Row: int_0^1 values zeta^2 dzeta."""
    fine: Array
    """To the points of the rule below, which integrates products of two polynomials."""
    fine_weights: Array
    """(1/2) int_0^1 over z from values at these points."""
    variable: "_Variable"

    def at(self, values: Array, squares: Array) -> Array:
        """The polynomial through the values, at other z in [0, 1]."""
        place = 2 * self.variable.inverse(squares) - 1
        return np.asarray(chebyshev.chebval(place, self.coefficients @ values))


@lru_cache(maxsize=16)
def annulus_maps(nodes: int, spread: float = 1.0) -> AnnulusMaps:
    """Return the maps on the positive half of 2 `nodes` Chebyshev points, the last one at 1.

    They crowd at the contact's edge, where the pressure has its root, and at the stick edge. The
    functions are polynomials in w, z = w (q + (1 - q) w): for q = `spread` = 1 in z, for
    q = 2 c/(a + c) in the radius, which is what they are smooth in where the stick zone is small.

    Source: mdr-5, Eqs. (5.41), (5.74), (5.79); notes, §11.

    Examples
    --------
    gamma = X^2 gives p = (2/pi) (E*/b) sqrt(1 - zeta^2), as a paraboloid does, Eq. (5.38).

    >>> maps = annulus_maps(6)
    >>> [float(f"{value:.6f}") for value in np.pi * (maps.to_pressure @ maps.squares)[:2]]
    [2.0, 2.0]
    """
    variable = _Variable(spread, nodes)
    w = np.cos(np.pi * np.arange(nodes) / (2 * nodes - 1))[::-1] ** 2
    z = variable.squares(w)
    inverse = np.linalg.inv(variable.basis(z))
    points, weights = gauss_legendre(_POINTS_A_NODE * nodes)
    u, du = (points + 1) / 2, weights / 2
    below = np.multiply.outer(z, 1 - u * u)
    above = z[:, None] + np.multiply.outer(1 - z, u * u)
    slip = 2 / np.pi * np.einsum("u,jun->jn", du, variable.basis(below))
    pressure = 2 / np.pi * np.einsum("u,jun->jn", du, variable.slope(above))
    to_slip = np.asarray(slip @ inverse)
    fine = variable.basis(variable.squares(u)) @ inverse
    fine_weights = du * variable.stretch(u) / 2
    at_root = variable.squares(u * u)
    found = AnnulusMaps(
        np.sqrt(z),
        z,
        np.asarray(inverse),
        to_slip,
        np.linalg.inv(to_slip),
        pressure @ inverse,
        variable.slope(z) @ inverse,
        (variable.basis(np.zeros(1)) @ inverse)[0],
        fine_weights @ fine,
        (du * np.sqrt(at_root) * variable.stretch(u * u) * u) @ variable.basis(at_root) @ inverse,
        fine,
        fine_weights,
        variable,
    )
    for part in vars(found).values():
        if isinstance(part, np.ndarray):
            part.flags.writeable = False
    return found


@dataclass(frozen=True)
class _Variable:
    """The Chebyshev polynomials in 2 w - 1, as functions of z = w (q + (1 - q) w)."""

    q: float
    count: int

    def squares(self, w: Array) -> Array:
        return w * (self.q + (1 - self.q) * w)

    def stretch(self, w: Array) -> Array:
        """dz/dw."""
        return self.q + 2 * (1 - self.q) * w

    def inverse(self, z: Array) -> Array:
        """w of z."""
        return 2 * z / (self.q + np.sqrt(self.q**2 + 4 * (1 - self.q) * z))

    def basis(self, z: Array) -> Array:
        return np.asarray(chebyshev.chebvander(2 * self.inverse(z) - 1, self.count - 1))

    def slope(self, z: Array) -> Array:
        """The derivatives of the basis with respect to z."""
        slopes = np.zeros((self.count - 1, self.count))
        for degree in range(1, self.count):
            slopes[:degree, degree] = 2 * chebyshev.chebder(np.eye(degree + 1)[degree])
        w = self.inverse(z)
        in_w = chebyshev.chebvander(2 * w - 1, self.count - 2) @ slopes
        return np.asarray(in_w / self.stretch(w)[..., None])
