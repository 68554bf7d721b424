"""Stresses beneath the surface of a contact."""

from mdr_core.subsurface.peaks import MEASURES, Peak, largest
from mdr_core.subsurface.stress import StressTensor, error_estimate, stress
from mdr_core.subsurface.yielding import slips_from, yield_onset_force, yielding

__all__ = [
    "MEASURES",
    "Peak",
    "StressTensor",
    "error_estimate",
    "largest",
    "slips_from",
    "stress",
    "yield_onset_force",
    "yielding",
]
