"""Requests about stresses beneath the surface."""

from typing import Annotated, Any, Final, Literal

from pydantic import Field

from mdr_service.schemas.fields import NEEDED, LoadedQuery, OnceEach, quantities
from mdr_service.schemas.quantities import Signed, Size, one_of, places, quantity

SubsurfaceName = Literal[
    "stress_xx",
    "stress_yy",
    "stress_zz",
    "stress_xy",
    "stress_xz",
    "stress_yz",
    "von_mises",
    "maximum_shear",
    "principal_1",
    "principal_2",
    "principal_3",
    "mean_stress",
]
_SCHEMA: Final[dict[str, Any]] = {
    "allOf": [
        one_of("load", "history"),
        {"oneOf": [{"required": ["x", "z"]}, {"required": ["points"]}]},
    ],
    "dependentRequired": {"x": ["z"], "z": ["x"], **NEEDED},
}


class SubsurfaceQuery(LoadedQuery, json_schema_extra=_SCHEMA):
    """Stresses in one of the bodies, with or without friction."""

    is_long = True

    body: Literal[1, 2] = Field(
        default=1,
        description="Body 1, which has the profile and takes the tangential force, or body 2.",
    )
    x: list[Signed] = places("Coordinates from the axis along a positive tangential force")
    y: Signed = quantity("length", "Transverse coordinate, of all points", default=0.0)
    z: list[Size] = places("Depths in the body, 0 on its surface")
    points: int = quantity(
        "1",
        "Number of x values and of z values that the service chooses in place of lists, up to 1.5 "
        "times the largest contact radius",
        default=None,
        ge=2,
        le=1000,
    )
    quantities: Annotated[list[SubsurfaceName], OnceEach] = quantities(
        "tension is positive, and principal_1 ≥ principal_2 ≥ principal_3", default=["von_mises"]
    )
    largest: bool = Field(
        default=False,
        description="Return the largest von Mises and maximum shear stress of the body, and where.",
    )

    @property
    def positions(self) -> int:
        """Number of points, also for a request that contradicts itself."""
        return len(self.x or ()) * len(self.z or ()) + (self.points or 0) ** 2

    @property
    def numbers(self) -> int:
        return self.loads * self.positions * len(self.quantities)
