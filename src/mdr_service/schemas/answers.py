"""The answers, as OpenAPI documents them; the service writes them straight from arrays."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from mdr_service.schemas.quantities import quantity


class Answer(BaseModel):
    """A part of an answer; a test holds every answer to it."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class AnswerWarning(Answer):
    """Something that the caller should know about an answer that is right."""

    code: str = Field(description="Stable name of the warning.")
    message: str = Field(description="What it means here.")


class NormalAnswer(Answer):
    """One entry per load in every list."""

    indentation_depth: list[float] = quantity("length", "Depth d of indentation")
    normal_force: list[float] = quantity("force", "Normal force F_N, positive in compression")
    contact_radius: list[float] = quantity("length", "Radius a of the contact")
    mean_pressure: list[float | None] = quantity(
        "pressure", "F_N/(π a²); null where it is infinite, with a warning `singular`"
    )
    normal_stiffness: list[float] = quantity("force/length", "dF_N/dd = 2 E* a")
    elastic_energy: list[float] = quantity("force*length", "Energy stored in the contact")
    method: str = Field(description="The cheapest route that meets the tolerance, as taken.")
    error_estimate: float = quantity("1", "Upper bound of the relative error of all numbers")
    warnings: list[AnswerWarning] = Field(description="What the caller should know.")


class ProfileField(Answer):
    """One parameter of a kind of profile."""

    name: str = Field(description="The field's name in a request.")
    dimension: str = Field(description="Its dimension, in the caller's units.")
    description: str = Field(description="What it is.")
    required: bool = Field(description="Whether it may be left out.")


class ProfileKind(Answer):
    """One kind of profile."""

    kind: str = Field(description="The name to ask for it by.")
    formula: str = Field(description="f(r), a length as a function of the radius.")
    fields: list[ProfileField] = Field(description="Its parameters.")
    closed_forms: list[str] = Field(
        description="The quantities that are answered from a closed form."
    )


class Catalogue(Answer):
    """Every kind of profile that can be asked for."""

    profiles: list[ProfileKind] = Field(description="The kinds.")


class Health(Answer):
    """The service is ready."""

    status: Literal["ok"]


class ProblemError(Answer):
    """What is wrong with one value of the request."""

    pointer: str = Field(description="JSON pointer to the value (RFC 6901).")
    detail: str = Field(description="What is wrong with it.")


class Problem(Answer):
    """A failure (RFC 9457)."""

    type: str = Field(description="Stable name of the kind of failure, a URI.")
    title: str = Field(description="The kind of failure in words; the same for all of a type.")
    status: int = Field(description="The HTTP status.")
    detail: str = Field(description="What went wrong this time.")
    errors: list[ProblemError] = Field(
        default=[], max_length=20, description="The values at fault, the first twenty of them."
    )
