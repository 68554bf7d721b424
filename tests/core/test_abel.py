"""The two-root rule against integrals in closed form."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from hypothesis import settings

from mdr_core.abel import two_root
from mdr_core.abel.annulus import Annulus, whole

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.float64]

RTOL = 1e-13
END = 1.5
B = 0.7
repeatable = settings(derandomize=True, deadline=None, max_examples=60)


def two_root_integral(weight: Callable[[Array, Array], Array], r: Array, a: float) -> Array:
    upper = np.full(r.shape, np.sqrt((a - B) * (a + B)))
    annulus = whole(upper, np.full(r.shape, a))
    return two_root.two_root_integral(weight, B, r, annulus, rtol=RTOL)


# At r = B a different rule applies; both must agree around it.
AROUND = np.array([0.0, 1e-9, 0.3, B * (1 - 1e-9), B, B * (1 + 1e-9), 0.9, END * (1 - 1e-9)])


def test_one_sided_even_weight() -> None:
    """F = x: sqrt(a^2 - r^2) - sqrt(b^2 - r^2)."""
    kept = AROUND.copy()
    result = two_root_integral(lambda _, s: s, AROUND, END)
    low = np.sqrt(np.maximum(B - AROUND, 0) * (B + AROUND))
    exact = np.sqrt((END - AROUND) * (END + AROUND)) - low
    assert result.shape == AROUND.shape
    assert np.allclose(result, exact, rtol=1e-13, atol=0)
    assert np.array_equal(AROUND, kept)


def test_one_sided_pole() -> None:
    """F = x/s: arcsinh(s_a/k) below the break, arccosh(s_a/k) above, k^2 = |r^2 - b^2|."""
    result = two_root_integral(lambda x, _: np.ones_like(x), AROUND, END)
    k = np.sqrt(np.abs(AROUND - B) * (AROUND + B))
    top = np.sqrt((END - B) * (END + B))
    root = np.sqrt((END - AROUND) * (END + AROUND))
    with np.errstate(divide="ignore"):
        below, above = np.arcsinh(top / k), np.arcsinh(root / k)
    exact = np.where(AROUND < B, below, above)
    assert np.isinf(result[AROUND == B]).all()
    assert np.allclose(result, exact, rtol=1e-13, atol=0)


def test_one_sided_annulus_equals_difference() -> None:
    """Ciavarella-Jaeger superposition, where the difference is well-conditioned."""
    c, r = 1.0, AROUND[AROUND < 1.0]
    upper, lower = (np.full(r.shape, np.sqrt(e * e - B * B)) for e in (END, c))

    def weight(x: Array, s: Array) -> Array:
        return (2 * s - B * np.arctan(s / B)) * s / x

    ends = Annulus(upper, upper - lower, np.full(r.shape, c)), whole(upper), whole(lower)
    annulus, outer, inner = (
        two_root.two_root_integral(weight, B, r, each, rtol=RTOL) for each in ends
    )
    assert np.allclose(annulus, outer - inner, rtol=1e-12, atol=0)
