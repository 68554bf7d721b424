"""Requests about oblique impacts."""

from mdr_core.validation import LOOSEST, TIGHTEST
from mdr_service.schemas.contacts import Axes, Query, friction
from mdr_service.schemas.quantities import ScalarOrArray, SignedScalarOrArray, positive, quantity

_VELOCITY = "length/time"


class ImpactQuery(Query):
    """Two bodies that hit each other obliquely, with friction."""

    axes = Axes(
        "tangential_velocity",
        ("tangential_rebound_velocity", "dissipated_energy"),
        curves="normal_velocity",
    )
    is_long = True

    friction_coefficient: float = friction()
    normal_mass: float = positive(
        "mass", "Effective mass m of the normal motion; of two free bodies 1/m = 1/m₁ + 1/m₂"
    )
    tangential_mass: float = positive(
        "mass",
        "Effective mass of the contact point in tangential motion; 2/7 m for a solid sphere, "
        "because a force on its surface spins it too",
    )
    normal_velocity: ScalarOrArray = quantity(_VELOCITY, "Velocity of approach, positive")
    tangential_velocity: SignedScalarOrArray = quantity(
        _VELOCITY, "Tangential velocity of the contact point before the impact, of either sign"
    )
    rtol: float = quantity(
        "1",
        "Required relative accuracy: a looser one takes less time, and about 2e-7 can be reached",
        default=1e-4,
        ge=TIGHTEST,
        le=LOOSEST,
    )

    @property
    def loads(self) -> int:
        velocities = self.normal_velocity, self.tangential_velocity
        return max(len(each) if isinstance(each, list) else 1 for each in velocities)
