"""The loads of a request: exactly one control each, at one point or along a way."""

from abc import abstractmethod
from itertools import pairwise
from typing import Any, ClassVar, Self

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from mdr_service.schemas.quantities import (
    ScalarOrArray,
    SignedScalarOrArray,
    Size,
    Strict,
    drop_null_defaults,
    positive,
    quantity,
)
from mdr_service.settings import SETTINGS


def _describe_choice(schema: dict[str, Any]) -> None:
    drop_null_defaults(schema)
    controls = [name for name, field in schema["properties"].items() if "default" not in field]
    schema["oneOf"] = [{"required": [name]} for name in controls]


class Choice(Strict, json_schema_extra=_describe_choice):
    """Fields of which exactly one is given, the control."""

    beside: ClassVar[frozenset[str]] = frozenset()
    """Fields with a default, which go with any control."""

    @model_validator(mode="after")
    def _exactly_one(self) -> Self:
        if len(self.model_fields_set - self.beside) != 1:
            names = ", ".join(name for name in type(self).model_fields if name not in self.beside)
            raise PydanticCustomError("one_control", f"exactly one of {names} is needed")
        return self

    @property
    def control(self) -> str:
        """The name of the one that is given."""
        (name,) = self.model_fields_set - self.beside
        return name

    @property
    def value(self) -> float | list[float]:
        """The one that is given."""
        given: float | list[float] = getattr(self, self.control)
        return given

    @property
    def count(self) -> int:
        """How many values are given."""
        return len(self.value) if isinstance(self.value, list) else 1

    def place(self, index: int) -> tuple[str | int, ...]:
        """Return the path from here to one of the values."""
        return (self.control, index) if isinstance(self.value, list) else (self.control,)


class Load(Choice):
    """Exactly one control, a number or a list of them, each 0 or from 1e-90 to 1e30."""

    # A control that is left out is none; one that is given is never null.
    indentation_depth: ScalarOrArray = quantity("length", "Depth d of indentation", default=None)
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)
    contact_radius: ScalarOrArray = quantity("length", "Radius a of the contact", default=None)


class Tangential(Choice):
    """Exactly one control, a number or a list: one for all normal loads, or as many as they."""

    tangential_force: SignedScalarOrArray = quantity(
        "force", "Tangential force F_x, |F_x| ≤ µ F_N, of either sign", default=None
    )
    tangential_displacement: SignedScalarOrArray = quantity(
        "length", "Tangential displacement u_x of the bodies, of either sign", default=None
    )
    stick_radius: ScalarOrArray = quantity(
        "length", "Radius c of the stick zone, at most a, and not inside a flat", default=None
    )


class NormalPoints(Choice):
    """Exactly one control, a number or a list of the points that the normal load goes through."""

    indentation_depth: SignedScalarOrArray = quantity(
        "length", "Depth d of indentation; below 0 a gap, in which nothing touches", default=None
    )
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)


class TangentialPoints(Choice):
    """Exactly one control, a number or a list of the points that the tangential load goes through.

    Where one list is longer than the other, the other holds a single value.
    """

    tangential_displacement: SignedScalarOrArray = quantity(
        "length", "Tangential displacement u_x of the bodies, of either sign", default=None
    )
    tangential_force: SignedScalarOrArray = quantity(
        "force",
        "Tangential force F_x, of either sign, |F_x| ≤ µ F_N at the points and between them",
        default=None,
    )


class NormalSwing(Choice):
    """Exactly one control, the mean of the normal load, and how far it swings about it."""

    beside = frozenset({"amplitude"})

    indentation_depth: Size = quantity("length", "Mean depth d of indentation", default=None)
    normal_force: Size = quantity("force", "Mean normal force F_N", default=None)
    amplitude: Size = quantity(
        "as the mean",
        "Amplitude of the normal load, at most the mean, in phase with the tangential load",
        default=0.0,
    )


class TangentialSwing(Choice):
    """Exactly one control, the amplitude of the tangential load about zero."""

    tangential_displacement: float = positive(
        "length", "Amplitude of the tangential displacement u_x", default=None
    )
    tangential_force: float = positive(
        "force", "Amplitude of the tangential force F_x", default=None
    )


