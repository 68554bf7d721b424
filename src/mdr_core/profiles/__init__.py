"""Sixteen kinds of profile, each with its closed forms."""

from typing import Final

from mdr_core.profiles.base import Profile
from mdr_core.profiles.capped_paraboloid import CappedParaboloid
from mdr_core.profiles.flanked import slope_of_half_angle
from mdr_core.profiles.flat_punch import FlatPunch
from mdr_core.profiles.hyperboloid import Hyperboloid
from mdr_core.profiles.powers import Cone, Paraboloid, Power
from mdr_core.profiles.series import PowerTerm, Series
from mdr_core.profiles.spherical_tip_cone import SphericalTipCone
from mdr_core.profiles.spheroids import Ellipsoid, Sphere
from mdr_core.profiles.tabulated import Tabulated
from mdr_core.profiles.tipped import RoundedCone
from mdr_core.profiles.truncated import RoundedPunch, TruncatedCone, TruncatedParaboloid
from mdr_core.profiles.two_spheres import TwoSpheres

_CLASSES: Final[tuple[type[Profile], ...]] = (
    FlatPunch,
    Cone,
    Paraboloid,
    Sphere,
    TwoSpheres,
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
KINDS: Final[dict[str, type[Profile]]] = {cls.kind: cls for cls in _CLASSES}

__all__ = [
    "KINDS",
    "CappedParaboloid",
    "Cone",
    "Ellipsoid",
    "FlatPunch",
    "Hyperboloid",
    "Paraboloid",
    "Power",
    "PowerTerm",
    "Profile",
    "RoundedCone",
    "RoundedPunch",
    "Series",
    "Sphere",
    "SphericalTipCone",
    "Tabulated",
    "TruncatedCone",
    "TruncatedParaboloid",
    "TwoSpheres",
    "slope_of_half_angle",
]
