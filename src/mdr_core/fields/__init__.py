"""Fields over the radius, of a contact or at the end of a load history."""

from mdr_core.fields.normal import foundation_load, normal_displacement, pressure
from mdr_core.fields.radii import edge_error, edges, graded, grid, own_error
from mdr_core.fields.tangential import foundation_shear, shear_stress, slip
from mdr_core.fields.torsional import torsional_stress

__all__ = [
    "edge_error",
    "edges",
    "foundation_load",
    "foundation_shear",
    "graded",
    "grid",
    "normal_displacement",
    "own_error",
    "pressure",
    "shear_stress",
    "slip",
    "torsional_stress",
]
