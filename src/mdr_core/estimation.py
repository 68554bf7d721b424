"""Least squares: the minimum, and the standard errors and correlation of its parameters.

Source: notes, §15.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import inf
from typing import ClassVar, Final, Self

import numpy as np
from scipy.optimize import least_squares

from mdr_core import validity
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.typing import Array

# Singular value of the slopes, of unit columns, over the largest, at which two parameters have the
# same effect, and the least part of a parameter in that effect. Rounding leaves 1e-16; fits that
# determine their parameters have 1e-6 or more.
_SAME, _PART = 1e-8, 0.1
# Relative decrease of the sum of squares at which Gauss-Newton steps take over.
_DECREASE: Final = 1e-9


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LeastSquaresFit(validity.ContactResults):
    """Parameters that are fitted to a measured curve, with their standard errors."""

    fit: tuple[str, ...]
    """Names of the fitted parameters, in the order of `standard_errors` and `correlation`."""
    standard_errors: Array
    """Standard errors of the fitted parameters, shape (n,)."""
    correlation: Array
    """Correlation of the fitted parameters, shape (n, n) [1]."""
    residual: Array
    """Measured less fitted forces [force], shape (k,)."""
    noise: float
    """Standard deviation of the forces, as given or by the residuals [force]."""
    misfit: float
    """Probability that residuals of the right model are as far from noise as these [1]."""
    error_estimate: float
    """Bound on the numerical error of the parameters, over their sizes [1]."""
    notices: tuple[Notice, ...]
    """Warnings about the residuals and the parameters."""
    method: ClassVar[str] = "least_squares"


@dataclass(frozen=True, eq=False)
class Precision:
    """Precision to which a curve determines the parameters of its fit, to first order."""

    scale: Array
    """Sizes of the slopes of the curve in the parameters, shape (n,)."""
    q: Array
    """Orthonormal slopes, shape (k, n)."""
    inverse: Array
    """Changes of the parameters, times `scale`, by those of the curve along `q`, shape (n, n)."""

    @classmethod
    def of(cls, slopes: Array, names: Sequence[str], curve: str) -> Self:
        """Return the precision, or an InputError if the curve cannot tell parameters apart.

        Parameters: the slopes, shape (k, n); the parameters; the argument at fault.
        """
        scale = np.linalg.norm(slopes, axis=0)
        lost = list(np.array(names)[~(scale > 0)])
        if not lost and np.isfinite(slopes).all():
            q, sizes, effects = np.linalg.svd(slopes / scale, full_matrices=False)
            if not sizes.size or sizes[-1] >= _SAME * sizes[0]:
                return cls(scale, q, effects.T / sizes)
            parts = zip(names, effects[-1], strict=True)
            lost = [name for name, part in parts if abs(part) > _PART]
        which = " and ".join(lost or names)
        told = "cannot be told apart: give" if len(lost) > 1 else "has no effect: leave out"
        raise InputError((curve,), f"does not determine {which}, which {told} one")

    @property
    def deviations(self) -> Array:
        """Standard deviations of the parameters, over that of the curve."""
        return np.asarray(np.linalg.norm(self.inverse, axis=1) / self.scale)

    @property
    def unit_rows(self) -> Array:
        """Rows of `inverse` over their sizes."""
        return self.inverse / np.linalg.norm(self.inverse, axis=1)[:, None]

    @property
    def correlation(self) -> Array:
        """Correlation of the parameters, shape (n, n) [1]."""
        return np.asarray(self.unit_rows @ self.unit_rows.T)

    def changes(self, curve: Array) -> Array:
        """Return the first-order changes of the parameters due to a change of the curve."""
        return np.asarray(self.inverse @ (self.q.T @ curve) / self.scale)

    def error(self, relative: float, residual: Array, curve: Array) -> float:
        """Return a bound on the numerical error of the parameters, over their sizes [1].

        Parameters: the relative error of the fitted values; the residuals, and the curve.
        """
        if not self.scale.size:
            return relative
        # The step of Gauss and Newton to the minimum; the search ends where squares no longer fall.
        step = np.abs(self.inverse @ (self.q.T @ residual)).max()
        condition = np.linalg.norm(self.inverse, 2)
        return float(condition * relative + 2 * step / np.linalg.norm(curve))


def require_fitted(
    fit: Sequence[str], parameters: Sequence[str], known: Mapping[str, float | None]
) -> None:
    """Raise InputError unless parameters are fitted, each once, and others are known.

    Parameters: names of the fitted ones, of all, and values of some of them, which are either
    fitted or known.
    """
    if not fit or len({*fit} & {*parameters}) < len(fit):
        raise InputError(("fit",), f"must hold some of {', '.join(parameters)}, each once")
    for name, value in known.items():
        if (name in fit) == (value is not None):
            detail = "is fitted: leave it out" if name in fit else "is needed unless it is fitted"
            raise InputError((name,), detail)


def minimum(model: Callable[[Array], tuple[Array, Array]], first: Array, bounds: Array) -> Array:
    """Return the parameters of the least sum of squares next to the first ones.

    Parameters: residuals and their slopes as a function of the parameters, and lower and upper
    bounds, shape (2, n).
    """

    # The solver requests residuals and slopes one after the other at the same parameters.
    @lru_cache(maxsize=1)
    def at(place: bytes) -> tuple[Array, Array]:
        return model(np.frombuffer(place))

    found = least_squares(
        *(lambda x: at(x.tobytes())[0], first, lambda x: at(x.tobytes())[1], tuple(bounds)),
        x_scale="jac",
        ftol=_DECREASE,
        xtol=EPS,
        gtol=None,
    )

    def step(x: Array) -> tuple[Array, float]:
        residual, slopes = model(x)
        # LAPACK writes to the terminal if a slope is not finite.
        if not np.isfinite(slopes).all():
            return np.zeros_like(x), inf
        change = np.asarray(np.linalg.lstsq(slopes, -residual)[0], dtype=float)
        return change, float(np.linalg.norm(slopes @ change))

    # The search stops about 1e-8 from the minimum, where rounding errors hide the decrease of the
    # sum of squares. Gauss-Newton steps refine it; each is kept if the next is less than half as
    # long.
    x, (change, length) = found.x, step(found.x)
    while ((bounds[0] <= x + change) & (x + change <= bounds[1])).all():
        following, remaining = step(x + change)
        if not remaining < length / 2:
            break
        x, change, length = x + change, following, remaining
    return np.asarray(x)
