"""Profile through, or near, the points of a table."""

from collections.abc import Callable, Sequence
from functools import cached_property, partial
from itertools import pairwise
from typing import ClassVar, Final, Self

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from mdr_core.abel.annulus import Annulus, inverse_hypot
from mdr_core.abel.displacement import Branch, Kernel, arccosine, arccosine_growth, arcsine
from mdr_core.abel.stress import stress_integral
from mdr_core.doubles import EPS, TINY
from mdr_core.elementwise import in_order, some, where
from mdr_core.errors import InputError
from mdr_core.profiles.base import Profile
from mdr_core.profiles.table_fit import fit_table
from mdr_core.profiles.truncated import RoundedPunch, Truncated, TruncatedCone
from mdr_core.quadrature import NODES, composite_rule
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import as_numbers, require_finite, require_list, single

# Bound on the error of the sums over the pieces: several times the largest in the tests.
_ROUNDING: Final = 2e-13
# Deviation that is within a standard uncertainty.
_MET: Final = 1.1
# Points of a piece at which the increase of g'(x)/x is sampled.
_SAMPLES: Final = 16
# Points of a tip from the coefficients of its area function.
_POINTS_OF_AREA: Final = 200


class Tabulated(Profile):
    """The smoothest admissible profile through the points of a table, never extrapolated.

    The equivalent profile has a slope g' >= 0 that is a spline, with the closed images of jumps of
    slope and curvature at declared breaks. Heights with many digits are met. From heights with
    noise, rounding or steps the profile deviates by no more than their scatter, which is estimated
    from the points unless it is given.

    Parameters
    ----------
    r, f : radii, in any order, on one or both sides of the axis, and heights, which rise away from
        the axis, with any offset [length], shape (k,). Radii may be repeated.
    breaks : radii where slope or curvature jumps [length].
    uncertainty : standard uncertainty of the heights [length]; 0 to meet the points, None to
        estimate it from their scatter.

    Raises
    ------
    InputError : points of no body whose contact area is a single disc.

    Source: notes, §5.

    Examples
    --------
    >>> from mdr_core.normal import solve
    >>> ball = Tabulated([-0.2, -0.1, 0.0, 0.1, 0.2], [0.02, 0.005, 0.0, 0.005, 0.02])
    >>> round(float(solve(ball, 1.0, contact_radius=0.1).normal_force), 9)
    0.001333333
    """

    kind: ClassVar[str] = "tabulated"
    formula: ClassVar[str] = "the smoothest admissible profile through, or near, the points (r, f)"
    closed_forms: ClassVar[tuple[str, ...]] = ("indentation_depth", "normal_stiffness")
    normal_method = "piecewise_moments"
    breaks: tuple[float, ...] = ()
    domain: float = np.inf

    def __init__(
        self,
        r: ArrayLike,
        f: ArrayLike,
        breaks: Sequence[float] = (),
        uncertainty: float | None = None,
    ) -> None:
        self.r, self.values = _checked(
            *(np.array(as_numbers(("profile", name), each)) for name, each in (("r", r), ("f", f)))
        )
        self.domain = float(np.abs(self.r).max())
        given = as_numbers(("profile", "breaks"), breaks).ravel().tolist()
        self.breaks = tuple(sorted(given))
        for i, b in enumerate(given):
            if not 0 < b < self.domain:
                detail = f"must lie between the axis and the last radius, {self.domain:.6g}"
                raise InputError(("profile", "breaks", i), detail)
        path = ("profile", "uncertainty")
        if uncertainty is not None and not 0 <= single(path, uncertainty) < np.inf:
            detail = "must be a standard uncertainty of the heights, positive or 0"
            raise InputError(path, detail)
        self.uncertainty = uncertainty
        self.fit = fit_table(self.r, self.values, self.breaks, uncertainty)
        self.meets_points = uncertainty is not None and self.fit.rms <= _MET * uncertainty
        """True if the profile deviates from the points by no more than their uncertainty."""
        self._spline = self.fit.pieces
        shapes = (kind(b, 1.0) for b in self.breaks for kind in (TruncatedCone, RoundedPunch))
        pairs = zip(self.fit.jumps, shapes, strict=True)
        self._flanks = [(jump, shape) for jump, shape in pairs if jump != 0]
        """Profiles that are added beyond the breaks, with their coefficients."""
        self.steepens = bool(self._flanks)
        self.flattens = not self.steepens

    @classmethod
    def from_area_coefficients(
        cls, coefficients: Sequence[float], largest_height: float, lowest_height: float = 0.0
    ) -> Self:
        """Return the profile of a tip with A(h) = C0 h^2 + C1 h + C2 h^(1/2) + C3 h^(1/4) + ...

        `data_error` does not include the errors of the coefficients. Source: oliver-pharr.

        Parameters
        ----------
        coefficients : C0, C1, ..., of any sign; Ci has the dimension length^(2 - 2^(1 - i)).
        largest_height : height up to which the tip is described [length].
        lowest_height : height from which A(h) is valid; below, the tip is continued smoothly to
            its end [length].

        Raises
        ------
        InputError : A(h) that does not increase from zero, with the height.
        """
        return cls(*tip_points(coefficients, largest_height, lowest_height))

    def __repr__(self) -> str:
        breaks = f", breaks={list(self.breaks)}" if self.breaks else ""
        return f"Tabulated({self.r.size} points up to radius {self.domain:.6g}{breaks})"

    def rounding_at(self, coordinate: Array) -> Parameter:
        return _ROUNDING

    @property
    def scale(self) -> float:
        return self.domain / 2

    @cached_property
    def coordinate_breaks(self) -> Array:
        """Knots and breaks, at which a derivative of g' jumps."""
        return np.union1d(self._spline.edges[1:-1], self.breaks)

    @property
    def _edges(self) -> Array:
        """Axis, knots, breaks and the end."""
        return np.concatenate([[0.0], self.coordinate_breaks, [self.domain]])

    @property
    def infinite_pressure_radii(self) -> tuple[Parameter, ...]:
        tip = () if self._spline.smooth_tip else (0.0,)
        return (*tip, *(b for _, shape in self._flanks for b in shape.infinite_pressure_radii))

    def _require_inside(self, radius: Array) -> None:
        if some(radius > self.domain):
            raise InputError(("profile", "r"), f"the table ends at radius {self.domain:.12g}")

    def _with_flanks(self, of_spline: Array, value: Callable[[Truncated], Array]) -> Array:
        """Value of the spline plus the values of the flanks."""
        return of_spline + sum(factor * value(shape) for factor, shape in self._flanks)

    # The shape.

    def f(self, radius: Array) -> Array:
        height = self._under_radius(radius, arccosine)
        return self._with_flanks(height, lambda shape: shape.f(radius))

    def df(self, radius: Array) -> Array:
        slope = self._under_radius(radius, arccosine_growth)
        tip = 2 / np.pi * self._spline.rows[0, 0]
        slope = np.where(radius > 0, slope, tip)[()]
        return self._with_flanks(slope, lambda shape: shape.df(radius))

    def _under_radius(self, radius: Array, kernel: Kernel) -> Array:
        """(2/pi) int_0^r g' K dx of the spline."""
        self._require_inside(radius)
        value = self._spline.under(0.0, self.domain, np.ravel(radius), kernel)
        return (2 / np.pi * value).reshape(np.shape(radius))[()]

    def g(self, x: Array) -> Array:
        self._require_inside(x)
        return self._with_flanks(self._spline.depth(x), lambda shape: shape.g(x))

    def dg(self, x: Array) -> Array:
        self._require_inside(x)
        return self._with_flanks(self._spline.slope(x), lambda shape: shape.dg(x))

    def depth_slope_beyond(self, coordinate: Array, start: Array, past: Array) -> Array:
        """Parameters: see `Profile`."""
        slope = self._spline.slope(coordinate)[()]
        for factor, shape in self._flanks:
            b = shape.flat_radius
            above = where(start == b, past, np.maximum(coordinate - b, 0.0))
            slope = slope + where(above > 0, factor * shape.depth_slope(above), 0.0)
        return slope

    # The normal contact.

    def reduced_force(self, coordinate: Array) -> Array:
        spline = 2 * self._spline.half_force(coordinate)
        return self._with_flanks(spline, lambda shape: shape.force_within(coordinate))

    def reduced_energy(self, coordinate: Array) -> Array:
        """Closed for a spline; with flanks int_0^a F_N(x)/E* g'(x) dx."""
        if not self._flanks:
            return self._spline.energy(coordinate)[()]
        return self._slope_integral(self.reduced_force, coordinate)

    def _slope_integral(self, density: Callable[[Array], Array], coordinate: Array) -> Array:
        """int_0^a density(x) g'(x) dx, by Gauss's rule on each piece."""
        # Successive halves of the last radius as edges, so that 1/x is smooth on a piece.
        a, halves = np.ravel(coordinate), self.domain / 2.0 ** np.arange(1, -np.log2(EPS))
        edges = np.union1d(self._edges, halves)
        piece = edges[1:-1].searchsorted(a, side="right")
        low, high = np.append(edges[:-1], edges[piece]), np.append(edges[1:], a)
        base = np.append(0.0, self.breaks)[np.searchsorted(self.breaks, low, side="right")]
        # s = sqrt(x^2 - b^2) removes the root of g' at the break below.
        first, last = inverse_hypot(low, base), inverse_hypot(high, base)
        nodes, weights = (part[:, None] for part in composite_rule(NODES))
        s = first + (last - first) * nodes
        x = np.maximum(np.hypot(base, s), TINY)
        slope = self.depth_slope_beyond(x, base, s * s / (x + base)) * s / x
        values = (last - first) * in_order(weights, density(x) * slope)
        total = np.append(0.0, np.cumsum(values[: edges.size - 1]))[piece]
        return np.asarray(total + values[edges.size - 1 :]).reshape(np.shape(coordinate))[()]

    # Fields.

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        weights = {base: partial(self._weight, base) for base in (0.0, *self.breaks)}
        ends = pairwise(self._edges.tolist())
        based = [(max(b for b in weights if b <= start), start, stop) for start, stop in ends]
        return tuple(Branch(base, weights[base], stop, start) for base, start, stop in based)

    def _weight(self, base: float, x: Array, s: Array) -> Array:
        """g'(x) s/x beyond the last break below, `base`."""
        if base == 0:
            return np.asarray(self._spline.slope(x))
        slope = self._spline.slope(x) * s / x
        for factor, shape in self._flanks:
            b = shape.flat_radius
            if b == base:
                slope = slope + factor * shape.weight(x, s)
            elif b < base:
                own = np.sqrt(s * s + (base - b) * (base + b))
                slope = slope + factor * shape.weight(x, own) * s / own
        return np.asarray(slope)

    def slip_integral(self, c: Array, r: Array) -> Array:
        """By Gauss's rule on the pieces. Parameters: see `Profile`."""

        def under(low: float, at: Array) -> Array:
            return 2 / np.pi * self._spline.under(low, self.domain, at, arccosine)

        spline = _of_each(under, (c,), r)
        return self._with_flanks(spline, lambda shape: shape.slip_integral(c, r))

    def outer_displacement(self, a: Array, r: Array, coordinate: float) -> Array:
        """By Gauss's rule on the pieces. Parameters: see `Profile`."""
        spline = 2 / np.pi * self._spline.under(0.0, float(a[0]), r, arcsine)

        def of_flank(shape: Truncated) -> Array:
            return shape.outer_displacement(a, r, coordinate - float(shape.flat_radius))

        return self._with_flanks(spline, of_flank)

    def annulus_integrals(
        self, low: Array, width: Array, *kernels: Kernel, degree: float = 0.0
    ) -> Array:
        """Parameters: see `Profile`."""
        if self._flanks:
            return super().annulus_integrals(low, width, *kernels, degree=degree)
        found = [
            self._spline.annulus(c, w, kernels)
            for c, w in zip(low.tolist(), width.tolist(), strict=True)
        ]
        return np.array(found).T.reshape(len(kernels), low.size)

    def falls_from_axis(self, coordinate: Array) -> Flags:
        return coordinate < self._falls_up_to

    @cached_property
    def _falls_up_to(self) -> float:
        """Radius up to which the pressure falls from the axis [length]. See `falls_from_axis`.

        The increase of h = g'(x)/x is sampled on the pieces.
        """
        if not self._spline.smooth_tip:
            return 0.0
        edges, rows, share = self._spline.edges, self._spline.rows, np.linspace(0.0, 1.0, _SAMPLES)
        # On the first piece h' = sum (k - 1) c_k x^(k - 2).
        tip = polyval(edges[1] * share, rows[2:, 0] * np.arange(1.0, len(rows) - 1)).max()
        x = edges[:-1, None] + np.diff(edges)[:, None] * share[1:]
        x, slope = x.ravel(), self._spline.slope(x.ravel())
        beyond = np.where(x > edges[1], (x * self._spline.slope(x, 1) - slope) / x**3, 0.0)
        # Where h' > 0 on the axis, the pressure may rise by `_ROUNDING`: notes, §7.
        rise = -np.log(_ROUNDING) / 2 * max(tip, 0.0) * x
        rise += np.maximum.accumulate(np.maximum(beyond, 0.0)) * np.square(x)
        ends = (slope <= 0) | (rise > slope / x)
        # The sample before the first one at which the pressure may not fall.
        known = np.append(0.0, x)[ends.argmax()] if ends.any() else np.inf
        return float(min([known, *self.breaks]))

    def axis_stress(self, coordinate: Array) -> Array:
        stress = self._slope_integral(np.reciprocal, coordinate) / np.pi
        return stress if self._spline.smooth_tip else stress + np.inf

    def pressure_kernel(self, annulus: Annulus, radius: Array) -> Array:
        """Source: notes, §5. Parameters: see `Profile`."""
        a, width, c, *_ = annulus
        spline = _of_each(self._spline.stress, (c, a, width), radius)

        def of_flank(shape: Truncated) -> Array:
            return stress_integral(shape.branches, annulus, radius)

        return self._with_flanks(spline, of_flank) / np.pi


