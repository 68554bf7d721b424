"""Shear modulus and friction coefficient from a hysteresis loop under a constant normal load.

After a reversal of the displacement the force follows the law of first loading, enlarged twice
(Masing), also with a rig of compliance C in series, U = u + C F.

Source: mindlin-deresiewicz; notes, §15.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import inf
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import residuals, tangential
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import LeastSquaresFit, Precision, minimum, require_fitted
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import (
    as_curve,
    as_positive,
    require_not_negative,
    require_type,
    single,
)

PARAMETERS: Final = (
    *("g_star", "friction_coefficient", "force_offset", "rig_compliance"),
    "displacement_offset",
)
"""Quantities that can be fitted."""
# Amplitudes that are tried first, over that of full slip; parts of the latter in the rig; points of
# first loading between which the forces are interpolated for this.
_TRIED, _IN_RIG, _POINTS = np.geomspace(0.01, 30.0, 40), np.linspace(0.0, 0.96, 25), 200
# Points for each parameter.
_FEWEST: Final = 2
# Most steps of Newton's method, which takes about 12, and their relative size at the end.
_STEPS, _CONVERGED = 100, 8 * EPS
# Range of log G* and log mu about the start, which keeps the numbers representable.
_RANGE: Final = 15.0
# Step of a difference of logarithms about the result, and of C in its unit.
_STEP: Final = 1e-5
# Half width of an interval of 95 % in log G* or log mu, over the error, and at most. Source: notes,
# §15.
_HALF, _WIDEST = 1.96, 0.5
# Compliance over its standard error below which zero is as likely: the sum of squares exceeds its
# minimum by a tenth of the variance.
_NO_WORSE: Final = 0.1**0.5
# Cause of residuals that are not noise.
_CAUSES: Final = {
    "misfit": "the shape, the rig, the normal load or the model is wrong, the points hold the "
    "first loading, or the force lags behind",
    "correlated_noise": "the forces drift, or neighbouring errors are alike",
}
_CODES: Final = {"two_branches": "misfit", "drift": "correlated_noise"}


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class LoopFit(LeastSquaresFit):
    """Fitted parameters of a loop with their standard errors."""

    turning: TangentialContact
    """Contact at the turning points of the loop, as on first loading."""
    force_offset: float
    """F_0, the force in the middle of the loop [force]."""
    displacement_offset: float
    """U_0, the displacement in the middle of the loop [length]."""
    rig_compliance: float
    """C, as given or fitted [length/force]."""
    tangential_displacement: Array
    """Measured displacements [length], shape (k,)."""
    tangential_force: Array
    """Fitted forces [force], shape (k,)."""
    dissipated_energy_error: float
    """Standard deviation of `dissipated_energy`, by those of the parameters [force length]."""
    quantities: ClassVar[tuple[str, ...]] = (
        *("fit", "g_star", "friction_coefficient", "force_offset", "rig_compliance"),
        "displacement_offset",
        *("standard_errors", "correlation", "noise", "misfit"),
        *("dissipated_energy", "dissipated_energy_error"),
        *("tangential_displacement", "tangential_force", "residual"),
    )

    @property
    def solved(self) -> TangentialContact:
        """Contact on which the validity depends."""
        return self.turning

    @property
    def normal(self) -> NormalContact:
        """Contact under the normal load."""
        return self.turning.normal

    @property
    def g_star(self) -> float:
        """Effective shear modulus G* [pressure]."""
        return float(self.turning.g_star)

    @property
    def friction_coefficient(self) -> float:
        """mu [1]."""
        return float(self.turning.friction_coefficient)

    @property
    def dissipated_energy(self) -> float:
        """Energy of a cycle, four times that dissipated on first loading [force length]."""
        return 4 * float(self.turning.dissipated_energy)

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        return *self.turning.warnings_without_bodies, *self.notices


def solve(
    contact: NormalContact,
    *,
    tangential_displacement: ArrayLike,
    tangential_force: ArrayLike,
    fit: Sequence[str] | None = None,
    g_star: float | None = None,
    friction_coefficient: float | None = None,
    rig_compliance: float | None = None,
) -> LoopFit:
    """Fit G* and mu to a steady loop, or several, of the tangential force over the displacement.

    F_x = F_0 + s (2 F((A + s (U - U_0))/2) - F(A)), s = 1 on rising and -1 on falling displacement,
    with the amplitude A and the middle U_0 of the displacements, and F the force on first loading
    of the contact in series with the rig.

    Parameters
    ----------
    contact : contact under the constant normal load.
    tangential_displacement : in the order of the measurement, exact beside the forces [length],
        shape (k,).
    tangential_force : measured forces [force], shape (k,).
    fit : parameters to fit, of `PARAMETERS`; by default the first four, less those that are given.
        Unless fitted, the force offset is 0, and the displacement offset the middle between the
        largest and the least displacement, which the turning points may exceed between samples.
    g_star, friction_coefficient : G* [pressure] and mu [1], if they are not fitted.
    rig_compliance : C of the rig in series, 0 of displacements measured at the contact; fitted if
        it is not given, which needs a loop with full slip, or almost [length/force].

    Returns
    -------
    The parameters with standard errors and correlation, and the residuals.

    Raises
    ------
    InputError : lists of different lengths, fewer than two points for each parameter, or a loop
        that leaves G* or mu open, for want of slip or of the compliance of the rig.

    Examples
    --------
    >>> from mdr_core import history, normal
    >>> from mdr_core.profiles import Paraboloid
    >>> u = 1e-6 * np.sin(np.linspace(0.5, 4.5, 81) * np.pi)
    >>> path = {"normal_force": np.full(82, 10.0), "tangential_displacement": np.append(0.0, u)}
    >>> force = history.solve(Paraboloid(0.01), 2e9, 1.6e9, 0.3, **path).tangential_force[1:]
    >>> ball = normal.solve(Paraboloid(0.01), 2e9, normal_force=10.0)
    >>> curve = {"tangential_displacement": u, "tangential_force": force}
    >>> found = solve(ball, **curve, rig_compliance=0.0)
    >>> print(f"{found.g_star:.6g} {found.friction_coefficient:.6g}")
    1.6e+09 0.3
    """
    require_type("contact", contact, NormalContact, "a contact from normal.solve")
    if np.ndim(contact.normal_force) or not contact.normal_force > 0:
        raise InputError(("contact",), "must be under a single normal load")
    names = "g_star", "friction_coefficient", "rig_compliance"
    known = dict(zip(names, (g_star, friction_coefficient, rig_compliance), strict=True))
    fit = [name for name in PARAMETERS[:4] if known.get(name) is None] if fit is None else fit
    require_fitted(fit, PARAMETERS, known)
    for name, value in known.items():
        if value is not None:
            require = require_not_negative if name == "rig_compliance" else as_positive
            require((name,), np.asarray(single((name,), value)))
    lists = {"tangential_displacement": tangential_displacement}
    curve = as_curve("displacements", **lists, tangential_force=tangential_force)
    if curve[0].size < _FEWEST * len(fit) or np.ptp(curve[0]) == 0:
        detail = f"must hold {_FEWEST * len(fit)} points of a loop"
        raise InputError(("tangential_displacement",), detail)
    return _Loop(contact, *curve, fit, known).result()


class _Loop:
    """Measured loop, and the model that is fitted to it."""

    def __init__(
        self,
        contact: NormalContact,
        u: Array,
        force: Array,
        fit: Sequence[str],
        known: Mapping[str, float | None],
    ) -> None:
        self.contact, self.displacement, self.force = contact, u, force
        self.fit, self.known = tuple(fit), known
        self.free = [PARAMETERS.index(name) for name in fit]
        self.amplitude, self.size = float(np.ptp(u)) / 2, float(np.ptp(force)) or 1.0
        self.middle, self.sign = (u.max() + u.min()) / 2, residuals.directions(u)
        self.units = np.array(
            [1.0, 1.0, self.size, self.amplitude / self.size, self.amplitude], dtype=float
        )
        """Units of log G*, log mu, F_0, C and U_0 less the middle of the displacements."""

    def places(self, x: Array) -> Array:
        """Return displacements on first loading that stand for the points, and the amplitude."""
        from_middle = self.displacement - self.middle - self.amplitude * x[4]
        halves = (self.amplitude + self.sign * from_middle) / 2
        return np.append(np.maximum(halves, 0.0), self.amplitude)

    def branches(self, first: Array) -> Array:
        """Return the forces of the loop for those on first loading, by Masing's rule."""
        return np.asarray(self.sign * (2 * first[:-1] - first[-1]))

    def first_loading(self, x: Array) -> TangentialContact:
        """Return the contact at the displacements u + C F(u) = `places`, for all parameters.

        F is concave, so that Newton's method rises to the root from below, u = U/(1 + 2 G* a C).
        """
        (g_star, friction), rig = np.exp(x[:2]).tolist(), float(x[3] * self.units[3])
        places = self.places(x)
        u = places / (1 + rig * 2 * g_star * float(self.contact.contact_radius))
        for _ in range(_STEPS):
            law = tangential.solve(self.contact, g_star, friction, tangential_displacement=u)
            left = places - u - rig * law.tangential_force
            step = left / (1 + rig * law.tangential_stiffness)
            if np.all(np.abs(step) <= _CONVERGED * places):
                break
            u = u + step
        return law

    def forces(self, x: Array) -> Array:
        """Return the forces over `size` for all parameters, in `units`."""
        return self.branches(self.first_loading(x).tangential_force) / self.size + x[2]

    def slopes(self, x: Array) -> Array:
        """Return the slopes of `forces`, at given displacements of contact and rig together."""
        law = self.first_loading(x)
        force, stiffness = law.tangential_force, law.tangential_stiffness
        yielding = 1 / (1 + x[3] * self.units[3] * stiffness)
        # F/(mu E*) depends on G* u/(mu E*) alone, and dF/du = 2 G* c.
        of_g_star = stiffness * law.tangential_displacement
        of_rig = -force * stiffness * self.units[3]
        firsts = (of_g_star, force - of_g_star, of_rig)
        columns = [self.branches(each * yielding) / self.size for each in firsts]
        columns.insert(2, np.ones_like(self.force))
        # A point moves by half of U_0 on first loading, and its force counts twice.
        columns.append(-(stiffness * yielding)[:-1] * self.amplitude / self.size)
        return np.column_stack(columns)[:, self.free]

    def energy_slopes(self, x: Array) -> Array:
        """Return the slopes of the energy of a cycle, by central differences."""
        slopes = []
        for step in _STEP * np.eye(x.size)[self.free]:
            above, below = (self.first_loading(end) for end in (x + step, x - step))
            change = above.dissipated_energy[-1] - below.dissipated_energy[-1]
            slopes.append(4 * change / (2 * _STEP))
        return np.array(slopes)

    def start(self) -> Array:
        """Return the best of many parameters, or an InputError.

        For a given amplitude over that of full slip, and part of the latter in the rig, the force
        is linear in mu and F_0.
        """
        part = np.linspace(0.0, 1.0, _POINTS)
        pressed, depth = self.contact, float(self.contact.indentation_depth)
        law = tangential.solve(pressed, pressed.e_star, 1.0, tangential_displacement=part * depth)
        reached = law.tangential_force / pressed.normal_force
        some = slice(None, None, max(1, self.force.size // _POINTS))
        measured, on_first = self.force[some] / self.size, self.places(np.zeros(5)) / self.amplitude
        rigs = _IN_RIG[: 1 if self.known["rig_compliance"] == 0 else None].tolist()
        tried = list(product(rigs, _TRIED.tolist()))
        firsts = (
            np.interp(on_first * ratio, (1 - in_rig) * part + in_rig * reached, reached)
            for in_rig, ratio in tried
        )
        shapes = np.array([self.branches(first)[some] for first in firsts])
        rising = shapes - shapes.mean(axis=1)[:, None]
        sizes = np.linalg.norm(rising, axis=1)
        # The sum of squares is least where the part of the forces in the shape is largest.
        along = rising @ measured / np.where(sizes > 0, sizes, inf)
        best = int(along.argmax())
        if not along[best] > 0:
            raise InputError(("tangential_force",), "must rise with the displacement")
        (in_rig, ratio), limit = tried[best], float(along[best] / sizes[best])
        friction = limit * self.size / float(pressed.normal_force)
        whole = (1 - in_rig) * self.amplitude / ratio
        g_star = friction * float(pressed.e_star) * depth / whole
        offset = measured.mean() - limit * shapes[best].mean()
        found = [np.log(g_star), np.log(friction), offset, in_rig / ratio / limit, 0.0]
        values = np.array([self.known.get(name) for name in PARAMETERS], dtype=float) / self.units
        given = [*np.log(values[:2]), 0.0, values[3], 0.0]
        return np.where(np.isin(range(5), self.free), found, given)

    def result(self) -> LoopFit:
        """Return the fit, or an InputError."""
        start, measured = self.start(), self.force / self.size
        bounds = np.full((2, start.size), inf) * [[-1], [1]]
        bounds[:, :2], bounds[0, 3] = np.add.outer([-_RANGE, _RANGE], start[:2]), 0.0
        bounds[:, 4] = -1.0, 1.0

        def whole(free: Array) -> Array:
            values = start.copy()
            values[self.free] = free
            return values

        def model(free: Array) -> tuple[Array, Array]:
            x = whole(free)
            return self.forces(x) - measured, self.slopes(x)

        found = minimum(model, start[self.free], bounds[:, self.free])
        x = whole(found)
        residual = measured - self.forces(x)
        scatter = float(np.sqrt(residual @ residual / (residual.size - len(self.fit))))
        try:
            precision = Precision.of(self.slopes(x), self.fit, "tangential_displacement")
        except InputError:
            raise self.refused() from None
        # The model is exact to rounding.
        errors = max(scatter, EPS) * precision.deviations
        if _HALF * errors[np.less(self.free, 2)].max(initial=0.0) > _WIDEST:
            raise self.refused()
        tests = residuals.misfit(self.displacement, precision.q, residual, measured, in_time=True)
        code, misfit = residuals.worst(tests)
        code = _CODES.get(code, code)
        notices = [*residuals.doubts(code, misfit, _CAUSES[code])]
        units = self.units * [*np.exp(x[:2]), 1.0, 1.0, 1.0]
        values = x * self.units
        if "rig_compliance" in self.fit:
            error = errors[self.fit.index("rig_compliance")]
            if x[3] < _NO_WORSE * error:
                message = "no compliance of the rig is seen: rig_compliance is at its bound 0"
                notices.append(Notice("bound", message, float(values[3]), None))
        law = self.first_loading(x)
        most = float(law.tangential_displacement[-1])
        moduli = np.exp(x[:2]).tolist()
        slopes = self.energy_slopes(x) / precision.scale
        return LoopFit(
            fit=self.fit,
            turning=tangential.solve(self.contact, *moduli, tangential_displacement=most),
            force_offset=float(values[2]),
            rig_compliance=float(values[3]),
            displacement_offset=float(self.middle + values[4]),
            standard_errors=errors * units[self.free],
            correlation=precision.correlation,
            tangential_displacement=self.displacement,
            tangential_force=self.force - residual * self.size,
            residual=residual * self.size,
            noise=scatter * self.size,
            misfit=misfit,
            dissipated_energy_error=scatter * float(np.linalg.norm(slopes @ precision.inverse)),
            error_estimate=precision.error(float(law.error_estimate), residual, measured),
            notices=tuple(notices),
        )

    def refused(self) -> InputError:
        """Return the error of a loop that leaves parameters open."""
        if "rig_compliance" in self.fit:
            detail = "give rig_compliance or slide through"
            told = "partial slip cannot tell the contact from the rig"
            return InputError(("rig_compliance",), f"{told}: {detail}")
        detail = "take an amplitude at which a part of the contact slips, and check rig_compliance"
        return InputError(("tangential_displacement",), f"leaves G* or mu open: {detail}")
