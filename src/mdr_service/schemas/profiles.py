"""The fifteen shapes, discriminated by ``kind``; field names are those of the core."""

from typing import Annotated, Literal

from pydantic import Field

from mdr_service.schemas.quantities import Signed, Size, Strict, positive, quantity
from mdr_service.settings import SETTINGS

_COEFFICIENT = "length^(1-exponent)"


class FlatPunch(Strict):
    """A flat-ended rigid cylinder: 0 for r ≤ radius, then a wall."""

    kind: Literal["flat_punch"]
    radius: float = positive("length", "Radius of the flat face")


class Cone(Strict):
    """A cone: slope·r."""

    kind: Literal["cone"]
    slope: float = positive("1", "Slope of the flank, tan θ against the plane", low=1e-15, high=1e6)


class Paraboloid(Strict):
    """A paraboloid, the shape of Hertz: r²/(2·radius)."""

    kind: Literal["paraboloid"]
    radius: float = positive("length", "Radius of curvature at the tip")


class Sphere(Strict):
    """An exact sphere: radius − √(radius² − r²); the contact radius stays below its radius."""

    kind: Literal["sphere"]
    radius: float = positive("length", "Radius of the sphere")


class Ellipsoid(Strict):
    """Half an ellipsoid of revolution: height·(1 − √(1 − r²/radius²))."""

    kind: Literal["ellipsoid"]
    radius: float = positive("length", "Semi-axis along the surface")
    height: float = positive("length", "Semi-axis along the normal")


class Power(Strict):
    """A power law with a real exponent: coefficient·r^exponent."""

    kind: Literal["power"]
    coefficient: float = positive(_COEFFICIENT, "Factor of the power", low=1e-300, high=1e300)
    exponent: float = positive("1", "Real exponent", low=0.05, high=200)


class PowerTerm(Strict):
    """One term coefficient·r^exponent of a series."""

    coefficient: float = quantity(
        _COEFFICIENT, "Factor of the power, not 0 and of either sign", ge=-1e300, le=1e300
    )
    exponent: float = positive("1", "Real exponent", low=0.05, high=200)


class Series(Strict):
    """A sum of powers: Σ coefficientᵢ·r^exponentᵢ."""

    kind: Literal["series"]
    terms: list[PowerTerm] = quantity(
        "list",
        "The terms of the sum, each a coefficient and an exponent",
        min_length=1,
        max_length=SETTINGS.max_series_terms,
    )


class RoundedPunch(Strict):
    """A flat face with a parabolically rounded rim: 0, then (r − flat_radius)²/(2·R)."""

    kind: Literal["rounded_punch"]
    flat_radius: float = positive("length", "Radius b of the flat face")
    rounding_radius: float = positive("length", "Radius R of the rounding")


class TruncatedCone(Strict):
    """A cone with a flat tip: 0, then slope·(r − flat_radius)."""

    kind: Literal["truncated_cone"]
    flat_radius: float = positive("length", "Radius b of the flat face")
    slope: float = positive("1", "Slope of the flank", low=1e-15, high=1e6)


class TruncatedParaboloid(Strict):
    """A paraboloid with a flat (worn) tip: 0, then (r² − flat_radius²)/(2·radius)."""

    kind: Literal["truncated_paraboloid"]
    flat_radius: float = positive("length", "Radius b of the flat face")
    radius: float = positive("length", "Radius of curvature of the paraboloid")


class RoundedCone(Strict):
    """A cone with a parabolic tip: r²/(2·tip_radius), then the tangent cone."""

    kind: Literal["rounded_cone"]
    slope: float = positive("1", "Slope of the flank", low=1e-15, high=1e6)
    tip_radius: float = positive("length", "Radius of curvature at the tip")


class SphericalTipCone(Strict):
    """A cone with an exact spherical tip up to the tangent point, then the cone."""

    kind: Literal["spherical_tip_cone"]
    slope: float = positive("1", "Slope of the flank", low=1e-15, high=1e6)
    tip_radius: float = positive("length", "Radius of the spherical tip")


class Hyperboloid(Strict):
    """A hyperboloid: R·t²·(√(1 + r²/(R·t)²) − 1), t the slope of its asymptote."""

    kind: Literal["hyperboloid"]
    slope: float = positive("1", "Slope t of the asymptote", low=1e-15, high=1e6)
    tip_radius: float = positive("length", "Radius of curvature R at the tip")


class CappedParaboloid(Strict):
    """A paraboloid with a flatter, worn cap: curvature 1/R₁ inside cap_radius, 1/R₂ outside."""

    kind: Literal["capped_paraboloid"]
    cap_radius: float = positive("length", "Radius b of the cap")
    tip_radius: float = positive("length", "Radius of curvature R₁ of the cap")
    radius: float = positive("length", "Radius of curvature R₂ ≤ R₁ outside the cap")


class Tabulated(Strict):
    """A measured profile through points; it is never extrapolated."""

    kind: Literal["tabulated"]
    r: list[Size] = quantity(
        "length",
        "Radii of the points, from 0, increasing",
        min_length=2,
        max_length=SETTINGS.max_table_points,
        fail_fast=True,
    )
    f: list[Signed] = quantity(
        "length",
        "Heights of the profile at the points, from 0, not falling",
        min_length=2,
        max_length=SETTINGS.max_table_points,
        fail_fast=True,
    )
    interpolation: Literal["cubic", "pchip", "linear"] = quantity(
        "text", "The curve through the points; cubic is not-a-knot", default="cubic"
    )
    breaks: list[Size] = quantity(
        "length",
        "Radii of the table where slope or curvature jumps; nothing is interpolated across them",
        default=[],
        max_length=SETTINGS.max_table_points,
        fail_fast=True,
    )


Profile = Annotated[
    FlatPunch
    | Cone
    | Paraboloid
    | Sphere
    | Ellipsoid
    | Power
    | Series
    | RoundedPunch
    | TruncatedCone
    | TruncatedParaboloid
    | RoundedCone
    | SphericalTipCone
    | Hyperboloid
    | CappedParaboloid
    | Tabulated,
    Field(discriminator="kind", description="The shape of the indenter, f(r), by its kind."),
]

MODELS: tuple[type[Strict], ...] = (
    FlatPunch,
    Cone,
    Paraboloid,
    Sphere,
    Ellipsoid,
    Power,
    Series,
    RoundedPunch,
    TruncatedCone,
    TruncatedParaboloid,
    RoundedCone,
    SphericalTipCone,
    Hyperboloid,
    CappedParaboloid,
    Tabulated,
)
