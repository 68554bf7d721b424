"""Shear modulus and friction coefficient from a hysteresis loop under a constant normal load.

After a reversal of the displacement the force follows the law of first loading, scaled by two
(Masing), also with a rig of compliance C in series, U = u + C F.

Source: mindlin-deresiewicz; notes, §15.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress, product
from math import inf
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import residuals, tangential
from mdr_core.doubles import EPS
from mdr_core.errors import InputError, Notice
from mdr_core.estimation import (
    CurveModel,
    LeastSquaresFit,
    Parameters,
    Precision,
    linear,
    require_fitted,
)
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
# Parameters of the contact law.
_LAW: Final = PARAMETERS[:2]
# First trials: amplitudes over the amplitude of full slip, and parts of it in the rig; number of
# points of first loading between which their forces are interpolated.
_TRIED, _IN_RIG, _POINTS = np.geomspace(0.01, 30.0, 40), np.linspace(0.0, 0.96, 25), 200
# Minimum number of points for each parameter.
_FEWEST: Final = 2
# Maximum number of Newton steps, usually about 12, and their relative size at convergence.
_STEPS, _CONVERGED = 100, 8 * EPS
# Range of G* and mu about the start, which keeps the numbers representable.
_RANGE: Final = 3e6
# Half width of a 95 % interval in log G* or log mu: over the error, and its maximum. Source: notes,
# §15.
_HALF, _WIDEST = 1.96, 0.5
# Compliance over its standard error below which zero is as likely: the sum of squares exceeds its
# minimum by a tenth of the variance.
_NO_WORSE: Final = 0.1**0.5
# Cause of residuals that are not noise.
_CAUSES: Final = {
    "misfit": "the shape, the rig, the normal load or the model is wrong, the points hold the "
    "first loading, or the force lags behind",
    "correlated_noise": "the forces drift, neighbouring errors are alike, or the points hold the "
    "first loading",
}


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
        """Energy of a cycle, four times the energy dissipated on first loading [force length]."""
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
    tangential_displacement : in the order of the measurement, with negligible errors [length],
        shape (k,).
    tangential_force : measured forces [force], shape (k,).
    fit : parameters to fit, of `PARAMETERS`; by default the first four, less those that are given.
        Unless fitted, the force offset is 0, and the displacement offset the middle between the
        largest and the least displacement, which the turning points may exceed between samples.
    g_star, friction_coefficient : G* [pressure] and mu [1], if they are not fitted.
    rig_compliance : C of the rig in series, 0 for displacements measured at the contact; fitted if
        it is not given, which needs a loop in or close to full slip [length/force].

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
    given = {name: value for name, value in known.items() if value is not None}
    for name, value in given.items():
        require = require_not_negative if name == "rig_compliance" else as_positive
        require((name,), np.asarray(single((name,), value)))
    lists = {"tangential_displacement": tangential_displacement}
    curve = as_curve("displacements", **lists, tangential_force=tangential_force)
    if curve[0].size < _FEWEST * len(fit) or np.ptp(curve[0]) == 0:
        detail = f"must hold {_FEWEST * len(fit)} points of a loop"
        raise InputError(("tangential_displacement",), detail)
    return _Loop(contact, *curve, tuple(fit), given).result()


@dataclass(frozen=True, eq=False)
class _Loop(CurveModel):
    """Measured loop, and the model that is fitted to it."""

    contact: NormalContact
    displacement: Array
    force: Array
    fit: tuple[str, ...]
    given: Parameters
    """Values of the parameters that are not fitted."""
    argument: ClassVar[str] = "tangential_displacement"

    @cached_property
    def amplitude(self) -> float:
        """Half of the range of displacements [length]."""
        return float(np.ptp(self.displacement)) / 2

    @cached_property
    def sign(self) -> Array:
        """1 on rising displacement, and -1 on falling."""
        return residuals.directions(self.displacement)

    def places(self, middle: float) -> Array:
        """Return displacements on first loading that stand for the points, and the amplitude."""
        halves = (self.amplitude + self.sign * (self.displacement - middle)) / 2
        return np.append(np.maximum(halves, 0.0), self.amplitude)

    def branches(self, first: Array) -> Array:
        """Return the forces of the loop from the forces on first loading, by Masing's rule."""
        return np.asarray(self.sign * (2 * first[..., :-1] - first[..., -1:]))

    def first_loading(self, values: Parameters) -> TangentialContact:
        """Return the contact at the displacements u + C F(u) = `places`.

        F is concave, so that Newton's method rises to the root from below, u = U/(1 + 2 G* a C).
        """
        g_star, friction, _, rig, middle = (values[name] for name in PARAMETERS)
        places = self.places(middle)
        u = places / (1 + rig * 2 * g_star * float(self.contact.contact_radius))
        for _ in range(_STEPS):
            law = tangential.solve(self.contact, g_star, friction, tangential_displacement=u)
            left = places - u - rig * law.tangential_force
            step = left / (1 + rig * law.tangential_stiffness)
            if np.all(np.abs(step) <= _CONVERGED * places):
                break
            u = u + step
        return law

    def at(self, values: Parameters) -> tuple[Array, Array]:
        """Return the forces of the model, and their slopes in the fitted parameters."""
        law = self.first_loading(values)
        force, stiffness = law.tangential_force, law.tangential_stiffness
        of_g_star = stiffness * law.tangential_displacement
        # Without slip the difference is rounding error.
        slips = np.where(force - of_g_star > _CONVERGED * force, force - of_g_star, 0.0)
        yielding = 1 / (1 + values["rig_compliance"] * stiffness)
        # F/(mu E*) depends on G* u/(mu E*) alone, and dF/du = k.
        firsts = {
            "g_star": of_g_star / values["g_star"],
            "friction_coefficient": slips / values["friction_coefficient"],
            "rig_compliance": -force * stiffness,
        }
        columns = {name: self.branches(first * yielding) for name, first in firsts.items()}
        columns["force_offset"] = np.ones_like(self.force)
        # A point moves by half of U_0 on first loading, and its force counts twice.
        columns["displacement_offset"] = -(stiffness * yielding)[:-1]
        slopes = np.column_stack([columns[name] for name in self.fit])
        return self.branches(force) + values["force_offset"], slopes

    def energy_slopes(self, turning: TangentialContact) -> Array:
        """Return the slopes of the energy of a cycle, 4 D, in the fitted parameters.

        On first loading D = mu^2/G* f(G* u/mu) and dD/du = F - k u = s. The turning points
        prescribe the displacement u + C F of contact and rig.
        """
        energy, u = float(turning.dissipated_energy), float(turning.tangential_displacement)
        force, stiffness = float(turning.tangential_force), float(turning.tangential_stiffness)
        slips, rig = force - stiffness * u, self.best["rig_compliance"]
        moved = slips / (1 + rig * stiffness)
        slopes = {
            "g_star": (moved * u - energy) / self.best["g_star"],
            "friction_coefficient": (2 * energy - slips * (u + rig * moved))
            / self.best["friction_coefficient"],
            "rig_compliance": -force * moved,
        }
        return 4 * np.array([slopes.get(name, 0.0) for name in self.fit])

    def start(self) -> Parameters:
        """Return the best of many parameters, or an InputError.

        Each trial is an amplitude over the amplitude of full slip, and a part of the latter in the
        rig. For a trial the force is linear in mu and F_0.
        """
        part = np.linspace(0.0, 1.0, _POINTS)
        pressed, depth = self.contact, float(self.contact.indentation_depth)
        law = tangential.solve(pressed, pressed.e_star, 1.0, tangential_displacement=part * depth)
        reached = law.tangential_force / pressed.normal_force
        some = slice(None, None, max(1, self.force.size // _POINTS))
        middle = float(self.displacement.max() + self.displacement.min()) / 2
        on_first = self.places(middle) / self.amplitude
        rigs = _IN_RIG[: 1 if self.given.get("rig_compliance") == 0 else None].tolist()
        tried = list(product(rigs, _TRIED.tolist()))
        firsts = (
            np.interp(on_first * ratio, (1 - in_rig) * part + in_rig * reached, reached)
            for in_rig, ratio in tried
        )
        shapes = np.array([self.branches(first)[some] for first in firsts])
        squares, limits, offsets = linear(shapes, self.force[some])
        best = int(np.where(limits > 0, squares, inf).argmin())
        if not limits[best] > 0:
            detail = "must rise with the displacement: reverse the sign of one of them"
            raise InputError(("tangential_force",), detail)
        (in_rig, ratio), limit = tried[best], float(limits[best])
        friction = limit / float(pressed.normal_force)
        whole = (1 - in_rig) * self.amplitude / ratio
        g_star = friction * float(pressed.e_star) * depth / whole
        rig, offset = in_rig / ratio * self.amplitude / limit, float(offsets[best])
        found = dict(zip(PARAMETERS, (g_star, friction, offset, rig, middle), strict=True))
        left_out = {"force_offset": 0.0, "displacement_offset": middle} | self.given
        return left_out | {name: found[name] for name in self.fit}

    @cached_property
    def best(self) -> Parameters:
        """Parameters of the least sum of squares, or an InputError."""
        start, size = self.start(), float(np.ptp(self.force)) or 1.0
        middle, reach = start["displacement_offset"], self.amplitude
        bounds = {
            **{name: (start[name] / _RANGE, start[name] * _RANGE, start[name]) for name in _LAW},
            "force_offset": (-inf, inf, size),
            "rig_compliance": (0.0, inf, reach / size),
            "displacement_offset": (middle - reach, middle + reach, reach),
        }
        return self.minimum(start, bounds)

    def result(self) -> LoopFit:
        """Return the fit, or an InputError."""
        found, residual, (forces, slopes) = self.best, self.residual, self.fitted
        try:
            precision = self.precision
        except InputError:
            raise self.refused() from None
        effects = self.scatter * precision.effects
        deviations = self.scatter * precision.deviations
        errors = dict(zip(self.fit, deviations.tolist(), strict=True))
        if any(_HALF * errors.get(name, 0.0) > _WIDEST * found[name] for name in _LAW):
            raise self.refused()
        tests = residuals.misfit(self.displacement, precision.q, residual, self.force, in_time=True)
        misfit, notices = residuals.judged(tests, _CAUSES)
        rig = found["rig_compliance"]
        if rig < _NO_WORSE * errors.get("rig_compliance", 0.0):
            message = "no compliance of the rig is seen: rig_compliance is at its bound 0"
            notices = (*notices, Notice("bound", message, rig, None))
        # A compliance that would become negative stays at its bound.
        steps = zip(self.fit, precision.changes(residual), strict=True)
        free = [name != "rig_compliance" or rig + step >= 0 for name, step in steps]
        movable = Precision.of(slopes[:, free], [*compress(self.fit, free)], self.argument)
        law = self.first_loading(found)
        # Near full slip the stick radius has a larger error than the force.
        relative = float(np.max(law.step_error))
        most = float(law.tangential_displacement[-1])
        moduli = found["g_star"], found["friction_coefficient"]
        turning = tangential.solve(self.contact, *moduli, tangential_displacement=most)
        energy_error = np.linalg.norm(self.energy_slopes(turning) @ effects)
        return LoopFit(
            fit=self.fit,
            turning=turning,
            force_offset=found["force_offset"],
            rig_compliance=rig,
            displacement_offset=found["displacement_offset"],
            effects=effects,
            tangential_displacement=self.displacement,
            tangential_force=forces,
            residual=residual,
            noise=self.scatter,
            misfit=misfit,
            dissipated_energy_error=float(energy_error),
            error_estimate=movable.error(relative, residual, self.force),
            notices=notices,
        )

    def refused(self) -> InputError:
        """Return the error of a loop that does not determine all parameters."""
        if "rig_compliance" in self.fit:
            detail = "give rig_compliance or slide through"
            told = "partial slip cannot tell the contact from the rig"
            return InputError(("rig_compliance",), f"{told}: {detail}")
        detail = "take an amplitude at which a part of the contact slips, and check rig_compliance"
        return InputError(("tangential_displacement",), f"leaves G* or mu open: {detail}")
