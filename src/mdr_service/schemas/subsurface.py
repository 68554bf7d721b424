"""Requests about stresses beneath the surface."""

from typing import Annotated, Any, Final, Literal

from pydantic import Field

from mdr_service.schemas.fields import NEEDED, LoadedQuery, OnceEach
from mdr_service.schemas.quantities import ABSENT, Many, Signed, Size, one_of

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

    body: Literal[1, 2] = 1
    """Body 1, which has the profile and takes the tangential force, or body 2."""
    x: Many[Signed] = ABSENT
    """Coordinates from the axis along a positive tangential force [length]"""
    y: Signed = 0.0
    """Transverse coordinate, of all points [length]"""
    z: Many[Size] = ABSENT
    """Depths in the body, 0 on its surface [length]"""
    points: Annotated[int, Field(ge=2, le=1000)] = ABSENT
    """Number of x values and of z values that the service chooses in place of lists, up to 1.5
    times the largest contact radius [1]"""
    quantities: OnceEach[SubsurfaceName] = Field(default=["von_mises"])
    """Fields to compute, each once; tension is positive, and principal_1 ≥ principal_2 ≥
    principal_3"""
    largest: bool = False
    """Return the largest von Mises and maximum shear stress of the body, and where."""

    @property
    def positions(self) -> int:
        """Number of points, also for a request that contradicts itself."""
        return len(self.x or ()) * len(self.z or ()) + (self.points or 0) ** 2

    @property
    def numbers(self) -> int:
        return self.loads * self.positions * len(self.quantities)
