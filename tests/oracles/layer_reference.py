"""Contact of any profile with an elastic layer with 30 digits, by Gauss's rule over the whole load.

With x over the contact radius a and the foundation load over E*, the equation (1 - K) q = d - g has
a smooth kernel, and the profile enters by integrals of g with smooth functions alone: over

    K(x, t) = (2/pi) s (a/h) int_0^oo [1 - L(w)] cos(w x a/h) cos(w t a/h) dw,

q = d q1 - g - v, (1 - K) q1 = 1, (1 - K) v = K g, and q(1) = 0 gives d. The integrals of g are
tanh-sinh rules on both sides of its break, in s = sqrt(x^2 - b^2) beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import asinh, ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from mpmath import mp, mpf

from tests.oracles.reference import pressure
from tests.oracles.shapes import FlatPunch, shape_of

if TYPE_CHECKING:
    from collections.abc import Mapping

Numbers = Any
"""An array of mpf."""
DIGITS = 30
# w at which 1 - L is below 1e-25, as w^2 e^(-2w).
SHORTEST = 33
_cos, _sin, _sqrt = (np.frompyfunc(fn, 1, 1) for fn in (mp.cos, mp.sin, mp.sqrt))


def missing(base: str, nu: mpf, w: mpf) -> mpf:
    """1 - L(w). Source: hayes."""
    if base == "frictionless":
        return (1 + 2 * w - mp.exp(-2 * w)) / (mp.sinh(2 * w) + 2 * w)
    kappa = 3 - 4 * nu
    both = 1 + kappa**2 + 4 * w**2
    return (2 * kappa * mp.exp(-2 * w) + both + 4 * w) / (2 * kappa * mp.cosh(2 * w) + both)


@lru_cache
def gauss(count: int) -> tuple[Numbers, Numbers]:
    """Gauss's rule on [0, 1]."""
    x = np.polynomial.legendre.leggauss(count)[0] * mpf(1)
    # The weight's relative error is of second order in the last step.
    for _ in range(3):
        before, value = 1, x
        for n in range(2, count + 1):
            before, value = value, ((2 * n - 1) * x * value - (n - 1) * before) / n
        slope = count * (before - x * value) / (1 - x * x)
        x = x - value / slope
    return (1 + x) / 2, 1 / ((1 - x * x) * slope**2)


@lru_cache
def tanh_sinh() -> tuple[Numbers, Numbers]:
    """Rule on [0, 1] for integrands with singular ends; the nodes are accurate next to 0."""
    step, nodes, weights = mpf(1) / 24, [], []
    for k in range(-84, 85):
        y = mp.pi / 2 * mp.sinh(k * step)
        nodes.append(1 / (1 + mp.exp(-2 * y)))
        weights.append(step * mp.pi / 4 * mp.cosh(k * step) / mp.cosh(y) ** 2)
    return np.array(nodes), np.array(weights)


def _product(left: Numbers, right: Numbers) -> Numbers:
    """Product of matrices in integers, which is faster than in mpf; absolute error 1e-35."""
    one = mpf(2) ** 120
    whole = np.frompyfunc(lambda value: int(value * one), 1, 1)
    return (whole(left) @ whole(right)) * (1 / one**2)


def _fixed_point(kernel: Numbers, source: Numbers) -> Numbers:
    """Solve q = source + kernel q by doubles, refined with the residuals."""
    inverse = np.linalg.inv(np.eye(source.size) - kernel.astype(float))
    q = source * 0
    for _ in range(4):
        residual = source + kernel @ q - q
        q = q + inverse @ residual.astype(float)
    return q


