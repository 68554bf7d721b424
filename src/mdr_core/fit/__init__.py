"""Modulus, contact point, offset and adhesion from a measured curve of force over depth."""

from mdr_core.fit.model import PARAMETERS
from mdr_core.fit.result import Fit
from mdr_core.fit.solver import solve

__all__ = ["PARAMETERS", "Fit", "solve"]
