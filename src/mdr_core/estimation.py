"""Least squares: the minimum, and the standard errors and correlation of its parameters.

Source: notes, §15.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import inf, sqrt
from typing import ClassVar, Final, Self

import numpy as np
from scipy.optimize import least_squares

from mdr_core import validity
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.typing import Array

# Singular value of the normalised slopes, over the largest, below which parameters have the same
# effect, and the smallest component of a parameter in it. Rounding leaves 1e-16; fits that
# determine their parameters have 1e-6 or more.
_SAME, _PART = 1e-8, 0.1
# Relative decrease of the sum of squares at which Gauss-Newton steps take over.
_DECREASE: Final = 1e-9

Parameters = dict[str, float]
"""Values of the parameters of a model by name."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LeastSquaresFit(validity.ContactResults):
    """Parameters that are fitted to a measured curve, with their standard errors."""

    fit: tuple[str, ...]
    """Names of the fitted parameters, in the order of `standard_errors` and `correlation`."""
    effects: Array
    """Changes of the fitted parameters by independent errors of one standard deviation each, in
    columns, shape (n, m)."""
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

    @property
    def standard_errors(self) -> Array:
        """Standard errors of the fitted parameters, shape (n,)."""
        return np.asarray(np.linalg.norm(self.effects, axis=1))

    @property
    def correlation(self) -> Array:
        """Correlation of the fitted parameters, shape (n, n) [1]."""
        parts = self.effects / self.standard_errors[:, None]
        return np.asarray(parts @ parts.T)


@dataclass(frozen=True, eq=False)
class Precision:
    """Precision to which a curve determines the parameters of its fit, to first order."""

    scale: Array
    """Sizes of the slopes of the curve in the parameters, shape (n,)."""
    q: Array
    """Orthonormal slopes, shape (k, n)."""
    inverse: Array
    """Derivatives of the parameters, times `scale`, in the curve along `q`, shape (n, n)."""

    @property
    def effects(self) -> Array:
        """Derivatives of the parameters in the curve along `q`, shape (n, n)."""
        return self.inverse / self.scale[:, None]

    @property
    def deviations(self) -> Array:
        """Standard deviations of the parameters per standard deviation of the curve, (n,)."""
        return np.asarray(np.linalg.norm(self.effects, axis=1))

    @classmethod
    def of(cls, slopes: Array, names: Sequence[str], curve: str) -> Self:
        """Return the precision, or an InputError if the curve cannot distinguish parameters.

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

    def changes(self, curve: Array) -> Array:
        """Return the first-order changes of the parameters due to a change of the curve."""
        return np.asarray(self.effects @ (self.q.T @ curve))

    def error(self, relative: float, residual: Array, curve: Array) -> float:
        """Return a bound on the numerical error of the parameters, over their sizes [1].

        Parameters: the relative error of the curve, the residuals, and the curve itself.
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


def linear(
    shapes: Array, measured: Array, factor: float | None = None, *, with_offset: bool = True
) -> tuple[Array, Array, Array]:
    """Return the least sums of squares of `measured` less factor * shape + offset.

    Parameters: shapes, shape (..., k), and measured values, shape (k,); the factor if it is known;
    False for an offset of 0. Also return the factors and offsets, each of shape (...).
    """
    mean, middle = shapes.mean(axis=-1) * with_offset, float(measured.mean()) * with_offset
    x, y = shapes - mean[..., None], measured - middle
    size = np.sum(x * x, axis=-1)
    factors = np.where(size > 0, x @ y / np.where(size > 0, size, 1.0), 0.0)
    if factor is not None:
        factors = np.full(size.shape, factor)
    squares = np.sum(np.square(y - factors[..., None] * x), axis=-1)
    return squares, factors, middle - factors * mean


class CurveModel(ABC):
    """Model of the forces of a measured curve, and its least squares."""

    force: Array
    """Measured forces [force], shape (k,)."""
    fit: tuple[str, ...]
    """Parameters that are fitted."""
    argument: ClassVar[str]
    """Argument at fault where the curve leaves parameters open."""

    @abstractmethod
    def at(self, parameters: Parameters) -> tuple[Array, Array]:
        """Return the forces, and their slopes in the fitted parameters, shape (k, n)."""

    @property
    @abstractmethod
    def best(self) -> Parameters:
        """Parameters of the least sum of squares."""

    @cached_property
    def fitted(self) -> tuple[Array, Array]:
        """Forces and slopes at the best parameters."""
        return self.at(self.best)

    @property
    def residual(self) -> Array:
        """Measured less fitted forces [force], shape (k,)."""
        return self.force - self.fitted[0]

    @property
    def free(self) -> int:
        """Degrees of freedom of the residuals."""
        return self.force.size - len(self.fit)

    @property
    def squares(self) -> float:
        """Least sum of squares [force^2]."""
        return float(np.sum(np.square(self.residual)))

    @property
    def scatter(self) -> float:
        """Standard deviation of the residuals, at least the rounding error [force]."""
        return max(sqrt(self.squares / self.free), EPS * float(np.abs(self.force).max()))

    @cached_property
    def precision(self) -> Precision:
        """Precision of the best parameters, or an InputError."""
        return Precision.of(self.fitted[1], self.fit, self.argument)

    @np.errstate(all="ignore")
    def minimum(
        self, start: Parameters, bounds: Mapping[str, tuple[float, float, float]]
    ) -> Parameters:
        """Return the parameters of the least sum of squares next to the first ones.

        Raises InputError if the model leaves the range of numbers.

        Parameters
        ----------
        start : parameters from which the search starts.
        bounds : lower bound, upper bound and unit of each parameter.
        """
        low, high, unit = np.transpose([bounds[name] for name in self.fit])
        ends, size = np.array([low, high]) / unit, float(np.abs(self.force).max()) or 1.0

        def values(x: Iterable[float]) -> Parameters:
            return start | dict(zip(self.fit, (unit * x).tolist(), strict=True))

        # The solver requests residuals and slopes one after the other at the same parameters.
        @lru_cache(maxsize=1)
        def at(*x: float) -> tuple[Array, Array]:
            forces, slopes = self.at(values(x))
            return (forces - self.force) / size, slopes * unit / size

        def step(x: Array) -> tuple[Array, float]:
            residual, slopes = at(*x)
            # LAPACK writes to the terminal if a slope is not finite.
            if not np.isfinite(slopes).all():
                return np.zeros_like(x), inf
            change = np.asarray(np.linalg.lstsq(slopes, -residual)[0], dtype=float)
            return change, float(np.linalg.norm(slopes @ change))

        first = np.array([start[name] for name in self.fit]) / unit
        with suppress(ValueError, ZeroDivisionError, np.linalg.LinAlgError):
            x = least_squares(
                *(lambda x: at(*x)[0], first, lambda x: at(*x)[1], tuple(ends)),
                x_scale="jac",
                ftol=_DECREASE,
                xtol=EPS,
                gtol=None,
            ).x
            # The search stops about 1e-8 from the minimum, where rounding errors hide the decrease
            # of the sum of squares. Gauss-Newton steps refine it; each is kept if the next is less
            # than half as long.
            change, length = step(x)
            while ((ends[0] <= x + change) & (x + change <= ends[1])).all():
                following, remaining = step(x + change)
                if not remaining < length / 2:
                    break
                x, change, length = x + change, following, remaining
            if np.isfinite(x).all():
                return values(x)
        detail = "does not determine the parameters: extend the curve, or fit fewer of them"
        raise InputError((self.argument,), detail)
