"""Closed-form displacements outside a contact equal their integral."""

from __future__ import annotations

import numpy as np
import pytest
from mpmath import mp, mpf

from mdr_core import fields, normal
from mdr_core.profiles import Cone, Paraboloid, Profile
from tests.core.comparison import EPS

A, E_STAR = 0.37, 2.1
#: From the edge to the far field, including radii next to the edge.
RADII = A * (1 + np.concatenate([[0.0], np.geomspace(1e-15, 1e7, 45)]))
#: Rounding errors of a closed form, including that of the root next to the edge.
BOUND = 16 * EPS


def truth(slope: object, r: float) -> mpf:
    """(2/pi) int_0^a g'(x) arcsin(x/r) dx: Eq. (5.75) for d - g, integrated by parts."""
    with mp.workdps(25):
        a, point = mpf(A), mpf(r)
        # x = a sin t is smooth at the edge r = a, too.
        return (2 / mp.pi) * mp.quad(
            lambda t: slope(a * mp.sin(t)) * mp.asin(a * mp.sin(t) / point) * a * mp.cos(t),
            [0, mp.pi / 2],
        )


@pytest.mark.parametrize(
    ("profile", "slope"),
    [
        pytest.param(Cone(0.3), lambda _x: mp.pi / 2 * mpf(0.3), id="cone"),
        pytest.param(Paraboloid(1.7), lambda x: 2 * x / mpf(1.7), id="paraboloid"),
    ],
)
def test_displacement_outside_the_contact(profile: Profile, slope: object) -> None:
    contact = normal.solve(profile, E_STAR, contact_radius=A)
    result = fields.normal_displacement(contact, RADII)
    for r, value in zip(RADII.tolist(), result.tolist(), strict=True):
        exact = truth(slope, r)
        assert abs(mpf(value) - exact) <= BOUND * exact, r
