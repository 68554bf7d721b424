"""Stress panels of a slope that is a function: resolved once, for all stresses."""

import numpy as np

from mdr_core.abel.panels import Jumps
from mdr_core.abel.pieces import Pieces, Slope, pieces_behind, whole_pieces
from mdr_core.abel.stress import StressPanels
from mdr_core.typing import Array


def stress_panels(
    slope: Slope,
    edges: Array,
    jumps: Jumps,
    accuracy: float = 1e-13,
    kinks: Array | None = None,
) -> StressPanels:
    """Resolve G = g' between the given edges, each panel in s about its own left edge.

    `slope(base, offset)` is G(base + offset) without the pole of the jump at `base`.

    Source: notes, §5.

    Parameters
    ----------
    edges : the ends of the smooth pieces, ascending [length], shape (k + 1,).
    jumps : of f', at some of the edges.
    accuracy : of a panel's part of the kernel next to the panel; the dearer rule is more accurate.
    kinks : parts of G that begin at each edge, relative to G, from which follows how many nodes a
        panel needs; without them each takes 24.

    Raises
    ------
    AccuracyError : G is not piecewise smooth.

    Examples
    --------
    Eq. (5.38): the integral is (2/R) sqrt(a^2 - r^2) for the paraboloid, g' = 2 x/R, here R = 1.

    >>> none = Jumps(np.empty(0), np.empty(0))
    >>> panels = stress_panels(lambda base, offset: 2 * (base + offset), np.array([0, 2.0]), none)
    >>> value = panels.kernel(np.array([1.0]), np.array([0.0, 0.6]), 1e-12)
    >>> [float(f"{each:.6g}") for each in value]
    [2.0, 1.6]
    """
    return _panels(pieces_behind(slope, edges, kinks, accuracy / 5), edges, jumps, accuracy)


def smooth_panels(
    slope: Slope, edges: Array, accuracy: float, kink: float = 0.0
) -> StressPanels | None:
    """Resolve G where each panel is one polynomial to this accuracy; None where some is not.

    The weak kinks that G may have inside of the panels, each at most the part `kink` of G, are
    below the accuracy. Parameters as of `stress_panels`.
    """
    pieces = whole_pieces(slope, edges, accuracy, kink)
    none = Jumps(np.empty(0), np.empty(0))
    # A dozen of the last coefficients are left out.
    return None if pieces is None else _panels(pieces, edges, none, 12 * accuracy)


def _panels(pieces: Pieces, edges: Array, jumps: Jumps, accuracy: float) -> StressPanels:
    pole = np.zeros(edges.size - 1)
    pole[np.searchsorted(edges[:-1], jumps.at)] = jumps.at * jumps.size
    return StressPanels(
        edges,
        edges[pieces.panel],
        pieces.start,
        pieces.stop,
        pole[pieces.panel],
        pieces.coefficients,
        pieces.error,
        accuracy,
    )
