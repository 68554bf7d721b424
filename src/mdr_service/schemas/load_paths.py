"""Requests about load histories: points of a load path, or identical cycles."""

from abc import abstractmethod
from typing import Annotated, Literal

from pydantic import Field

from mdr_core.controls import default_samples
from mdr_service.schemas.contacts import Axes, Choice, Friction, Query
from mdr_service.schemas.quantities import (
    ABSENT,
    LARGEST,
    Positive,
    ScalarOrArray,
    Signed,
    SignedScalarOrArray,
    Size,
    Strict,
    one_of,
)
from mdr_service.settings import SETTINGS

Regime = Literal["no_contact", "stick", "partial_slip", "full_slip"]
_Count = Annotated[int, Field(ge=1, le=SETTINGS.max_length)]
_Vertex = Annotated[list[float], Field(min_length=2, max_length=2)]


class NormalPoints(Choice):
    """Points of the normal load: exactly one control, a number or a list."""

    indentation_depth: SignedScalarOrArray = ABSENT
    """Indentation depth d; below 0 a separation [length]"""
    normal_force: ScalarOrArray = ABSENT
    """Normal force F_N [force]"""


class TangentialPoints(Choice):
    """Points of the tangential load: exactly one control, a number or a list.

    If the lists differ in length, the shorter one contains a single value.
    """

    tangential_displacement: SignedScalarOrArray = ABSENT
    """Tangential displacement u_x of the bodies [length]"""
    tangential_force: SignedScalarOrArray = ABSENT
    """Tangential force F_x, |F_x| ≤ µ F_N everywhere on the path [force]"""


class OscillatingNormalLoad(Choice):
    """Oscillating normal load: exactly one control, the mean, and an amplitude."""

    accompanying = frozenset({"amplitude"})

    indentation_depth: Size = ABSENT
    """Mean indentation depth d [length]"""
    normal_force: Size = ABSENT
    """Mean normal force F_N [force]"""
    amplitude: Size = 0.0
    """Amplitude of the normal load, at most the mean, in phase with the tangential load [as the
    mean]"""


class TangentialAmplitude(Choice):
    """Oscillating tangential load: exactly one control, the amplitude about zero."""

    tangential_displacement: Positive = ABSENT
    """Amplitude of the tangential displacement u_x [length]"""
    tangential_force: Positive = ABSENT
    """Amplitude of the tangential force F_x, at most µ F_N [force]"""


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
    samples_per_step: _Count = 1
    """Number of samples per load step, evenly spaced in the controls, the last at its end [1]"""

    @property
    def steps(self) -> int:
        return max(self.normal.count, self.tangential.count)


class Cycles(LoadPath):
    """Identical cycles of the tangential load between its amplitudes, from the positive one.

    They start from the mean normal load without a tangential load.
    """

    normal: OscillatingNormalLoad
    tangential: TangentialAmplitude
    count: _Count = 1
    """Number of cycles [1]"""
    samples_per_step: _Count = ABSENT
    """Number of samples per load step, evenly spaced in the controls, the last at its end; by
    default 20 where a depth and a tangential force, or a normal force and a displacement, both
    oscillate, else 1 [1]"""

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

    contact: Annotated[str, Field(max_length=64)]
    """Digest of the profile, the moduli, the friction coefficient and the controls."""
    normal: Signed
    """Last depth or normal force [as the control]"""
    tangential: Signed
    """Last tangential displacement or force [as the control]"""
    dissipated_energy: Annotated[float, Field(ge=0, le=LARGEST**3)]
    """Energy dissipated by slip since the start [force*length]"""
    regime: Regime
    """Slip regime of the last sample."""
    polyline: list[_Vertex]
    """Slip memory: the vertices of a polyline from the axis, without the load point [length], or
    [length²] under a tangential force: normal coordinate + anchor and normal coordinate −
    anchor."""


class HistoryQuery(Query, json_schema_extra={"allOf": [one_of("history", "cycles")]}):
    """Contact with friction on a load path."""

    axes = Axes("tangential_displacement", ("tangential_force",), in_order=True)
    by_parameters = "Cycles of the tangential load"

    friction_coefficient: Friction
    history: History = ABSENT
    """Arbitrary load path, given by its points."""
    cycles: Cycles = ABSENT
    """In place of `history`: identical cycles of the tangential load."""
    initial_state: HistoryState = ABSENT
    """`final_state` of an earlier history of the same contact and controls, which `history`
    continues."""
    return_state: bool = False
    """Return `final_state`."""

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