def tip_points(
    coefficients: Sequence[float], largest_height: float, lowest_height: float = 0.0
) -> tuple[Array, Array]:
    """Radii and heights of a tip. Parameters: see `Tabulated.from_area_coefficients`."""
    if not 0 < largest_height < np.inf:
        raise InputError(("profile", "largest_height"), "must be positive")
    if not 0 <= lowest_height < largest_height:
        detail = "must be positive or 0, and below the largest height"
        raise InputError(("profile", "lowest_height"), detail)
    h = np.linspace(np.sqrt(lowest_height), np.sqrt(largest_height), _POINTS_OF_AREA) ** 2
    # The end of the tip is known, whatever A(h) is next to it.
    h = np.append(0.0, h[h > 0])
    area = np.array([c * h**2.0 ** (1 - i) for i, c in enumerate(coefficients)]).sum(axis=0)
    bad = np.flatnonzero((np.diff(area) <= 0) | (area[1:] <= 0))
    if bad.size:
        # Report the next valid height, or the largest one if there is none.
        valid = h[min(bad[-1] + 2, h.size - 1)]
        detail = (
            f"A(h) is not positive and increasing below the height {valid:.4g}: give a lowest "
            "valid height of at least this, or correct the coefficients"
        )
        raise InputError(("profile", "lowest_height"), detail)
    return np.sqrt(area / np.pi), h


