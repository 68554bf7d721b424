"""Requests about oblique impacts."""

from typing import Annotated

from pydantic import Field

from mdr_core.validation import LOOSEST, TIGHTEST
from mdr_service.schemas.contacts import Axes, Friction, Query
from mdr_service.schemas.quantities import Positive, ScalarOrArray, SignedScalarOrArray


class ImpactQuery(Query):
    """Two bodies that hit each other obliquely, with friction."""

    axes = Axes(
        "tangential_velocity",
        ("tangential_rebound_velocity", "dissipated_energy"),
        curves="normal_velocity",
    )
    is_long = True

    friction_coefficient: Friction
    normal_mass: Positive
    """Effective mass m of the normal motion; of two free bodies 1/m = 1/m₁ + 1/m₂ [mass]"""
    tangential_mass: Positive
    """Effective mass of the contact point in tangential motion; 2/7 m for a solid sphere, because a
    force on its surface spins it too [mass]"""
    normal_velocity: ScalarOrArray
    """Velocity of approach, positive [length/time]"""
    tangential_velocity: SignedScalarOrArray
    """Tangential velocity of the contact point before the impact, of either sign [length/time]"""
    rtol: Annotated[float, Field(ge=TIGHTEST, le=LOOSEST)] = 1e-4
    """Required relative accuracy: a looser one takes less time, and about 2e-7 can be reached
    [1]"""

    @property
    def loads(self) -> int:
        velocities = self.normal_velocity, self.tangential_velocity
        return max(len(each) if isinstance(each, list) else 1 for each in velocities)
