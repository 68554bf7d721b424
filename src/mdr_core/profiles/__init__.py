"""The fifteen kinds of profile, each with what it knows in closed form."""

from typing import Final

from mdr_core.profiles.blunt import RoundedPunch, TruncatedCone, TruncatedParaboloid
from mdr_core.profiles.capped_paraboloid import CappedParaboloid
from mdr_core.profiles.flat_punch import FlatPunch
from mdr_core.profiles.power import Power
from mdr_core.profiles.power_law import Cone, Paraboloid
from mdr_core.profiles.profile import Profile
from mdr_core.profiles.rounded import Ellipsoid, Hyperboloid, Sphere
from mdr_core.profiles.rounded_cone import RoundedCone
from mdr_core.profiles.series import PowerTerm, Series
from mdr_core.profiles.spherical_tip_cone import SphericalTipCone
from mdr_core.profiles.tabulated import Tabulated

_CLASSES: Final[tuple[type[Profile], ...]] = (
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
]
