"""Stresses beneath the surface of a contact."""

from mdr_core.subsurface.largest import MEASURES, Peak, largest, yield_onset_force
from mdr_core.subsurface.stress import error_estimate, stress
from mdr_core.subsurface.tensor import StressTensor

__all__ = [
    "MEASURES",
    "Peak",
    "StressTensor",
    "error_estimate",
    "largest",
    "stress",
    "yield_onset_force",
]
