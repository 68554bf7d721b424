"""Profiles by ``kind``; fields have the names of the parameters of the core."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, Self, get_args

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from mdr_service.schemas.quantities import ABSENT, Positive, Signed, Size, Strict
from mdr_service.settings import SETTINGS

# Maximum number of powers: shapes of bodies need fewer, and each power costs a sum.
_MAX_TERMS = 100
_MAX_POINTS: Final = SETTINGS.max_table_points
_Points = Annotated[list[Signed], Field(min_length=3, max_length=_MAX_POINTS, fail_fast=True)]
_Exponent = Annotated[float, Field(ge=0.05, le=100)]


class FlatPunchProfile(Strict):
    """A flat-ended cylindrical punch: 0 for r ≤ radius, then ∞."""

    kind: Literal["flat_punch"]
    radius: Positive
    """Radius of the flat face [length]"""


class _Flanked(Strict):
    """Profile with a flank, given by its slope or its angle."""

    slope: Annotated[float, Field(ge=1e-15, le=1e6)] = ABSENT
    """Slope t of the flank, tan θ against the plane [1]"""
    half_angle: Annotated[float, Field(ge=1e-4, le=89.9999)] = ABSENT
    """Angle between the axis and the flank, in place of the slope tan(90° − half_angle) [degree]"""

    @model_validator(mode="after")
    def _slope_or_angle(self) -> Self:
        if self.has("slope") == self.has("half_angle"):
            raise PydanticCustomError("one_slope", "exactly one of slope, half_angle is needed")
        return self


class ConeProfile(_Flanked):
    """A cone: slope·r."""

    kind: Literal["cone"]


class ParaboloidProfile(Strict):
    """A paraboloid, the shape of Hertz: r²/(2·radius)."""

    kind: Literal["paraboloid"]
    radius: Positive
    """Radius of curvature at the tip [length]"""


class SphereProfile(Strict):
    """An exact sphere: radius − √(radius² − r²); the contact radius stays below its radius."""

    kind: Literal["sphere"]
    radius: Positive
    """Radius of the sphere [length]"""


class TwoSpheresProfile(Strict):
    """The exact gap of two spheres, or of a ball in a socket, whose radius is negative."""

    kind: Literal["two_spheres"]
    radii: Annotated[list[Signed], Field(min_length=2, max_length=2)]
    """Radius R₁ of the first body and R₂ of the second, negative for a socket; 1/R₁ + 1/R₂ > 0
    [length]"""


class EllipsoidProfile(Strict):
    """Half an ellipsoid of revolution: height·(1 − √(1 − r²/radius²))."""

    kind: Literal["ellipsoid"]
    radius: Positive
    """Semi-axis along the surface [length]"""
    height: Positive
    """Semi-axis along the normal [length]"""


class PowerProfile(Strict):
    """A power law with a real exponent: coefficient·r^exponent."""

    kind: Literal["power"]
    coefficient: Positive
    """Factor of the power [length^(1-exponent)]"""
    exponent: _Exponent
    """Real exponent [1]"""


class SeriesTerm(Strict):
    """One term coefficient·r^exponent of a series."""

    coefficient: Signed
    """Factor of the power, not 0 and of either sign [length^(1-exponent)]"""
    exponent: _Exponent
    """Real exponent [1]"""


class SeriesProfile(Strict):
    """A sum of powers: Σ coefficientᵢ·r^exponentᵢ."""

    kind: Literal["series"]
    terms: Annotated[list[SeriesTerm], Field(min_length=1, max_length=_MAX_TERMS)]
    """The terms of the sum, each a coefficient and an exponent [list]"""


class RoundedPunchProfile(Strict):
    """A flat face with a parabolically rounded rim: 0, then (r − flat_radius)²/(2·R)."""

    kind: Literal["rounded_punch"]
    flat_radius: Positive
    """Radius b of the flat face [length]"""
    rounding_radius: Positive
    """Radius R of the rounding [length]"""


class TruncatedConeProfile(_Flanked):
    """A cone with a flat tip: 0, then slope·(r − flat_radius)."""

    kind: Literal["truncated_cone"]
    flat_radius: Positive
    """Radius b of the flat face [length]"""


class TruncatedParaboloidProfile(Strict):
    """A paraboloid with a flat (worn) tip: 0, then (r² − flat_radius²)/(2·radius)."""

    kind: Literal["truncated_paraboloid"]
    flat_radius: Positive
    """Radius b of the flat face [length]"""
    radius: Positive
    """Radius of curvature of the paraboloid [length]"""


class RoundedConeProfile(_Flanked):
    """A cone with a parabolic tip: r²/(2·tip_radius), then the tangent cone."""

    kind: Literal["rounded_cone"]
    tip_radius: Positive
    """Radius of curvature at the tip [length]"""


class SphericalTipConeProfile(_Flanked):
    """A cone with an exact spherical tip up to the tangent point, then the cone."""

    kind: Literal["spherical_tip_cone"]
    tip_radius: Positive
    """Radius of the spherical tip [length]"""


class HyperboloidProfile(_Flanked):
    """A hyperboloid: R·t²·(√(1 + r²/(R·t)²) − 1), t the slope of its asymptote."""

    kind: Literal["hyperboloid"]
    tip_radius: Positive
    """Radius of curvature R at the tip [length]"""


class CappedParaboloidProfile(Strict):
    """A paraboloid with a flatter, worn cap: curvature 1/R₁ inside cap_radius, 1/R₂ outside."""

    kind: Literal["capped_paraboloid"]
    cap_radius: Positive
    """Radius b of the cap [length]"""
    tip_radius: Positive
    """Radius of curvature R₁ ≥ R₂ of the cap [length]"""
    radius: Positive
    """Radius of curvature R₂ outside the cap [length]"""


class TabulatedProfile(Strict):
    """A measured profile: the smoothest one through or near its points; never extrapolated."""

    kind: Literal["tabulated"]
    r: _Points
    """Radii of the points, at least three different ones, in any order, on one or both sides of the
    axis; radii may be repeated [length]"""
    f: _Points
    """Heights of the profile at the points, rising away from the axis, with any offset [length]"""
    breaks: Annotated[list[Size], Field(max_length=_MAX_POINTS, fail_fast=True)] = Field(default=[])
    """Radii where slope or curvature jumps [length]"""
    uncertainty: Size | None = ABSENT
    """Standard uncertainty of the heights, by default estimated from the scatter of the points;
    with 0 the profile meets the points [length]"""


Profile = Annotated[
    FlatPunchProfile
    | ConeProfile
    | ParaboloidProfile
    | SphereProfile
    | TwoSpheresProfile
    | EllipsoidProfile
    | PowerProfile
    | SeriesProfile
    | RoundedPunchProfile
    | TruncatedConeProfile
    | TruncatedParaboloidProfile
    | RoundedConeProfile
    | SphericalTipConeProfile
    | HyperboloidProfile
    | CappedParaboloidProfile
    | TabulatedProfile,
    Field(discriminator="kind", description="The shape of the indenter, f(r), by its kind."),
]

MODELS: Final[Mapping[str, type[Strict]]] = {
    get_args(model.model_fields["kind"].annotation)[0]: model
    for model in get_args(get_args(Profile)[0])
}
"""Models by kind."""
OF_NUMBERS: Final = tuple(kind for kind in MODELS if kind not in {"series", "tabulated"})
"""Kinds of profile whose fields are all numbers."""
