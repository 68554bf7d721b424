"""Partial slip with the transverse traction that Cattaneo and Mindlin neglect, on a grid.

Equal bodies; the tractions (q_x, q_y) minimise the elastic energy less the work of a shift along x
under |q| <= mu p. Solved twice, with Cerruti's displacements and with those that Cattaneo and
Mindlin leave of them, the error of the grid cancels in the ratio of the forces.

Source: J. J. Kalker 1990, section 4.2; the surface displacements of V. Cerruti, as in Johnson 1985,
section 3.6.
"""

from typing import Any, Final

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]
# Elements across the square, and its width over a: the ratio of the forces is accurate to 1 % of
# (nu/(4 - 2 nu))^2.
_COUNT, _WIDTH = 32, 2.1
_CHANGE: Final = 1e-8
_ITERATIONS: Final = 5000


def force_ratio(nu: float, stick: float) -> float:
    """Return F_x over that of Cattaneo and Mindlin, at the shift of a stick radius c/a."""
    shift = np.pi / 2 * (1 - stick**2)
    return _force(_kernels(nu), shift) / _force(_kernels(0.0), shift)


def _kernels(nu: float) -> Array:
    """Displacements u_x by q_x, u_x by q_y and u_y by q_y over the offset of elements, G* = 1."""
    size = _WIDTH / _COUNT
    edges = (np.arange(-_COUNT, _COUNT + 1) - 0.5) * size
    x, y = np.meshgrid(edges, edges, indexing="ij")
    radius = np.hypot(x, y)
    corners = y * np.arcsinh(x / np.abs(y)), x * np.arcsinh(y / np.abs(x)), -radius
    # Integrals of x^2/R^3, y^2/R^3 and x y/R^3.
    along, across, both = (np.diff(np.diff(each, axis=0), axis=1) for each in corners)
    share = nu / (2 - nu)
    xx, yy = along + across + share * (along - across), along + across - share * (along - across)
    return np.fft.rfft2(np.fft.ifftshift([xx, 2 * share * both, yy], axes=(1, 2))) / np.pi


def _force(kernels: Array, shift: float) -> float:
    """F_x by accelerated projected gradients, with restarts, in units of a = mu p_0 = 1."""
    centres = (np.arange(_COUNT) + 0.5) * _WIDTH / _COUNT - _WIDTH / 2
    limit = np.sqrt(np.maximum(1 - np.add.outer(centres**2, centres**2), 0))
    step = 1 / (1.3 * np.abs(kernels).max())
    traction = ahead = np.zeros((2, _COUNT, _COUNT))
    inertia = 1.0
    for _ in range(_ITERATIONS):
        x, y = np.fft.rfft2(ahead, s=(2 * _COUNT, 2 * _COUNT))
        xx, xy, yy = kernels
        displacement = np.fft.irfft2(np.array([xx * x + xy * y, xy * x + yy * y]))
        gap = displacement[:, :_COUNT, :_COUNT] - np.array([shift, 0.0])[:, None, None]
        found = ahead - step * gap
        found *= limit / np.maximum(np.hypot(*found), np.maximum(limit, 1e-300))
        change = found - traction
        if np.sum((ahead - found) * change) > 0:
            inertia = 1.0
        following = (1 + np.sqrt(1 + 4 * inertia**2)) / 2
        ahead = found + (inertia - 1) / following * change
        traction, inertia = found, following
        if np.abs(change).max() < _CHANGE:
            return float(traction[0].sum())
    raise RuntimeError("the tractions did not converge")
