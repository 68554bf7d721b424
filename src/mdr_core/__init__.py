"""Contact mechanics of axisymmetric bodies by the method of dimensionality reduction.

Pass a profile and a material to `normal.solve`, and the contact that it returns to
`tangential.solve`, `torsion.solve`, `fields`, `subsurface` or `wear`. `history` follows load paths
and steps through time, `impact` returns the rebound. Use one consistent system of units.

>>> import mdr_core as mdr
>>> steel = mdr.Body(youngs_modulus=210e9, poissons_ratio=0.3)
>>> pair = mdr.from_bodies([steel, steel])
>>> contact = mdr.normal.solve(mdr.Paraboloid(radius=0.01), pair, normal_force=10.0)
>>> round(float(contact.contact_radius) * 1e6, 3)
86.624
"""

from typing import Final

from mdr_core import (
    adhesion,
    fields,
    fit,
    history,
    hysteresis,
    impact,
    layer,
    normal,
    profiles,
    subsurface,
    tangential,
    thresholds,
    torsion,
    validity,
    wear,
)
from mdr_core.errors import AccuracyError, DefectError, InputError, MDRError, Notice
from mdr_core.history.slip_kernel import __file__ as _kernel
from mdr_core.materials import RIGID, Body, Layer, Material, from_bodies
from mdr_core.profiles import *  # noqa: F403, the kinds are listed in `profiles.__all__` alone
from mdr_core.table_reader import read_curve, read_table

__version__: Final = "0.1.0"
COMPILED: Final = not _kernel.endswith(".py")
"""True if the module for load histories is compiled; if not, they take about 100 times longer."""

__all__ = [
    "COMPILED",
    "RIGID",
    "AccuracyError",
    "Body",
    "DefectError",
    "InputError",
    "Layer",
    "MDRError",
    "Material",
    "Notice",
    "__version__",
    "adhesion",
    "fields",
    "fit",
    "from_bodies",
    "history",
    "hysteresis",
    "impact",
    "layer",
    "normal",
    "read_curve",
    "read_table",
    "subsurface",
    "tangential",
    "thresholds",
    "torsion",
    "validity",
    "wear",
]
__all__ += profiles.__all__
