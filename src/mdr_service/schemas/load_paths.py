"""Requests about load histories: points of a load path, or identical cycles."""

from abc import abstractmethod
from typing import Annotated, Any, Literal

from pydantic import Field

from mdr_core.controls import default_samples
from mdr_service.schemas.contacts import Axes, Choice, Query, friction
from mdr_service.schemas.quantities import (
    LARGEST,
    ScalarOrArray,
    Signed,
    SignedScalarOrArray,
    Size,
    Strict,
    left_out,
    one_of,
    optional,
    positive,
    quantity,
)
from mdr_service.settings import SETTINGS

Regime = Literal["no_contact", "stick", "partial_slip", "full_slip"]
_Vertex = Annotated[list[float], Field(min_length=2, max_length=2)]


class NormalPoints(Choice):
    """Points of the normal load: exactly one control, a number or a list."""

    indentation_depth: SignedScalarOrArray = optional(
        "length", "Indentation depth d; below 0 a separation"
    )
    normal_force: ScalarOrArray = optional("force", "Normal force F_N")


class TangentialPoints(Choice):
    """Points of the tangential load: exactly one control, a number or a list.

    If the lists differ in length, the shorter one contains a single value.
    """

    tangential_displacement: SignedScalarOrArray = optional(
        "length", "Tangential displacement u_x of the bodies"
    )
    tangential_force: SignedScalarOrArray = optional(
        "force", "Tangential force F_x, |F_x| ≤ µ F_N everywhere on the path"
    )


class OscillatingNormalLoad(Choice):
    """Oscillating normal load: exactly one control, the mean, and an amplitude."""

    accompanying = frozenset({"amplitude"})

    indentation_depth: Size = optional("length", "Mean indentation depth d")
    normal_force: Size = optional("force", "Mean normal force F_N")
    amplitude: Size = quantity(
        "as the mean",
        "Amplitude of the normal load, at most the mean, in phase with the tangential load",
        default=0.0,
    )


class TangentialAmplitude(Choice):
    """Oscillating tangential load: exactly one control, the amplitude about zero."""

    tangential_displacement: float = positive(
        "length", "Amplitude of the tangential displacement u_x", default=None
    )
    tangential_force: float = positive(
        "force", "Amplitude of the tangential force F_x, at most µ F_N", default=None
    )


def _samples_per_step(default: int | None, text: str = "") -> Any:
    return quantity(
        "1",
        "Number of samples per load step, evenly spaced in the controls, the last at its "
        f"end{text}",
        default=default,
        ge=1,
        le=SETTINGS.max_length,
    )


class LoadPath(Strict):
    """Load steps between points of the normal and the tangential control."""

    normal: Choice
    tangential: Choice
    samples_per_step: int

    @property
    @abstractmethod
    def steps(self) -> int:
        """Number of load steps."""

    @property
    def per_step(self) -> int:
        """Number of samples on each load step."""
        return self.samples_per_step

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.steps * self.per_step


class History(LoadPath):
    """Points of a load path, which starts at first contact without load."""

    normal: NormalPoints
    tangential: TangentialPoints
    samples_per_step: int = _samples_per_step(1)

    @property
    def steps(self) -> int:
        return max(self.normal.count, self.tangential.count)


class Cycles(LoadPath):
    """Identical cycles of the tangential load between its amplitudes, from the positive one.

    They start from the mean normal load without a tangential load.
    """

    normal: OscillatingNormalLoad
    tangential: TangentialAmplitude
    count: int = quantity("1", "Number of cycles", default=1, ge=1, le=SETTINGS.max_length)
    samples_per_step: int = _samples_per_step(
        None,
        "; by default 20 where a depth and a tangential force, or a normal force and a "
        "displacement, both oscillate, else 1",
    )

    @property
    def steps(self) -> int:
        return 2 + 2 * self.count

    @property
    def per_step(self) -> int:
        if self.samples_per_step or not self.normal.amplitude:
            return self.samples_per_step or 1
        return default_samples(self.normal.control, self.tangential.control)


class HistoryState(Strict):
    """State at the end of a history, from which another request continues it."""

    contact: str = Field(
        description="Digest of the profile, the moduli, the friction coefficient and the controls.",
        max_length=64,
    )
    normal: Signed = quantity("as the control", "Last depth or normal force")
    tangential: Signed = quantity("as the control", "Last tangential displacement or force")
    dissipated_energy: float = quantity(
        "force*length", "Energy dissipated by slip since the start", ge=0, le=LARGEST**3
    )
    regime: Regime = Field(description="Slip regime of the last sample.")
    polyline: list[_Vertex] = Field(
        description="Slip memory: the vertices of a polyline from the axis, without the load point "
        "[length], or [length²] under a tangential force: normal coordinate + anchor and normal "
        "coordinate − anchor."
    )


class HistoryQuery(Query, json_schema_extra={"allOf": [one_of("history", "cycles")]}):
    """Contact with friction on a load path."""

    axes = Axes("tangential_displacement", ("tangential_force",), in_order=True)
    by_parameters = "Cycles of the tangential load"

    friction_coefficient: float = friction()
    history: History = left_out("Arbitrary load path, given by its points.")
    cycles: Cycles = left_out("In place of `history`: identical cycles of the tangential load.")
    initial_state: HistoryState = left_out(
        "`final_state` of an earlier history of the same contact and controls, which `history` "
        "continues."
    )
    return_state: bool = Field(default=False, description="Return `final_state`.")

    @property
    def loads(self) -> int:
        return self.path.samples if self.has("history") or self.has("cycles") else 0

    @property
    def path(self) -> LoadPath:
        """Load path; None if neither is given."""
        return self.cycles if self.has("cycles") else self.history

    @property
    def numbers(self) -> int:
        """Number of values in the state, which count in the cost of a query."""
        return sum(map(len, self.initial_state.polyline)) if self.has("initial_state") else 0
