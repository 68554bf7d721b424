"""Requests about fretting wear: the limiting state, and its evolution over the cycles."""

from typing import Annotated, Literal

from pydantic import Field

from mdr_core.validation import LOOSEST
from mdr_core.wear.evolution import COARSEST, DEFAULT_RESOLUTION, FINEST, TIGHTEST_INTEGRATION
from mdr_service.schemas.contacts import Axes, Choice, friction
from mdr_service.schemas.fields import FieldQuery, OnceEach, quantities
from mdr_service.schemas.load_paths import TangentialAmplitude
from mdr_service.schemas.quantities import MANY, ScalarOrArray, Size, optional, positive, quantity

WearField = Literal["initial_profile", "limiting_profile", "worn_depth", "pressure"]
EvolutionField = Literal["profile", "worn_depth", "pressure"]
_WITH_RADII = "with `radius` or `points`"


class ConstantNormalLoads(Choice):
    """Normal load held constant during wear: exactly one control, a number or a list."""

    indentation_depth: ScalarOrArray = optional("length", "Indentation depth d")
    normal_force: ScalarOrArray = optional("force", "Normal force F_N")


class ConstantNormalLoad(Choice):
    """Normal load held constant during wear: exactly one control, a number."""

    indentation_depth: Size = optional("length", "Indentation depth d")
    normal_force: Size = optional("force", "Normal force F_N")


class Oscillation(Choice):
    """Tangential oscillation: exactly one amplitude, one for all normal loads or one for each."""

    tangential_displacement: ScalarOrArray = optional("length", "Amplitude of the displacement u_x")
    tangential_force: ScalarOrArray = optional("force", "Amplitude of the force F_x, at most µ F_N")


class _FrettingQuery(FieldQuery):
    friction_coefficient: float = friction()


class WearQuery(_FrettingQuery):
    """Limiting state of a contact that wears under a tangential oscillation."""

    axes = Axes("stick_radius", ("worn_volume", "wear_radius"))
    by_parameters = "Limiting state of fretting wear"

    load: ConstantNormalLoads
    oscillation: Oscillation
    quantities: Annotated[list[WearField], OnceEach] = quantities(
        _WITH_RADII, default=["initial_profile", "limiting_profile"]
    )


class EvolutionQuery(_FrettingQuery):
    """Contact that wears under a tangential oscillation, over the cycles."""

    axes = Axes("cycles", ("worn_volume", "contact_radius"))
    is_long = True

    load: ConstantNormalLoad
    oscillation: TangentialAmplitude
    wear_coefficient: float = positive(
        "1/pressure", "Wear coefficient K: worn volume per dissipated energy"
    )
    cycles: list[Annotated[float, Field(ge=0, le=1e12)]] = quantity(
        "1", "Numbers of cycles of the response, ascending, up to 1e12", **MANY
    )
    resolution: int = quantity(
        "1",
        "Number of nodes over the worn annulus, in addition to 16",
        default=DEFAULT_RESOLUTION,
        ge=COARSEST,
        le=FINEST,
    )
    rtol: float = quantity(
        "1",
        "Tolerance of the integration over the cycles; the accuracy depends on `resolution` too",
        default=1e-6,
        ge=TIGHTEST_INTEGRATION,
        le=LOOSEST,
    )
    quantities: Annotated[list[EvolutionField], OnceEach] = quantities(
        _WITH_RADII, default=["profile", "pressure"]
    )

    @property
    def loads(self) -> int:
        return len(self.cycles)
