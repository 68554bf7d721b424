"""Requests about measured curves: force over depth, and loops of the tangential force."""

from typing import Annotated, Final, Literal

from pydantic import Field

from mdr_service.schemas.contacts import Axes, BodyOrRigid, Material, OnBase, Query, friction
from mdr_service.schemas.fields import OnceEach
from mdr_service.schemas.quantities import (
    MANY,
    Signed,
    Size,
    left_out,
    optional,
    poissons_ratio,
    positive,
    quantity,
)

Fitted = Literal["e_star", "contact_point", "force_offset", "work_of_adhesion"]
LoopFitted = Literal[
    "g_star", "friction_coefficient", "force_offset", "rig_compliance", "displacement_offset"
]
_CURVE: Final = MANY | {"min_length": 3}


class FitQuery(Query, OnBase):
    """Measured curve of a contact of known profile, and the parameters to fit."""

    axes = Axes("indentation_depth", ("normal_force", "residual"), is_measured=True)
    is_long = True

    material: Material = left_out("Elastic constants, if `e_star` is not fitted.")
    indentation_depth: list[Signed] = quantity(
        "length", "Measured depths, from any origin and in any order", **_CURVE
    )
    normal_force: list[Signed] = quantity(
        "force", "Measured forces, with or without those before contact", **_CURVE
    )
    fit: Annotated[list[Fitted], OnceEach] = Field(
        default=["e_star", "contact_point"],
        description="Parameters to fit; all but the modulus are otherwise 0. With "
        "`work_of_adhesion` the curve is an unloading curve.",
        min_length=1,
    )
    noise: float = positive(
        "force", "Standard deviation of the forces, by default from the residuals", default=None
    )
    segment: Literal["loading", "unloading"] = left_out(
        "Branch to fit, by the direction of the depth in the order of the lists, without holds; by "
        "default all points."
    )
    time: list[Signed] = optional(
        "time", "Times of the points, non-decreasing; the drift is 0 at time 0", **_CURVE
    )
    drift: Literal["hold"] = left_out(
        "`hold` to subtract the drift of the depths in the last hold at a constant low force."
    )
    drift_rate: Signed = optional("length/time", "Drift rate to subtract, instead of `drift`")
    drift_rate_error: Size = optional("length/time", "Standard error of `drift_rate`, 0 by default")
    poissons_ratio: float = poissons_ratio(
        "Poisson's ratio ν of the sample, for its `youngs_modulus`", default=None
    )
    indenter: BodyOrRigid = Field(
        default="rigid", description="The body that indents the sample, for its `youngs_modulus`."
    )


class LoopQuery(Query):
    """Measured loop of a contact of known profile under a constant normal load."""

    axes = Axes(
        *("tangential_displacement", ("tangential_force", "residual")),
        in_order=True,
        is_measured=True,
    )
    is_long = True

    indentation_depth: float = positive("length", "Indentation depth d", default=None)
    normal_force: float = positive(
        "force", "Normal force F_N; exactly one of depth and force", default=None
    )
    tangential_displacement: list[Signed] = quantity(
        "length", "Measured displacements in the order of time, of a steady loop", **_CURVE
    )
    tangential_force: list[Signed] = quantity("force", "Measured tangential forces", **_CURVE)
    fit: Annotated[list[LoopFitted], OnceEach, Field(min_length=1)] = left_out(
        "Parameters to fit; by default `force_offset` and those of `g_star` (in "
        "`material`), `friction_coefficient` and `rig_compliance` that are left out. Unless "
        "fitted, `force_offset` is 0 and `displacement_offset` the middle of the displacements."
    )
    friction_coefficient: float = friction(default=None)
    rig_compliance: Size = optional(
        "length/force",
        "Compliance C of the rig in series with the contact, 0 if the displacements were measured "
        "at the contact; fitting it needs a loop near or in full slip",
    )