@dataclass(frozen=True)
class LayerContact:
    """Contact of a requested profile with a layer, a = E* = 1."""

    profile: Mapping[str, Any]
    thickness: float
    base: str
    nu: float
    share: float = 1.0
    depth_of_punch: float = 1.0

    @cached_property
    def shape(self) -> Any:
        return shape_of(self.profile)

    @cached_property
    def waves(self) -> tuple[Numbers, Numbers]:
        """w a/h, and the weights of the kernel."""
        part, nu = 1 / mpf(self.thickness), mpf(self.nu)
        shares, weights = gauss(96 + 32 * ceil(1 / self.thickness))
        w = SHORTEST * shares
        strength = SHORTEST * weights * [missing(self.base, nu, each) for each in w]
        return part * w, 2 / mp.pi * mpf(self.share) * part * strength

    @cached_property
    def nodes(self) -> tuple[Numbers, Numbers]:
        """Rule for smooth functions: the kernel is analytic up to 2h from the real axis."""
        return gauss(ceil(30 / asinh(4 * self.thickness)) + 4)

    @cached_property
    def g(self) -> tuple[Numbers, Numbers, Numbers]:
        """Places, weights and g of the profile."""
        shape = self.shape
        b, (rule, weight) = min(shape.b, mpf(1)), tanh_sinh()
        x, w, g = [], [], []
        if b > 0:
            x, w, g = [b * rule], [b * weight], [[shape.g(b * z) for z in rule]]
        if b < 1:
            # Panels double from the scale k of g beyond its break: g may be singular at s = ik.
            top = shape.beyond(mpf(1))
            scale = b or getattr(shape, "width", mpf(0))
            doublings = max(ceil(mp.log(1 / self.thickness, 2)), 0)
            if scale:
                doublings = max(ceil(1 + mp.log(top / scale, 2)), 1)
            ends = [mpf(0), *(top / mpf(2) ** j for j in range(doublings, -1, -1))]
            rules = [tanh_sinh(), *[gauss(32)] * (doublings - 1), tanh_sinh()]
            pieces = list(zip(ends, ends[1:], rules, strict=False))
            s = np.concatenate([low + (high - low) * rule for low, high, (rule, _) in pieces])
            measure = [(high - low) * weight for low, high, (_, weight) in pieces]
            places = _sqrt(b * b + s * s)
            x, w = [*x, places], [*w, np.concatenate(measure) * s / places]
            g.append([shape.g(place, each) for place, each in zip(places, s, strict=True)])
        return np.concatenate(x), np.concatenate(w), np.array([each for part in g for each in part])

    @cached_property
    def solved(self) -> dict[str, Any]:
        """Results, and the waves of the correction to the foundation load of a half-space."""
        flat = isinstance(self.shape, FlatPunch)
        wave, strength = self.waves
        x, weight = self.nodes
        cosines = _cos(np.multiply.outer(np.append(x, mpf(1)), wave))
        kernel = _product(cosines * strength, cosines[:-1].T) * weight
        q1 = _fixed_point(kernel[:-1], np.full(x.size, mpf(1)))
        unit = strength * (cosines[:-1].T @ (weight * q1))
        q1_edge, stiffness = 1 + cosines[-1] @ unit, 2 * (weight @ q1)
        if flat:
            d = mpf(self.depth_of_punch)
            return {
                "indentation_depth": d,
                "normal_force": d * stiffness,
                "normal_stiffness": stiffness,
                "elastic_energy": d * d * stiffness / 2,
                "edge": q1_edge,
                "smooth": d * unit,
            }
        y, w, g = self.g
        at_profile = _cos(np.multiply.outer(y, wave))
        bent = strength * _product(at_profile.T, w * g)
        v = _fixed_point(kernel[:-1], cosines[:-1] @ bent)
        bent = bent + strength * (cosines[:-1].T @ (weight * v))
        depth = (self.shape.g(mpf(1)) + cosines[-1] @ bent) / q1_edge
        smooth = depth * unit - bent
        load = depth - g + _product(at_profile, smooth)
        return {
            "indentation_depth": depth,
            "normal_force": 2 * (w @ load),
            "normal_stiffness": stiffness,
            "elastic_energy": w @ (load * (depth - g)),
            "edge": q1_edge,
            "smooth": smooth,
        }

    def adhesive(self, work: float) -> tuple[mpf, mpf]:
        """Depth and force for a work of adhesion."""
        found = self.solved
        drop = mp.sqrt(2 * mp.pi * mpf(work)) / found["edge"]
        depth, force = found["indentation_depth"], found["normal_force"]
        return depth - drop, force - drop * found["normal_stiffness"]

    def pressure(self, r: float) -> mpf:
        """p(r)/E* inside the contact, p = -(1/pi) int_r^1 q' dx/sqrt(x^2 - r^2) and its edge."""
        found, place = self.solved, mpf(r)
        root = mp.sqrt((1 - place) * (1 + place))
        z, weight = gauss(90)
        x = np.array([mp.sqrt(place**2 + (root * each) ** 2) for each in z])
        wave, _ = self.waves
        slope = -_sin(np.multiply.outer(x, wave)) @ (wave * found["smooth"])
        smooth = -root / mp.pi * (weight @ (slope / x))
        if isinstance(self.shape, FlatPunch):
            edge = found["indentation_depth"] + _cos(wave) @ found["smooth"]
            return smooth + edge / (mp.pi * root)
        return smooth + pressure(self.shape, place, mpf(1))
