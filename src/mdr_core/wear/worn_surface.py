"""Worn contact from the states of its annulus: scalars and fields."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from math import inf

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import fields, normal
from mdr_core.abel.annulus import inverse_hypot
from mdr_core.elementwise import in_blocks
from mdr_core.typing import Array
from mdr_core.validation import checked_radii
from mdr_core.wear.annulus_state import AnnulusState


@dataclass(frozen=True)
class WornSurface(AnnulusState):
    """Worn contact at each number of cycles: scalars (cycles,) and fields (cycles, radii)."""

    trail: Array
    """Radii c that a growing stick zone has passed, up to the stick edge, and the wear w_c that the
    springs keep there. Shape (2, k, cycles)."""
    settled_at: float = field(default=inf, kw_only=True)
    """Number of cycles after which wear has stopped."""
    cycles: Array = field(kw_only=True)

    @property
    def indentation_depth(self) -> Array:
        """d [length]: it grows where the normal force is constant."""
        return float(self.initial.normal.indentation_depth) + self.depth_increase

    @property
    def contact_radius(self) -> Array:
        """a [length]: it grows as the contact edge wears."""
        return float(self.initial.normal.contact_radius) + self.growth

    @cached_property
    def normal_force(self) -> Array:
        """F_N [force]: it falls where the depth is constant."""
        normal = self.initial.normal
        if self.initial.constant_force or not self.initial.slips:
            return np.full(self.cycles.shape, float(normal.normal_force))
        # After the loss of contact only rounding errors of either sign remain.
        return np.maximum(2 * float(normal.e_star) * self.force, 0.0)

    @cached_property
    def worn_volume(self) -> Array:
        """V = 2 pi int h r dr [length^3]. Source: notes, §11."""
        a, (at, step) = self.x[-1], self._passed
        root = inverse_hypot(a, at)
        passed = (step * (a * a * np.arctan2(root, at) - at * root)).sum(axis=0)
        return 2 * np.pi * self.end**3 * (self.initial.maps.volume @ self.worn) + 2 * passed

    @property
    def dissipated_energy(self) -> Array:
        """Friction work V/K of all cycles so far, by the law of wear [force length]."""
        return self.worn_volume / self.initial.wear_coefficient

    @cached_property
    def _passed(self) -> tuple[Array, Array]:
        """Middle radii of the intervals of the trail, and the steps of w_c over them."""
        radius, worn = self.trail
        return (radius[1:] + radius[:-1]) / 2, np.diff(worn, axis=0)

    def spring_wear(self, radius: Array) -> Array:
        """Return the wear g - g_0 of the springs at radii of the annulus [length], (cycles, m)."""
        found = []
        for c, b, omega in zip(self.stick_radius, self.end, self.worn_omega.T, strict=True):
            squares = np.clip((radius - c) * (radius + c) / b**2, 0.0, 1.0)
            lever = b if self.initial.full_slip else radius
            found.append(lever * self.initial.maps.at(omega, squares))
        return np.array(found)

    def worn_depth(self, radius: ArrayLike) -> Array:
        """Return h(r) = f - f_0 [length], (cycles, m), which is never negative and never falls.

        Where numerical errors would reduce it from one number of cycles to the next, the earlier
        depth is returned for both, which is not further from the truth.

        Raises
        ------
        InputError : a radius that is negative, not finite or beyond the profile's end.
        """
        return np.maximum.accumulate(self._each(self._worn_depth, radius), axis=0)

    def profile(self, radius: ArrayLike) -> Array:
        """Return the worn profile f(r) [length], (cycles, m). Errors as for `worn_depth`."""
        return np.asarray(
            self.initial.normal.profile.f(self._radii(radius)) + self.worn_depth(radius)
        )

    def pressure(self, radius: ArrayLike) -> Array:
        """Return p(r) [pressure], (cycles, m). Errors as for `worn_depth`.

        Never negative, zero outside the contact. The limit is the pressure of a flat punch of
        radius c, infinite at c; before, it has a narrow peak there.

        Source: mdr-5, Eq. (5.79).
        """
        return self._each(self._pressure, radius)

    def _radii(self, radius: ArrayLike) -> Array:
        return checked_radii(radius, float(np.asarray(self.initial.normal.profile.domain)))

    def _each(self, values: Callable[[int, Array], Array], radius: ArrayLike) -> Array:
        """Return a field at each number of cycles, in blocks of radii that bound the memory."""
        r = self._radii(radius)
        blocks = in_blocks(r.size, len(self.x) + len(self.trail[0]))
        rows = range(self.cycles.size)
        return np.array([np.concatenate([values(row, r[part]) for part in blocks]) for row in rows])

    def _worn_depth(self, row: int, radius: Array) -> Array:
        """Return h(r) = (sigma - S_0) H(r - c) + (2/pi) int_c0^min(r,c) arccos(x/r) dw_c(x).

        The second term belongs to the springs that a growing stick zone has passed.
        Source: mdr-5, Eq. (5.75), integrated by parts; notes, §11.
        """
        result, full_slip = np.zeros(radius.shape), self.initial.full_slip
        c, b, a = self.stick_radius[row], self.end[row], self.x[-1, row]
        inside = ((radius > c) | full_slip) & (radius < a)
        s = inverse_hypot(radius[inside], c)
        worn = self.initial.maps.at(self.worn[:, row], np.minimum((s / b) ** 2, 1.0))
        result[inside] = (b if full_slip else s) * worn
        at, step = (part[:, row] for part in self._passed)
        within = radius < a
        root = inverse_hypot(radius[within][:, None], at)
        result[within] += 2 / np.pi * (np.arctan2(root, at) @ step)
        # Below rounding at the edges, and between nodes that are too few, the polynomials may be
        # negative.
        return np.maximum(result, 0.0)

    def _pressure(self, row: int, radius: Array) -> Array:
        contact, c = self.initial.normal, self.stick_radius[row]
        if self.worn_volume[row] <= 0:
            return fields.pressure(contact, radius)
        e_star = float(contact.e_star)
        result = np.zeros(radius.shape)
        sticks = radius < c
        slips = ~sticks & (radius < self.x[-1, row])
        result[slips] = e_star * self._annulus_stress(row, radius[slips])
        if sticks.any():
            # The unworn foundation inside c, plus the worn one outside.
            within = normal.solve(contact.profile, e_star, contact_radius=c)
            worn = e_star * self._stick_stress(row, radius[sticks])
            result[sticks] = fields.pressure(within, radius[sticks]) + worn
        return np.maximum(result, 0.0)

    def _annulus_stress(self, row: int, radius: Array) -> Array:
        """Return p/E* at radii of the annulus, c < r < a. Source: mdr-5, Eq. (5.79)."""
        maps = self.initial.maps
        even = np.append(self.stress[:-1, row] / maps.cosine[:-1], 0.0)
        # At the edge, from the even polynomial of degree 4 through its three neighbours.
        even[-1] = (15 * even[-2] - 6 * even[-3] + even[-4]) / 10
        s = inverse_hypot(radius, self.stick_radius[row])
        squares = np.minimum((s / self.end[row]) ** 2, 1.0)
        return np.asarray(maps.at(maps.cosine, squares) * maps.at(even, squares))

    def _stick_stress(self, row: int, radius: Array) -> Array:
        """Return the part of p/E* at r < c beyond that of the unworn shape inside c.

        (1/pi) int g'(x)/sqrt(x^2 - r^2) dx over c < x < a, with the step g(c+) - g(c) of a worn
        layer that is too thin for the nodes, and over the worn part of the springs inside c.

        Source: mdr-5, Eqs. (5.34), (5.79).
        """
        maps, gamma = self.initial.maps, self.gamma[:, row].copy()
        inner = inverse_hypot(self.stick_radius[row], radius)
        places = np.add.outer(inner**2, self.end[row] ** 2 * maps.points)
        total = (1 / np.sqrt(places)) @ (maps.steps @ gamma)
        total += float(maps.at_stick @ gamma) / inner
        # int dw_c(x)/sqrt(x^2 - r^2) over the part of the trail above each radius.
        (passed, worn), at = self.trail[:, :, row], radius[:, None]
        ends = np.maximum(passed, at)
        logs = np.log(ends + np.sqrt((ends - at) * (ends + at)))
        # The first steps of the edge are below rounding.
        width = np.where(np.diff(passed) > 0, np.diff(passed), inf)
        return np.asarray((total + np.diff(logs, axis=1) @ (np.diff(worn) / width)) / np.pi)
