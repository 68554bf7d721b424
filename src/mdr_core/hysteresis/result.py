"""Parameters that fit a hysteresis loop.

Source: notes, §15.
"""

from dataclasses import dataclass
from typing import ClassVar, Final

from mdr_core.errors import Notice
from mdr_core.estimation import LeastSquaresFit
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array

PARAMETERS: Final = (
    *("g_star", "friction_coefficient", "force_offset", "rig_compliance"),
    "displacement_offset",
)
"""Quantities that can be fitted."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LoopFit(LeastSquaresFit):
    """Fitted parameters of a loop with their standard errors."""

    turning: TangentialContact
    """Contact at the turning points of the loop, as on first loading."""
    force_offset: float
    """F_0, the force in the middle of the loop [force]."""
    displacement_offset: float
    """U_0, the displacement in the middle of the loop [length]."""
    rig_compliance: float
    """C, as given or fitted [length/force]."""
    tangential_displacement: Array
    """Measured displacements [length], shape (k,)."""
    tangential_force: Array
    """Fitted forces [force], shape (k,)."""
    dissipated_energy_error: float
    """Standard deviation of `dissipated_energy`, by those of the parameters [force length]."""
    quantities: ClassVar[tuple[str, ...]] = (
        *("fit", "g_star", "friction_coefficient", "force_offset", "rig_compliance"),
        "displacement_offset",
        *("standard_errors", "correlation", "noise", "misfit"),
        *("dissipated_energy", "dissipated_energy_error"),
        *("tangential_displacement", "tangential_force", "residual"),
    )

    @property
    def solved(self) -> TangentialContact:
        """Contact on which the validity depends."""
        return self.turning

    @property
    def normal(self) -> NormalContact:
        """Contact under the normal load."""
        return self.turning.normal

    @property
    def g_star(self) -> float:
        """Effective shear modulus G* [pressure]."""
        return float(self.turning.g_star)

    @property
    def friction_coefficient(self) -> float:
        """mu [1]."""
        return float(self.turning.friction_coefficient)

    @property
    def dissipated_energy(self) -> float:
        """Energy of a cycle, four times that dissipated on first loading [force length]."""
        return 4 * float(self.turning.dissipated_energy)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        return *self.turning.warnings_without_bodies, *self.notices
