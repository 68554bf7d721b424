"""Shear modulus and friction coefficient from a hysteresis loop under a constant normal load."""

from mdr_core.hysteresis.loop import solve
from mdr_core.hysteresis.result import PARAMETERS, LoopFit

__all__ = ["PARAMETERS", "LoopFit", "solve"]
