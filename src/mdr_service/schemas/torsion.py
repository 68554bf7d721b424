"""Requests about a twist of the contact about its axis."""

from typing import Literal

from pydantic import Field

from mdr_core.torsion.contact import NEEDED
from mdr_service.schemas.contacts import Axes, Friction, Load, Torsion
from mdr_service.schemas.fields import FieldQuery, OnceEach

TorsionField = Literal["pressure", "shear_stress"]


class TorsionQuery(FieldQuery):
    """Contact with friction, loaded normally first and then twisted about its axis."""

    axes = Axes("rotation", ("torque",), curves="normal_force")
    refused = dict.fromkeys(
        ("tangential", "history", "cycles", "oscillation"), f"a twist needs {NEEDED}"
    )
    by_parameters = "Twist about the axis"
    is_long = True

    load: Load
    friction_coefficient: Friction
    torsion: Torsion
    quantities: OnceEach[TorsionField] = Field(default=["shear_stress"])
    """Fields to compute, each once; with `radius` or `points`"""
