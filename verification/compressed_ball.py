"""Elastic ball between two rigid planes without friction, by the series of a solid sphere.

Each plane presses a cap of the ball flat. The pressure is vertical, and a sum of powers of
(1 - (r/a)^2)^(k + 1/2); the points of the cap, displaced by the series over Legendre polynomials,
lie in the plane. A half-space has the Hertz force at the same depth.

Source: A. I. Lur'e, Three-Dimensional Problems of the Theory of Elasticity, 1964, chapter 6:
displacements r^2 grad(phi) + alpha r phi, with phi = r^n P_n.
"""

from typing import Final

import numpy as np

# Highest degree of the series, times the half-angle of the cap: the force at a given depth is
# accurate to 1e-5.
_RESOLUTION: Final = 100
_TERMS, _POINTS = 6, 40


def force_ratio(nu: float, cap: float) -> tuple[float, float]:
    """Return the depth d/R of one plane for a cap of sine `cap`, and F/F_Hertz(d).

    nu is Poisson's ratio of the ball, E = R = 1.
    """
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    nodes, weights = np.polynomial.legendre.leggauss(2 * _RESOLUTION)
    angle = (nodes + 1) * np.pi / 4
    # Sines and cosines of the polar angle where pressure acts, and where contact is required.
    s_load, s = cap * np.sin(angle), cap * np.sin((np.arange(_POINTS) + 0.5) * np.pi / 2 / _POINTS)
    x_load, x = np.sqrt(1 - s_load**2), np.sqrt(1 - s**2)
    area = weights * np.pi / 4 * cap * np.cos(angle) * s_load / x_load
    force = np.array([np.cos(angle) ** (2 * k + 1) * area for k in range(_TERMS)])

    lower, legendre = np.ones_like(x), x
    lower_load, legendre_load = np.ones_like(x_load), x_load
    vertical = np.multiply.outer(-(force @ x_load) / (3 * lame + 2 * shear), x)
    for n in range(2, int(_RESOLUTION / cap)):
        lower, legendre = legendre, ((2 * n - 1) * x * legendre - (n - 1) * lower) / n
        lower_load, legendre_load = (
            legendre_load,
            ((2 * n - 1) * x_load * legendre_load - (n - 1) * lower_load) / n,
        )
        if n % 2:
            # The planes press from both sides.
            continue
        slope = -n * (lower - x * legendre) / s
        slope_load = -n * (lower_load - x_load * legendre_load) / s_load
        normal = -(2 * n + 1) * (force * x_load) @ legendre_load
        tangential = (2 * n + 1) / (n * (n + 1)) * (force * s_load) @ slope_load
        # Stresses at r = 1 of the fields grad(phi) and r^2 grad(phi) + alpha r phi.
        alpha = -2 * (n * lame + (3 * n + 1) * shear) / ((n + 3) * lame + (n + 5) * shear)
        stresses = [
            [
                2 * shear * n * (n - 1),
                lame * (2 * n + alpha * (n + 3)) + 2 * shear * (n + alpha) * (n + 1),
            ],
            [shear * (2 * n - 2), shear * (2 * n + alpha)],
        ]
        first, second = np.linalg.solve(stresses, [normal, tangential])
        radial, polar = first * n + second * (n + alpha), first + second
        vertical += np.multiply.outer(radial, legendre * x) - np.multiply.outer(polar, slope * s)
    # A point at the height x reaches that of the plane, 1 - d.
    *pressure, depth = np.linalg.lstsq(np.vstack([vertical, np.ones_like(x)]).T, 1 - x)[0]
    hertz = 4 / 3 / (1 - nu**2) * depth**1.5
    return float(depth), float(2 * np.pi * np.dot(pressure, force.sum(axis=1)) / hertz)