class HeldLoad(Choice):
    """Exactly one control, a number or a list of them: what is held while the contact wears."""

    indentation_depth: ScalarOrArray = quantity("length", "Depth d of indentation", default=None)
    normal_force: ScalarOrArray = quantity("force", "Normal force F_N", default=None)


class HeldPoint(Choice):
    """Exactly one control, a number: what is held while the contact wears."""

    indentation_depth: Size = quantity("length", "Depth d of indentation", default=None)
    normal_force: Size = quantity("force", "Normal force F_N", default=None)


class Oscillation(Choice):
    """Exactly one amplitude, a number or a list: one for all normal loads, or as many as they."""

    tangential_displacement: ScalarOrArray = quantity(
        "length", "Amplitude of the tangential displacement u_x", default=None
    )
    tangential_force: ScalarOrArray = quantity(
        "force", "Amplitude of the tangential force F_x, at most µ F_N", default=None
    )


def _samples_per_step() -> Any:
    return quantity(
        "1",
        "Samples answered on the way to each point, evenly in the controls, the last at the point",
        default=1,
        ge=1,
        le=SETTINGS.max_samples,
    )


class _Way(Strict):
    normal: Choice
    tangential: Choice
    samples_per_step: int

    @property
    @abstractmethod
    def steps(self) -> int:
        """How many straight legs the load goes."""

    @property
    def samples(self) -> int:
        """How many samples it is about."""
        return self.steps * self.samples_per_step

    @property
    def curved(self) -> int:
        """How many of the samples end a way that is straight neither in forces nor in depths.

        There a depth and a tangential force change, or a normal force and a displacement.
        """
        by_force = self.tangential.control == "tangential_force"
        if by_force == (self.normal.control == "normal_force"):
            return 0
        return self._changes * self.samples_per_step

    @property
    def forced(self) -> int:
        """How many of the samples have a normal force of their own, whose depth is to be found."""
        if self.normal.control != "normal_force":
            return 0
        return self._normal_steps * self.samples_per_step

    @property
    @abstractmethod
    def _normal_steps(self) -> int:
        """On how many legs the normal load may change."""

    @property
    @abstractmethod
    def _changes(self) -> int:
        """On how many legs both loads change."""

    def place(self, axis: str, step: int) -> tuple[str | int, ...]:
        """Return the path from here to what says where a leg goes."""
        choice: Choice = getattr(self, axis)
        return (axis, *choice.place(min(step, choice.count - 1)))


class History(_Way):
    """Points that the loads go through, straight from one to the next.

    The bodies just touch at first, without load, and go straight to the first point.
    """

    normal: NormalPoints = Field(description="Exactly one control: depth or normal force.")
    tangential: TangentialPoints = Field(
        description="Exactly one control: displacement or tangential force."
    )
    samples_per_step: int = _samples_per_step()

    @property
    def steps(self) -> int:
        return max(self.normal.count, self.tangential.count)

    @property
    def _normal_steps(self) -> int:
        return self.normal.count

    @property
    def _changes(self) -> int:
        ways = [
            [0.0, *(each.value if isinstance(each.value, list) else [each.value])]
            for each in (self.normal, self.tangential)
        ]
        normal, tangential = (way + way[-1:] * (self.steps + 1 - len(way)) for way in ways)
        legs = zip(pairwise(normal), pairwise(tangential), strict=True)
        return sum(a != b and c != d for (a, b), (c, d) in legs)


class Cycles(_Way):
    """Equal cycles of the tangential load between its amplitudes, from the upper one.

    The way there goes over the mean normal load, without a tangential one.
    """

    normal: NormalSwing = Field(
        description="Exactly one control: mean depth or mean normal force; and an amplitude."
    )
    tangential: TangentialSwing = Field(
        description="Exactly one control: the amplitude of displacement or tangential force."
    )
    count: int = quantity("1", "Number of cycles", default=1, ge=1, le=SETTINGS.max_cycles)
    samples_per_step: int = _samples_per_step()

    @property
    def steps(self) -> int:
        return 2 + 2 * self.count

    @property
    def _normal_steps(self) -> int:
        return self.steps if self.normal.amplitude else 1

    @property
    def _changes(self) -> int:
        return self.steps - 1 if self.normal.amplitude else 0
