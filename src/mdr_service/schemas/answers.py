"""The answers, as OpenAPI documents them; the service writes them straight from arrays."""

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from mdr_service.schemas.quantities import drop_null_defaults, quantity


class Answer(BaseModel):
    """A part of an answer; a test holds every answer to it."""

    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class AnswerWarning(Answer):
    """Something that the caller should know about an answer that is right."""

    code: str = Field(description="Stable name of the warning.")
    message: str = Field(description="What it means here.")


class Known(Answer):
    """How an answer was found, and what to know about it."""

    method: str = Field(description="The cheapest route that meets the tolerance, as taken.")
    error_estimate: float = quantity("1", "Upper bound of the relative error of all numbers")
    warnings: list[AnswerWarning] = Field(description="What the caller should know.")


class NormalAnswer(Known):
    """One entry per load in every list."""

    indentation_depth: list[float] = quantity("length", "Depth d of indentation")
    normal_force: list[float] = quantity("force", "Normal force F_N, positive in compression")
    contact_radius: list[float] = quantity("length", "Radius a of the contact")
    mean_pressure: list[float | None] = quantity(
        "pressure", "F_N/(π a²); null where it is infinite, with a warning `singular`"
    )
    normal_stiffness: list[float] = quantity("force/length", "dF_N/dd = 2 E* a")
    elastic_energy: list[float] = quantity("force*length", "Energy stored in the contact")


class HistoryAnswer(Known):
    """One entry per sample in every list but the last ones.

    Those are about the end of the history, and about each of the cycles where there are any.
    """

    model_config = ConfigDict(json_schema_extra=drop_null_defaults)

    step: list[int] = quantity("1", "Index of the point that the load goes to, from 0")
    indentation_depth: list[float] = quantity("length", "Depth d of indentation, below 0 a gap")
    normal_force: list[float] = quantity("force", "Normal force F_N, positive in compression")
    contact_radius: list[float] = quantity("length", "Radius a of the contact, 0 in a gap")
    tangential_displacement: list[float] = quantity(
        "length", "Tangential displacement u_x of the bodies"
    )
    tangential_force: list[float] = quantity("force", "Tangential force F_x")
    dissipated_energy: list[float] = quantity(
        "force*length", "Energy dissipated by slip since the start"
    )
    elastic_energy: list[float] = quantity("force*length", "Energy stored by the normal load")
    tangential_energy: list[float] = quantity(
        "force*length", "Energy stored by the tangential load"
    )
    regime: list[Literal["no_contact", "stick", "partial_slip", "full_slip"]] = Field(
        description="Whether the bodies touch, and nothing, the rim or all of the contact slips."
    )
    slip_fronts: list[float] = quantity(
        "length",
        "Radii inside the contact, ascending, between which the load of the foundation goes "
        "another way: what the contact remembers at the end",
    )
    energy_per_cycle: list[float] = quantity(
        "force*length", "Energy dissipated in each cycle, the area of its loop", default=None
    )
    secant_stiffness: list[float] = quantity(
        "force/length",
        "Of each cycle, the range of F_x over the range of u_x at its turning points",
        default=None,
    )


class TangentialAnswer(NormalAnswer):
    """One entry per pair of normal and tangential load in every list."""

    tangential_force: list[float] = quantity("force", "Tangential force F_x")
    tangential_displacement: list[float] = quantity(
        "length", "Tangential displacement u_x of the bodies"
    )
    stick_radius: list[float] = quantity("length", "Radius c of the stick zone, 0 in full slip")
    slip_width: list[float] = quantity("length", "Width a − c of the slip zone")
    tangential_stiffness: list[float] = quantity(
        "force/length", "dF_x/du_x = 2 G* c on further loading"
    )
    regime: list[Literal["stick", "partial_slip", "full_slip"]] = Field(
        description="Whether nothing, the rim or all of the contact slips."
    )
    dissipated_energy: list[float] = quantity(
        "force*length", "Energy dissipated by slip on the way to this load"
    )


_Field = list[list[float | None]]


def _field(dimension: str, meaning: str) -> Any:
    return quantity(dimension, f"{meaning}, by load and radius", default=None)


