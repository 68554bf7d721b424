"""Number of evaluations per result: of integrands and of profile functions.

Evaluations are counted, not timed, because a count does not depend on the machine.
"""

from __future__ import annotations

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import numpy as np

from mdr_core import fields, normal, quadrature, tangential
from mdr_core.elementwise import in_blocks
from mdr_core.profiles import KINDS, PowerTerm

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from mdr_core.profiles import Profile

#: One profile of every kind; the contact radius is 1, and its break lies inside.
PROFILES: dict[str, dict[str, Any]] = {
    "paraboloid": {"radius": 1.3},
    "cone": {"slope": 0.3},
    "power": {"coefficient": 0.7, "exponent": 1.5},
    "series": {"terms": [{"coefficient": 0.4, "exponent": 2}, {"coefficient": 0.1, "exponent": 4}]},
    "flat_punch": {"radius": 1.0},
    "sphere": {"radius": 2.0},
    "two_spheres": {"radii": [2.0, -2.6]},
    "ellipsoid": {"radius": 2.0, "height": 1.0},
    "hyperboloid": {"slope": 0.4, "tip_radius": 1.3},
    "rounded_punch": {"flat_radius": 0.5, "rounding_radius": 2.0},
    "truncated_cone": {"flat_radius": 0.5, "slope": 0.3},
    "truncated_paraboloid": {"flat_radius": 0.5, "radius": 2.0},
    "rounded_cone": {"slope": 0.4, "tip_radius": 1.5},
    "spherical_tip_cone": {"slope": 0.5, "tip_radius": 1.0},
    "capped_paraboloid": {"cap_radius": 0.5, "tip_radius": 3.0, "radius": 1.1},
    "tabulated": {
        "r": np.linspace(0.0, 1.25, 40).tolist(),
        "f": (np.linspace(0.0, 1.25, 40) ** 2 / 4).tolist(),
    },
}
FIELDS = ("pressure", "shear_stress", "slip", "normal_displacement")
RADII = (np.arange(200) + 0.5) / 200
#: Radii outside the contact, where the displacement is an integral.
BEYOND = 1.0 + RADII
FRICTION, STICK = 0.3, 0.8
#: Profile functions of a radius or of a contact coordinate.
_FUNCTIONS = ("f", "df", "g", "dg", "depth", "depth_slope", "reduced_force")


@dataclass
class Count:
    """Numbers of evaluated values."""

    integrand: int = 0
    profile: int = 0


@contextmanager
def counted(kind: type[Profile] | None = None) -> Iterator[Count]:
    """Count the values of integrands and of the functions of one kind of profile."""
    count = Count()
    apply = quadrature._apply

    def counting_apply(
        h: Callable[..., Any], rule: Any, lower: Any, length: Any, index: Any
    ) -> Any:
        # Larger blocks call the same function again.
        if len(in_blocks(length.size, rule[0].size)) <= 1:
            count.integrand += rule[0].size * length.size
        return apply(h, rule, lower, length, index)

    with ExitStack() as stack:
        stack.enter_context(patch.object(quadrature, "_apply", counting_apply))
        for name in _FUNCTIONS if kind else ():
            stack.enter_context(patch.object(kind, name, _counting(kind, name, count)))
        yield count


def _counting(kind: type[Profile], name: str, count: Count) -> Callable[..., Any]:
    inner = getattr(kind, name)

    def values(self: Profile, x: Any) -> Any:
        count.profile += np.size(x)
        return inner(self, x)

    return values


def profile_of(kind: str) -> Profile:
    """The profile of a kind."""
    given = dict(PROFILES[kind])
    if kind == "series":
        given["terms"] = tuple(PowerTerm(**term) for term in given["terms"])
    return KINDS[kind](**given)


def solved(profile: Profile) -> tangential.TangentialContact:
    """Contact of radius 1 with stick radius 0.8; a flat punch takes forces."""
    if profile.is_flat_punch:
        pressed = normal.solve(profile, 1.0, normal_force=1.0)
        return tangential.solve(pressed, 0.8, FRICTION, tangential_force=0.5 * FRICTION)
    pressed = normal.solve(profile, 1.0, contact_radius=1.0)
    return tangential.solve(pressed, 0.8, FRICTION, stick_radius=STICK)


def field(name: str, contact: tangential.TangentialContact) -> np.ndarray:
    """One field; for the displacement, its part outside the contact."""
    if name == "normal_displacement":
        return fields.normal_displacement(contact.normal, BEYOND)
    if name == "pressure":
        return fields.pressure(contact.normal, RADII)
    return getattr(fields, name)(contact, RADII)


def cost(kind: str, name: str) -> int:
    """Number of integrand values for a field at all radii."""
    profile = profile_of(kind)
    contact = solved(profile)
    # A table is resolved only once, which is not part of the field's cost.
    field(name, contact)
    with counted() as count:
        field(name, contact)
    return count.integrand
