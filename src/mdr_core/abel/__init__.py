"""Singular integrals: the two-root rule, the transforms of tables and the displacements."""

from mdr_core.abel.annulus import Annulus, InnerEnd
from mdr_core.abel.stress import StressPanels
from mdr_core.abel.two_root import two_root_integral

__all__ = [
    "Annulus",
    "InnerEnd",
    "StressPanels",
    "two_root_integral",
]
