"""Plain data of a picture."""

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from mdr_core.typing import Array

# Points of a curve: its chords are then shorter than a millimetre on paper.
POINTS: Final = 300
# Accuracy that paper does not exceed.
VISIBLE: Final = 1e-4
# Curves of a panel: their colours remain distinct.
MAX_CURVES: Final = 6

LABELS: Final = {
    "indentation_depth": "indentation depth d",
    "normal_force": "normal force F_N",
    "contact_radius": "contact radius a",
    "tangential_displacement": "tangential displacement u_x",
    "tangential_force": "tangential force F_x",
    "stick_radius": "stick radius c",
    "radius": "radius r",
    "pressure": "pressure p",
    "shear_stress": "shear stress τ",
    "slip": "slip s",
    "normal_displacement": "normal displacement u_z",
    "foundation_load": "foundation load q",
    "foundation_shear": "foundation shear q_x",
    "profile": "profile f",
    "limiting_profile": "profile f",
    "worn_depth": "worn depth f − f₀",
}
NOTHING: Final = np.zeros(0)


class Curve(NamedTuple):
    """Line through (x, y), with gaps where y is infinite, and points of the response."""

    x: Array
    y: Array
    label: str = ""
    point_x: Array = NOTHING
    point_y: Array = NOTHING
    style: str = "-"


class Mark(NamedTuple):
    """Dotted line across a panel at a coordinate, in the colour of a curve if it has one."""

    place: float
    symbol: str
    curve: int | None = None


class Panel(NamedTuple):
    """Axes with curves, y limits where they cut a peak, and horizontal marks."""

    y_label: str
    curves: list[Curve]
    y_limits: tuple[float, float] | None = None
    marks: Sequence[Mark] = ()


class Plot(NamedTuple):
    """Panels above each other, which share the x axis, its limits and its marks."""

    x_label: str
    panels: Sequence[Panel]
    marks: Sequence[Mark] = ()
    x_limits: tuple[float, float] | None = None
    points_label: str = ""
    note: str = ""
    """Title of the legend."""


class Map(NamedTuple):
    """Filled contours over x and z, with marks on the surface and a point, and z on the axis.

    The axis lies in the middle of x.
    """

    x: Array
    z: Array
    values: Array
    """[z][x]"""
    label: str
    contact: float
    """Contact radius."""
    stick: float | None
    peak: tuple[float, float] | None
    note: str = ""


def symbol(name: str) -> str:
    """Return the symbol of a quantity, the last word of its label."""
    return LABELS[name].rpartition(" ")[2]


def subset_note(shown: int, total: int, what: str) -> str:
    """Return the note that not all of something is drawn."""
    return f"{shown} of {total} {what}" if shown < total else ""
