"""Stresses beneath the surface of a contact."""

from mdr_core.subsurface.stress import StressTensor, error_estimate, stress
from mdr_core.subsurface.yielding import MEASURES, Peak, largest, yield_finding, yield_onset_force

__all__ = [
    "MEASURES",
    "Peak",
    "StressTensor",
    "error_estimate",
    "largest",
    "stress",
    "yield_finding",
    "yield_onset_force",
]