class StressAnswer(Known):
    """The fields that were asked for, by load and radius; the others are left out."""

    model_config = ConfigDict(json_schema_extra=drop_null_defaults)

    radius: list[float] = quantity("length", "The radii r, as asked for or chosen")
    pressure: _Field = _field(
        "pressure", "Pressure p(r); null where infinite, with a warning `singular`"
    )
    shear_stress: _Field = _field(
        "pressure",
        "Tangential traction τ(r), positive in the direction of a positive force; null where "
        "infinite, with a warning `singular`",
    )
    slip: _Field = _field(
        "length",
        "Tangential displacement of the surface in the slip zone relative to the stick zone, "
        "negative for a positive displacement of the bodies",
    )
    normal_displacement: _Field = _field(
        "length", "Displacement of the surface into the half-space, inside and outside the contact"
    )
    foundation_load: _Field = _field("force/length", "Load q of the equivalent foundation at x = r")
    foundation_shear: _Field = _field(
        "force/length", "Tangential load q_x of the equivalent foundation at x = r"
    )


class WearAnswer(Known):
    """One entry per pair of load and amplitude in every list; what was not asked for is left out.

    Where everything slips under a held force the wear has no end: what grows with it is null, with
    a warning `endless_wear`.
    """

    model_config = ConfigDict(json_schema_extra=drop_null_defaults)

    stick_radius: list[float] = quantity("length", "Radius c inside which nothing ever wears")
    wear_radius: list[float | None] = quantity(
        "length", "Outer radius ã of the worn rim; null where the wear has no end"
    )
    indentation_depth: list[float | None] = quantity(
        "length", "Depth d in the limit; null where the wear has no end"
    )
    normal_force: list[float] = quantity("force", "Normal force F_N in the limit")
    worn_volume: list[float | None] = quantity(
        "length^3", "Volume that has worn off; null where the wear has no end"
    )
    regime: list[Literal["stick", "partial_slip", "full_slip"]] = Field(
        description="Whether nothing, the rim or all of the contact slips, and so wears."
    )
    radius: list[float] = quantity("length", "The radii r, as asked for or chosen", default=None)
    initial_profile: list[float | None] = quantity(
        "length",
        "Profile f₀(r) before any wear, by radius: the same for all loads; null outside a flat "
        "punch, where it is infinite, with a warning `singular`",
        default=None,
    )
    limiting_profile: _Field = _field(
        "length",
        "Profile f(r) in the limit; null where the wear has no end, and outside a flat punch",
    )
    worn_depth: _Field = _field("length", "f(r) − f₀(r); null where the wear has no end")
    pressure: _Field = _field(
        "pressure",
        "Pressure p(r) in the limit; null where infinite, at c, with a warning `singular`",
    )


class EvolutionAnswer(Known):
    """One entry per number of cycles in every list; what was not asked for is left out.

    `error_estimate` is that of all but the pressure; of profile and worn depth, relative to the
    depth d.
    """

    model_config = ConfigDict(json_schema_extra=drop_null_defaults)

    cycles: list[float] = quantity("1", "The numbers of cycles, as asked for")
    worn_volume: list[float] = quantity("length^3", "Volume V that has worn off so far")
    indentation_depth: list[float] = quantity("length", "Depth d; grows where F_N is held")
    normal_force: list[float] = quantity("force", "Normal force F_N; falls where d is held")
    stick_radius: list[float] = quantity("length", "Radius c of the stick zone")
    contact_radius: list[float] = quantity("length", "Radius a of the contact")
    dissipated_energy: list[float] = quantity(
        "force*length", "Energy dissipated by slip in all cycles so far"
    )
    radius: list[float] = quantity("length", "The radii r, as asked for or chosen", default=None)
    profile: _Field = quantity(
        "length",
        "Worn profile f(r), by number of cycles and radius; null outside a flat punch, where it "
        "is infinite, with a warning `singular`",
        default=None,
    )
    worn_depth: list[list[float]] = quantity(
        "length", "f(r) − f₀(r), by number of cycles and radius", default=None
    )
    pressure: _Field = quantity(
        "pressure",
        "Pressure p(r), by number of cycles and radius; null where infinite, with a warning "
        "`singular`",
        default=None,
    )


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
    instance: str = Field(
        default="",
        description="Of a failure of the service the name of the request, a URI with its "
        "`X-Request-Id`.",
    )
    errors: list[ProblemError] = Field(
        default=[], max_length=20, description="The values at fault, the first twenty of them."
    )
