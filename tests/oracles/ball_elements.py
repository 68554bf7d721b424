"""Finite elements of an elastic ball between two rigid planes, without friction.

Biquadratic elements in polar coordinates of the meridian, fine at the contact. A hole of radius
0.03 R at the centre, where polar elements degenerate, changes the force by less than 1e-4.
"""

from itertools import product
from typing import Any

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

Array = np.ndarray[Any, np.dtype[np.float64]]
HOLE = 0.03
#: Elements over the contact radius, and the growth of their size beyond 1.5 contact radii.
ACROSS, GROWTH = 16, 1.12


def force(nu: float, cap: float, depth: float) -> float:
    """Force of each plane at its depth, on a contact up to the sine `cap`; E = R = 1.

    At a given depth the force is least sensitive to the contact radius, because the actual one
    makes the energy stationary.
    """
    edge = np.arcsin(cap)
    polar, radial = _graded(edge, np.pi / 2), 1 - _graded(edge, 1 - HOLE)
    index = np.arange(polar.size * radial.size).reshape(polar.size, radial.size)
    r, z = (np.multiply.outer(f(polar), radial).ravel() for f in (np.sin, np.cos))
    first = index[:-2:2, :-2:2].ravel()
    nodes = np.stack([first + i * radial.size + j for i, j in product(range(3), repeat=2)], axis=1)
    stiffness = _stiffness(nu, nodes, r, z)

    given = np.full(2 * index.size, np.nan)
    given[2 * index[0]] = given[2 * index[-1] + 1] = 0.0
    pressed = index[polar <= edge * (1 + 1e-9), 0]
    given[2 * pressed + 1] = 1 - depth - z[pressed]
    free = np.isnan(given)
    given[free] = spsolve(stiffness[free][:, free], -stiffness[free][:, ~free] @ given[~free])
    return -float((stiffness[2 * pressed + 1] @ given).sum())


def _graded(edge: float, end: float) -> Array:
    """Nodes from 0 to the end of elements that are small up to 1.5 contact radii."""
    size = edge / ACROSS
    fine = size * np.arange(ACROSS + ACROSS // 2 + 1)
    left = end - fine[-1]
    count = int(np.log(1 + left / size * (GROWTH - 1)) / np.log(GROWTH)) + 1
    sizes = GROWTH ** np.arange(count)
    ends = np.append(fine, fine[-1] + left * np.cumsum(sizes) / sizes.sum())
    return np.interp(np.arange(2 * ends.size - 1) / 2, range(ends.size), ends)


def _stiffness(nu: float, nodes: Array, r: Array, z: Array) -> Any:
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    elasticity = np.diag([2 * shear] * 3 + [shear])
    elasticity[:3, :3] += lame
    matrices = np.zeros((len(nodes), 18, 18))
    points, weights = np.polynomial.legendre.leggauss(3)
    for (p, v), (q, w) in product(zip(points, weights, strict=True), repeat=2):
        shapes = [np.array([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2]) for x in (p, q)]
        slopes = [np.array([x - 0.5, -2 * x, x + 0.5]) for x in (p, q)]
        along = np.outer(slopes[0], shapes[1]).ravel(), np.outer(shapes[0], slopes[1]).ravel()
        (rp, rq), (zp, zq) = ([x[nodes] @ each for each in along] for x in (r, z))
        value, radius = np.outer(*shapes).ravel(), r[nodes] @ np.outer(*shapes).ravel()
        area = rp * zq - rq * zp
        by_r, by_z = (
            (np.multiply.outer(a, along[0]) - np.multiply.outer(b, along[1])) / area[:, None]
            for a, b in ((zq, zp), (-rq, -rp))
        )
        strain = np.zeros((len(nodes), 4, 18))
        strain[:, 0, ::2], strain[:, 1, 1::2] = by_r, by_z
        strain[:, 2, ::2] = value / radius[:, None]
        strain[:, 3, ::2], strain[:, 3, 1::2] = by_z, by_r
        volume = 2 * np.pi * radius * np.abs(area) * v * w
        matrices += np.einsum("eki,kl,elj,e->eij", strain, elasticity, strain, volume)
    unknowns = np.stack([2 * nodes, 2 * nodes + 1], axis=-1).reshape(len(nodes), 18)
    rows, columns = np.repeat(unknowns, 18, axis=1).ravel(), np.tile(unknowns, 18).ravel()
    return coo_array((matrices.ravel(), (rows, columns))).tocsr()
