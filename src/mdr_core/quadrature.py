"""Gauss-Legendre rules for integrands that are analytic in a strip about the real axis.

The substitutions of `mdr_core.abel` remove the singularities of every stress integral: the new
integrand h(y) is analytic for |Im y| < pi/2 and grows no faster than exp(growth |Re y|). Pieces of
length two then converge as 3.3^-2n.
"""

from collections.abc import Callable
from functools import lru_cache
from math import log
from typing import Final

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_legendre

from mdr_core.doubles import EPS, LOG_RANGE
from mdr_core.elementwise import in_blocks
from mdr_core.typing import Array, Indices

# h(y, index): y has shape (nodes, m) and may be overwritten; index (m,) selects the integrals. The
# values have the shape (..., nodes, m).
Integrand = Callable[[Array, Indices], Array]

PIECE: Final = 2.0
"""Length of a piece in a strip of pi/2."""
NODES: Final = 20
"""Number of nodes of such a piece, which reduces the error to rounding error."""
STEEP: Final = 8.0
"""Growth up to which a piece has `PIECE` as its length."""


@lru_cache(maxsize=64)
def gauss_legendre(points: int) -> tuple[Array, Array]:
    """Return the nodes and weights of the rule on [-1, 1]."""
    nodes, weights = roots_legendre(points)
    nodes.flags.writeable = weights.flags.writeable = False
    return nodes, weights


def integrate(h: Integrand, length: Array, lower: Array, *, growth: float = STEEP) -> Array:
    """Return the integrals of h over [lower, lower + length], h analytic in the strip.

    Source: notes, §5; trefethen, Thm 19.3.

    Parameters
    ----------
    h : integrand.
    length : lengths, accurate also where the ends are close, shape (m,).
    lower : lower ends, shape (m,).
    growth : bound on the growth of h, as a power of exp|Re y|.
    """
    piece = PIECE / max(growth / STEEP, 1.0)
    # A length that is not finite takes one piece, and its integral is not finite either.
    counts = np.maximum(np.ceil(np.where(np.isfinite(length), length, 0.0) / piece), 1).astype(int)
    result: Array | None = None
    for count in np.flatnonzero(np.bincount(counts)).tolist():
        index = (counts == count).nonzero()[0]
        part = _apply(h, composite_rule(NODES, count), lower[index], length[index], index)
        if result is None:
            result = np.empty((*part.shape[:-1], length.size))
        result[..., index] = part
    return np.empty_like(length) if result is None else result


def _apply(
    h: Integrand, rule: tuple[Array, Array], lower: Array, length: Array, index: Indices
) -> Array:
    """Apply the rule on [0, 1] to [lower, lower + length], in blocks that fit in the cache."""
    nodes, weights = rule
    if len(several := in_blocks(length.size, nodes.size)) > 1:
        parts = [_apply(h, rule, lower[part], length[part], index[part]) for part in several]
        return np.concatenate(parts, axis=-1)
    return np.asarray(weights @ h(lower + nodes[:, None] * length, index) * length)


@lru_cache(maxsize=256)
def composite_rule(points: int, count: int = 1) -> tuple[Array, Array]:
    """Return nodes and weights on [0, 1], divided into `count` equal pieces."""
    return piecewise_rule(points, np.linspace(0.0, 1.0, count + 1))


@lru_cache(maxsize=4)
def cumulative_rule(points: int) -> tuple[Array, Array, Array]:
    """Return nodes and weights on [0, 1], and the weights of the integrals from 0 to each node.

    Columns, shape (points, 1); the weights of the value at node j are [j, :, 0].
    """
    nodes, _ = gauss_legendre(points)
    # Lagrange polynomials at the nodes are integrated as sums of Legendre polynomials.
    integrals = legendre.legval(nodes, legendre.legint(np.eye(points), lbnd=-1))
    cumulative = np.linalg.solve(legendre.legvander(nodes, points - 1).T, integrals) / 2
    shares, weights = composite_rule(points, 1)
    return shares[:, None], weights[:, None], cumulative[:, :, None]


def piecewise_rule(points: int, ends: Array) -> tuple[Array, Array]:
    """Return nodes and weights on the pieces between the ends."""
    nodes, weights = gauss_legendre(points)
    width = np.diff(ends)[:, None]
    return (ends[:-1, None] + width * (nodes + 1) / 2).ravel(), (width * weights / 2).ravel()


def reach_of_power(exponent: float) -> float:
    """Return log(x0/x) at which (x/x0)^exponent is negligible, up to the range of doubles."""
    return min(-log(EPS) / exponent, LOG_RANGE) if exponent > 0 else LOG_RANGE
