"""Requests about load histories: points of a load path, or identical cycles."""

from abc import abstractmethod
from typing import Annotated, Literal

from pydantic import Field

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
    positive,
    quantity,
)
from mdr_service.settings import SETTINGS

Regime = Literal["no_contact", "stick", "partial_slip", "full_slip"]
# Sums of a vertex, and the numbers of an arc.
_Vertex = Annotated[list[float], Field(min_length=2, max_length=5)]


class NormalPoints(Choice):
    """Points of the normal load: exactly one control, a number or a list."""

    indentation_depth: SignedScalarOrArray = quantity(
        "length", "Indentation depth d; negative values are a separation", default=None
    )
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)


class TangentialPoints(Choice):
    """Points of the tangential load: exactly one control, a number or a list.

    If one list is longer than the other, the other holds a single value.
    """

    tangential_displacement: SignedScalarOrArray = quantity(
        "length", "Tangential displacement u_x of the bodies, of either sign", default=None
    )
    tangential_force: SignedScalarOrArray = quantity(
        "force",
        "Tangential force F_x of either sign, |F_x| ≤ µ F_N at the points and between them",
        default=None,
    )


class OscillatingNormalLoad(Choice):
    """Oscillating normal load: exactly one control, the mean, and an amplitude."""

    optional = frozenset({"amplitude"})

    indentation_depth: Size = quantity("length", "Mean indentation depth d", default=None)
    normal_force: Size = quantity("force", "Mean normal force F_N", default=None)
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
        "force", "Amplitude of the tangential force F_x", default=None
    )


class LoadPath(Strict):
    """Load steps, along which normal and tangential control vary linearly."""

    normal: Choice
    tangential: Choice
    samples_per_step: int = quantity(
        "1",
        "Number of samples per load step, evenly spaced in the controls, the last at its end",
        default=1,
        ge=1,
        le=SETTINGS.max_length,
    )

    @property
    @abstractmethod
    def steps(self) -> int:
        """Number of load steps."""

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.steps * self.samples_per_step

    @property
    def nonlinear(self) -> bool:
        """True for a depth with a tangential force, or a normal force with a displacement."""
        force_prescribed = self.tangential.control == "tangential_force"
        return force_prescribed == (self.normal.control == "indentation_depth")

    def place(self, axis: str, step: int) -> tuple[str | int, ...]:
        """Return the path from here to the value at the end of a load step, the last of fewer."""
        choice: Choice = getattr(self, axis)
        index = (min(step, choice.count - 1),) if isinstance(choice.value, list) else ()
        return (axis, choice.control, *index)


class History(LoadPath):
    """Points of a load path, which starts at first contact without load."""

    normal: NormalPoints = Field(description="Exactly one control: depth or normal force.")
    tangential: TangentialPoints = Field(
        description="Exactly one control: displacement or tangential force."
    )

    @property
    def steps(self) -> int:
        return max(self.normal.count, self.tangential.count)


class Cycles(LoadPath):
    """Identical cycles of the tangential load between its amplitudes, from the upper one.

    They start from the mean normal load without a tangential load.
    """

    normal: OscillatingNormalLoad = Field(
        description="Exactly one control: mean depth or mean normal force; and an amplitude."
    )
    tangential: TangentialAmplitude = Field(
        description="Exactly one control: the amplitude of displacement or tangential force."
    )
    count: int = quantity("1", "Number of cycles", default=1, ge=1, le=SETTINGS.max_length)

    @property
    def steps(self) -> int:
        return 2 + 2 * self.count


class HistoryState(Strict):
    """State at the end of a history, with which another request carries it on."""

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
    polylines: list[list[_Vertex]] = Field(
        description="Slip memory: the vertices of a polyline from the axis, without the load point "
        "[length], or [length²] under a tangential force: normal coordinate + anchor and normal "
        "coordinate − anchor. Three polylines, with three numbers more on each arc, after steps "
        "along which a depth and a tangential force, or a normal force and a displacement, both "
        "change.",
        min_length=1,
        max_length=3,
    )


class HistoryQuery(Query, json_schema_extra={"allOf": [one_of("history", "cycles")]}):
    """Contact with friction on a load path."""

    axes = Axes("tangential_displacement", ("tangential_force",), in_order=True)

    friction_coefficient: float = friction()
    history: History = left_out("Arbitrary load path, given by its points.")
    cycles: Cycles = left_out("In place of `history`: identical cycles of the tangential load.")
    initial_state: HistoryState = left_out(
        "`final_state` of the history that this one carries on, of the same contact and controls; "
        "with `history` only."
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
        """Number of values of the state, which takes time as others do."""
        lines = self.initial_state.polylines if self.has("initial_state") else []
        return sum(len(vertex) for line in lines for vertex in line)
