"""Stress integral of a slope g' that is smooth on intervals. Source: notes, §5."""

from collections.abc import Sequence

import numpy as np

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.abel.displacement import Branch, smooth_parts
from mdr_core.abel.two_root import two_root_integral
from mdr_core.doubles import TINY
from mdr_core.typing import Array


def stress_integral(branches: Sequence[Branch], annulus: Annulus, r: Array) -> Array:
    """Return int_max(r,c)^a g'(x)/sqrt(x^2 - r^2) dx.

    Source: mdr-5, Eqs. (5.68), (5.70); notes, §5.

    Parameters
    ----------
    branches : intervals of g'.
    annulus : a and c as radii.
    r : radii 0 <= r < a [length], shape (m,); on the axis of a sharp tip, a radius next to it.
    """
    a, width, c = (np.broadcast_to(part, r.shape) for part in annulus[:3])
    narrow, total = width < a / 2, np.zeros(r.shape)
    for branch in smooth_parts(branches, a.max()):
        low = np.maximum(c, max(branch.base, branch.start))
        high = np.minimum(a, branch.stop)
        # The width of a narrow annulus has more digits than its radii.
        gap = np.where(narrow, width - (a - high) - (low - c), high - low)
        seen = np.flatnonzero((gap > 0) & (r < high))
        if seen.size:
            ends = low[seen], high[seen], gap[seen]
            total[seen] += _on_part(branch, *ends, r[seen])
    return total


def _on_part(branch: Branch, low: Array, high: Array, gap: Array, r: Array) -> Array:
    """Stress integral over low < x < high, gap = high - low, at radii below high."""
    base = branch.base
    if base == 0:
        # Nearer to the axis the stress equals its value there to rounding error: its relative
        # deviation is of the order (r/c)^2. Without an inner edge only r = 0 must be avoided.
        r = np.maximum(r, np.where(low > 0, 1e-8 * low, 1e-120 * high))
    top = inverse_hypot(high, base)
    roots = np.maximum(top + inverse_hypot(low, base), TINY)
    ends = Annulus(top, gap * (low + high) / roots, low, high)
    return two_root_integral(branch.weight, base, r, ends, growth=branch.steepness)