def _of_each(function: Callable[..., Array], ends: tuple[Array, ...], radius: Array) -> Array:
    """Values at radii (m,) of a function of single annuli, called once for each annulus."""
    if all(end.size == 1 for end in ends):
        return function(*(end.item() for end in ends), radius)
    annuli = np.stack([np.ravel(end) for end in np.broadcast_arrays(*ends)])
    different, number = np.unique(annuli, axis=1, return_inverse=True)
    result = np.empty_like(radius)
    for i, annulus in enumerate(different.T.tolist()):
        points = np.flatnonzero(number == i)
        result[points] = function(*annulus, radius[points])
    return result


def _checked(r: Array, f: Array) -> tuple[Array, Array]:
    """Return the points; InputError unless they are finite, differ, and have three radii."""
    for name, values in (("r", r), ("f", f)):
        require_list(("profile", name), values)
        require_finite(("profile", name), values)
    if f.size != r.size:
        raise InputError(("profile", "f"), f"has {f.size} values for {r.size} radii")
    if np.unique(r).size < 3:
        raise InputError(("profile", "r"), "give at least three points with different radii")
    if np.ptp(f) == 0:
        detail = "all heights are equal: extend the table beyond the flat"
        raise InputError(("profile", "f"), detail)
    r.flags.writeable = f.flags.writeable = False
    return r, f
