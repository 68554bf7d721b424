"""Requests about fretting wear: the limiting state, and its evolution over the cycles."""

from typing import Annotated, Literal

from pydantic import Field

from mdr_core.validation import LOOSEST
from mdr_core.wear.evolution import COARSEST, DEFAULT_RESOLUTION, FINEST, TIGHTEST_INTEGRATION
from mdr_service.schemas.contacts import Axes, Choice, Friction
from mdr_service.schemas.fields import FieldQuery, OnceEach
from mdr_service.schemas.load_paths import TangentialAmplitude
from mdr_service.schemas.quantities import ABSENT, Many, Positive, ScalarOrArray, Size

WearField = Literal["initial_profile", "limiting_profile", "worn_depth", "pressure"]
EvolutionField = Literal["profile", "worn_depth", "pressure"]


class ConstantNormalLoads(Choice):
    """Normal load held constant during wear: exactly one control, a number or a list."""

    indentation_depth: ScalarOrArray = ABSENT
    """Indentation depth d [length]"""
    normal_force: ScalarOrArray = ABSENT
    """Normal force F_N [force]"""


class ConstantNormalLoad(Choice):
    """Normal load held constant during wear: exactly one control, a number."""

    indentation_depth: Size = ABSENT
    """Indentation depth d [length]"""
    normal_force: Size = ABSENT
    """Normal force F_N [force]"""


class Oscillation(Choice):
    """Tangential oscillation: exactly one amplitude, one for all normal loads or one for each."""

    tangential_displacement: ScalarOrArray = ABSENT
    """Amplitude of the displacement u_x [length]"""
    tangential_force: ScalarOrArray = ABSENT
    """Amplitude of the force F_x, at most µ F_N [force]"""


class _FrettingQuery(FieldQuery):
    friction_coefficient: Friction


class WearQuery(_FrettingQuery):
    """Limiting state of a contact that wears under a tangential oscillation."""

    axes = Axes("stick_radius", ("worn_volume", "wear_radius"))
    by_parameters = "Limiting state of fretting wear"

    load: ConstantNormalLoads
    oscillation: Oscillation
    quantities: OnceEach[WearField] = Field(default=["initial_profile", "limiting_profile"])
    """Fields to compute, each once; with `radius` or `points`"""


class EvolutionQuery(_FrettingQuery):
    """Contact that wears under a tangential oscillation, over the cycles."""

    axes = Axes("cycles", ("worn_volume", "contact_radius"))
    is_long = True

    load: ConstantNormalLoad
    oscillation: TangentialAmplitude
    wear_coefficient: Positive
    """Wear coefficient K: worn volume per dissipated energy [1/pressure]"""
    cycles: Many[Annotated[float, Field(ge=0, le=1e12)]]
    """Numbers of cycles of the response, ascending, up to 1e12 [1]"""
    resolution: Annotated[int, Field(ge=COARSEST, le=FINEST)] = DEFAULT_RESOLUTION
    """Number of nodes over the worn annulus, in addition to 16 [1]"""
    rtol: Annotated[float, Field(ge=TIGHTEST_INTEGRATION, le=LOOSEST)] = 1e-6
    """Tolerance of the integration over the cycles; the accuracy depends on `resolution` too [1]"""
    quantities: OnceEach[EvolutionField] = Field(default=["profile", "pressure"])
    """Fields to compute, each once; with `radius` or `points`"""

    @property
    def loads(self) -> int:
        return len(self.cycles)
