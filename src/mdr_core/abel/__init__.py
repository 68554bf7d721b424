"""The singular integrals: Abel transforms forward and back, and the two-limit stress kernel."""

from mdr_core.abel.back import back
from mdr_core.abel.panels import (
    Jumps,
    Panels,
    find_breaks,
    forward,
    forward_moment,
    forward_slope,
    jumps_at,
    resolve,
    slope_source,
)
from mdr_core.abel.resolved import smooth_panels, stress_panels
from mdr_core.abel.roots import arc, between, one_sided
from mdr_core.abel.stress import StressPanels

__all__ = [
    "Jumps",
    "Panels",
    "StressPanels",
    "arc",
    "back",
    "between",
    "find_breaks",
    "forward",
    "forward_moment",
    "forward_slope",
    "jumps_at",
    "one_sided",
    "resolve",
    "slope_source",
    "smooth_panels",
    "stress_panels",
]
