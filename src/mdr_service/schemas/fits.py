"""Requests about measured curves: force over depth, and loops of the tangential force."""

from typing import Annotated, Literal

from pydantic import Field

from mdr_service.schemas.contacts import Axes, BodyOrRigid, Friction, Material, OnBase, Query
from mdr_service.schemas.fields import OnceEach
from mdr_service.schemas.quantities import (
    ABSENT,
    Many,
    PoissonsRatio,
    Positive,
    Signed,
    Size,
)

Fitted = Literal["e_star", "contact_point", "force_offset", "work_of_adhesion"]
LoopFitted = Literal[
    "g_star", "friction_coefficient", "force_offset", "rig_compliance", "displacement_offset"
]
_Curve = Annotated[Many[Signed], Field(min_length=3)]


class FitQuery(Query, OnBase):
    """Measured curve of a contact of known profile, and the parameters to fit."""

    axes = Axes("indentation_depth", ("normal_force", "residual"), is_measured=True)
    is_long = True

    material: Material = ABSENT
    """Elastic constants, if `e_star` is not fitted."""
    indentation_depth: _Curve
    """Measured depths, from any origin and in any order [length]"""
    normal_force: _Curve
    """Measured forces, with or without those before contact [force]"""
    fit: OnceEach[Fitted] = Field(default=["e_star", "contact_point"])
    """Parameters to fit; all but the modulus are otherwise 0. With `work_of_adhesion` the curve is
    an unloading curve."""
    noise: Positive = ABSENT
    """Standard deviation of the forces, by default from the residuals [force]"""
    segment: Literal["loading", "unloading"] = ABSENT
    """Branch to fit, by the direction of the depth in the order of the lists, without holds; by
    default all points."""
    time: _Curve = ABSENT
    """Times of the points, non-decreasing; the drift is 0 at time 0 [time]"""
    drift: Literal["hold"] = ABSENT
    """`hold` to subtract the drift of the depths in the last hold at a constant low force."""
    drift_rate: Signed = ABSENT
    """Drift rate to subtract, instead of `drift` [length/time]"""
    drift_rate_error: Size = ABSENT
    """Standard error of `drift_rate`, 0 by default [length/time]"""
    poissons_ratio: PoissonsRatio = ABSENT
    """Poisson's ratio ν of the sample, for its `youngs_modulus` [1]"""
    indenter: BodyOrRigid = "rigid"
    """The body that indents the sample, for its `youngs_modulus`."""


class LoopQuery(Query):
    """Measured loop of a contact of known profile under a constant normal load."""

    axes = Axes(
        *("tangential_displacement", ("tangential_force", "residual")),
        in_order=True,
        is_measured=True,
    )
    is_long = True

    indentation_depth: Positive = ABSENT
    """Indentation depth d [length]"""
    normal_force: Positive = ABSENT
    """Normal force F_N; exactly one of depth and force [force]"""
    tangential_displacement: _Curve
    """Measured displacements in the order of time, of a steady loop [length]"""
    tangential_force: _Curve
    """Measured tangential forces [force]"""
    fit: OnceEach[LoopFitted] = ABSENT
    """Parameters to fit; by default `force_offset` and those of `g_star` (in `material`),
    `friction_coefficient` and `rig_compliance` that are left out. Unless fitted, `force_offset` is
    0 and `displacement_offset` the middle of the displacements."""
    friction_coefficient: Friction = ABSENT
    rig_compliance: Size = ABSENT
    """Compliance C of the rig in series with the contact, 0 if the displacements were measured at
    the contact; fitting it needs a loop near or in full slip [length/force]"""
