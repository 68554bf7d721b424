"""Fretting wear over the number of cycles, from the first cycle to the limiting state."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import isfinite
from typing import ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import tangential, validity
from mdr_core.errors import AccuracyError, InputError, Notice
from mdr_core.materials import Material, modulus
from mdr_core.normal import NormalContact
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import (
    UNRESOLVED,
    as_numbers,
    reject,
    require_not_negative,
    require_single_positive,
    require_tolerance,
    require_type,
    require_whole,
    single,
)
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.arguments import grid, one_amplitude
from mdr_core.wear.initial_state import InitialState
from mdr_core.wear.integrator import integrate
from mdr_core.wear.worn_surface import WornSurface

# Default of `resolution`: ten times as accurate as 24 in nearly the same time.
DEFAULT_RESOLUTION: Final = 48
# Smallest `resolution`.
COARSEST: Final = 8
# Largest `resolution`.
FINEST: Final = 96
# Smallest tolerance of the integration over the cycles.
TIGHTEST_INTEGRATION: Final = 1e-10
# Warnings in full slip.
_FULL_SLIP: Final = {
    "contact_lost": "the whole contact slips and wears until nothing touches at the constant "
    "depth; a groove that a long stroke wears into the counter-body is not included",
    "endless_wear": "the whole contact slips and wears without bound under the constant force; "
    "a groove that a long stroke wears into the counter-body is not included",
}
FIELDS: Final = ("profile", "worn_depth", "pressure")
SCALARS: Final = (
    "worn_volume",
    "indentation_depth",
    "normal_force",
    "stick_radius",
    "contact_radius",
    "dissipated_energy",
)

# Nodes beyond `resolution`: fewer than 16 can be unstable at the stick edge.
_EXTRA_NODES: Final = 16
# Nodes of the second run of the error estimates, over the nodes of the first.
_COARSER: Final = 2 / 3
# Tolerance of the second run over the tolerance of the first.
_LOOSER: Final = 4.0
# Factor of the difference in an estimate of a scalar, whose error is at most 0.8 times the
# difference where it falls like 1/resolution^2.
_SAFETY: Final = 2.0
# Factor for a field: its error falls more slowly in the thin pressure peak at a moving stick edge.
_OF_FIELDS: Final = 4.0
# Factor beside a break, where both runs may err alike.
_AT_BREAKS: Final = 10.0
# Radii at which the two runs are compared besides the given ones, as parts of the worn annulus.
_SAMPLES: Final = np.linspace(0.0, 1.0, 66)[1:-1]


@dataclass(frozen=True, repr=False)
class WearEvolution(validity.ContactResults, WornSurface):
    """Worn contact at each requested number of cycles, with error estimates."""

    coarse: WornSurface = field(kw_only=True)
    """Worn contact by fewer nodes and a looser tolerance, for the error estimates."""
    rtol: float = field(kw_only=True)
    """Tolerance of the integration over the cycles [1]."""
    quantities: ClassVar[tuple[str, ...]] = ("cycles", *SCALARS)

    @cached_property
    def error_estimate(self) -> float:
        """Estimate of the relative error of every scalar [1].

        Twice the difference from a run on two thirds of the nodes with a looser integrator, its
        tolerance, and the rounding error of the contact before wear. With a break of the
        profile in the worn annulus both runs may err alike: there their absolute difference counts,
        and the error of the wear in the first cycle, whose friction work is known.
        In full slip the error of the normal force is relative to the force before wear.
        """
        worst = self._absolute_difference if self._has_break else 0.0
        for name in SCALARS:
            value, other = getattr(self, name), getattr(self.coarse, name)
            size = self._whole_force if name == "normal_force" else value
            worst = max(worst, float((np.abs(value - other) / np.where(size, size, 1.0)).max()))
        # The errors of two integrations may be equal.
        tolerance = _LOOSER * self.rtol if self.initial.slips else 0.0
        first = self._first_cycle_error if self._has_break and self.initial.slips else 0.0
        return _SAFETY * worst + tolerance + first + self.tangential_contact.error_estimate

    @property
    def _first_cycle_error(self) -> float:
        """Relative error of the wear in the first cycle, from its friction work [1]."""
        initial = self.initial
        state = AnnulusState(initial, initial.vector[:, None])
        slipped = 2 * np.pi * state.end**3 * (initial.maps.volume @ (state.stress * state.slip))
        contact = self.tangential_contact
        friction = contact.friction_coefficient * self.normal.e_star * contact.displacement_ratio
        return float(np.abs(friction * slipped / contact.dissipated_energy - 1).max())

    @property
    def _whole_force(self) -> Array:
        """Normal force; in full slip, its value before wear [force]."""
        if self.initial.full_slip:
            return np.full(self.cycles.shape, float(self.normal.normal_force))
        return self.normal_force

    @property
    def _absolute_difference(self) -> float:
        """Largest absolute difference of the two runs, relative to force or depth, and volume [1].

        Integrals over the annulus of the differences of the springs' wear and of the worn depth.
        """
        r, runs = self._samples, (self, self.coarse)
        springs = np.abs(np.subtract(*(run.spring_wear(r) for run in runs)))
        depths = np.abs(np.subtract(*(run.worn_depth(r) for run in runs)))
        whole = self._whole_force / (2 * self.normal.e_star)
        if self.initial.constant_force:
            whole = self.contact_radius * self.indentation_depth
        volume = np.where(self.worn_volume > 0, self.worn_volume, 1.0)
        parts = np.trapezoid(springs, r) / whole, 2 * np.pi * np.trapezoid(depths * r, r) / volume
        return float(np.max(parts))

    @property
    def _samples(self) -> Array:
        """Radii in the worn annulus after the last of the cycles [length]."""
        c, a = self.stick_radius[-1], self.contact_radius[-1]
        return np.asarray(c + (a - c) * _SAMPLES)

    @property
    def _has_break(self) -> bool:
        """True if a break of the profile lies in a worn annulus."""
        profile = self.normal.profile
        breaks = np.array([*profile.breaks, *profile.infinite_pressure_radii])
        c, a = self.stick_radius[:, None], self.contact_radius[:, None]
        return bool(((breaks > c) & (breaks < a)).any())

    def field_error_estimate(self, radius: ArrayLike, names: Sequence[str] = FIELDS) -> float:
        """Return a bound on the error of the fields at some radii [1].

        Relative to the largest value of each field at these radii and all cycles; or to the mean
        pressure F_N/(pi a^2), or the mean depth of the worn annulus, if this is larger.

        Parameters
        ----------
        radius : radii r >= 0 [length], (m,).
        names : fields among `FIELDS`.

        Raises
        ------
        InputError : as for `worn_depth`.
        """
        r = self._radii(radius)
        worst = max((self._difference(name, r) for name in names), default=0.0)
        safety = _AT_BREAKS if self._has_break else _OF_FIELDS
        return safety * worst + self.tangential_contact.error_estimate

    def _difference(self, name: str, radius: Array) -> float:
        """Return the largest difference of a field between the two runs, see above."""
        c, a = self.stick_radius, self.contact_radius
        annulus = np.pi * (a - c) * (a + c)
        least = {
            "pressure": self.normal_force / (np.pi * a**2),
            "worn_depth": self.worn_volume / np.where(annulus > 0, annulus, 1.0),
        }
        # At single radii the difference may vanish.
        at = np.append(radius, self._samples)
        values, others = (getattr(run, name)(at) for run in (self, self.coarse))
        largest = max(_largest(values[:, : radius.size]), float(np.max(least.get(name, 0.0))))
        return _largest(values, others) / (largest or 1.0)

    def grid(self, points: int) -> Array:
        """Return radii from 0 to a quarter beyond the largest contact [length], (points,).

        They cluster at the axis, the breaks, the first and the last contact radius, and a stick
        radius at rest; a moving stick radius has an error. Errors as for `limit.LimitingWear.grid`.
        """
        edges = self.contact_radius[[0, -1]]
        if not self.initial.stick_moves:
            edges = np.append(edges, self.stick_radius[0])
        return grid(self.initial.normal.profile, edges, points)

    @property
    def method(self) -> str:
        """Most expensive method: the slope of a worn profile is an integral."""
        return "quadrature" if self.initial.slips else self.tangential_contact.method

    @property
    def tangential_contact(self) -> TangentialContact:
        """The contact before any wear, with the amplitude applied once."""
        return self.initial.tangential_contact

    @property
    def solved(self) -> TangentialContact:
        """Contact on which the validity depends."""
        return self.tangential_contact

    @property
    def normal(self) -> NormalContact:
        """Normal contact before any wear."""
        return self.initial.normal

    @property
    def warnings_without_bodies(self) -> tuple[Notice, ...]:
        """Warnings that do not depend on the bodies."""
        found = list(self.tangential_contact.warnings_without_bodies)
        if self.initial.full_slip and self.initial.slips:
            code = "endless_wear" if self.initial.constant_force else "contact_lost"
            found.append(Notice(code, _FULL_SLIP[code]))
        if isfinite(self.settled_at):
            found.append(
                Notice(
                    "limit_reached",
                    # The approach is asymptotic: rtol and resolution change the second digit.
                    f"wear stops after about {self.settled_at:.1g} cycles: the profile is the "
                    "limiting one from there on",
                )
            )
        return tuple(found)


def solve(
    contact: NormalContact,
    g_star: float | Material | None,
    friction_coefficient: float,
    *,
    wear_coefficient: float,
    cycles: ArrayLike,
    tangential_displacement: float | None = None,
    tangential_force: float | None = None,
    resolution: int = DEFAULT_RESOLUTION,
    rtol: float = 1e-6,
) -> WearEvolution:
    """Solve for the wear of a contact under an oscillating tangential load.

    df/dN = K mu p(r) S(r), S = 4 |s(r)|: the wear of a cycle is proportional to its friction work
    at each place, so that dV/dN = K W. The depth or the normal force of the contact, whichever
    was prescribed, and the amplitude are held constant. The whole contact wears if a displacement
    amplitude exceeds the onset of full slip.

    Source: mdr-5, Problem 6; dimaki, the wear law; notes, §11.

    Parameters
    ----------
    contact : normal contact before wear, under a single load.
    g_star : effective shear modulus [pressure], > 0, or the material that has it.
    friction_coefficient : mu > 0 [1].
    wear_coefficient : K > 0, worn volume per dissipated energy [1/pressure].
    cycles : numbers of cycles >= 0, ascending, (k,).
    tangential_displacement, tangential_force : exactly one, the amplitude of the oscillation
        [length], [force].
    resolution : number of nodes over the worn annulus, in addition to 16; 8 to 96.
    rtol : relative tolerance of the integration over the cycles, 1e-10 to 1e-3.

    Returns
    -------
    WearEvolution : scalars and fields at each number of cycles.

    Raises
    ------
    InputError : several loads; a force amplitude at which full slip occurs, at once or, with
        the depth held, after some cycles; full slip of a flat punch, or full slip that ends because
        the axis sticks; cycles that are negative or not ascending; a worn contact that reaches the
        profile's end.
    AccuracyError : the wear is not resolved.

    Examples
    --------
    The first cycle wears K W, W = (16 mu^2 E*^2/(15 G* R^2)) (a - c)^3 (a^2 + 3 a c + c^2).

    >>> from mdr_core.normal import solve as press
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = press(Paraboloid(1.0), 1.0, indentation_depth=1.0)
    >>> worn = solve(contact, 1.0, 1.0, wear_coefficient=1e-6, cycles=[1.0, 1e9],
    ...     tangential_displacement=0.75)
    >>> [float(f"{volume:.4g}") for volume in worn.worn_volume]
    [3.667e-07, 0.7593]
    """
    require_type("contact", contact, NormalContact, "a contact from normal.solve")
    name, size = one_amplitude(tangential_displacement, tangential_force)
    require_single_positive(("wear_coefficient",), wear_coefficient)
    require_tolerance(rtol, TIGHTEST_INTEGRATION)
    require_whole(("resolution",), resolution)
    if not COARSEST <= resolution <= FINEST:
        raise InputError(("resolution",), f"must lie from {COARSEST} to {FINEST}")
    single(("load",), contact.contact_radius)
    single(("material", "g_star"), modulus("g_star", g_star))
    single(("friction_coefficient",), friction_coefficient)
    single(("tangential", name), size)
    tangential_contact = tangential.solve(contact, g_star, friction_coefficient, **{name: size})
    if tangential_contact.full_slip and contact.profile.is_flat_punch:
        detail = "full slip of a flat punch: the pressure at its edge is infinite; round the edge"
        raise InputError(("tangential", name), detail)
    if tangential_contact.full_slip and name == "tangential_force":
        detail = "full slip at any displacement: reduce the force, or prescribe the displacement"
        raise InputError(("tangential", name), detail)
    numbers, nodes = _checked_cycles(cycles), int(resolution) + _EXTRA_NODES
    initial = InitialState(tangential_contact, float(wear_coefficient), nodes)
    coarser = replace(initial, nodes=int(nodes * _COARSER))
    run, other = integrate(initial, numbers, rtol), integrate(coarser, numbers, _LOOSER * rtol)
    found = WearEvolution(**vars(run), coarse=other, rtol=rtol)
    if not found.error_estimate < UNRESOLVED:
        detail = "the worn annulus is not resolved: more nodes may resolve it"
        raise AccuracyError(detail, ("resolution",))
    return found


def _largest(values: Array, others: Array | float = 0.0) -> float:
    """Return the largest difference of values that are finite."""
    known = np.isfinite(values) & np.isfinite(others)
    with np.errstate(invalid="ignore"):
        return float(np.abs(values - others)[known].max(initial=0.0))


def _checked_cycles(cycles: ArrayLike) -> Array:
    numbers = as_numbers(("cycles",), cycles)
    if numbers.ndim != 1 or numbers.size == 0:
        raise InputError(("cycles",), "a list of at least one number is needed")
    require_not_negative(("cycles",), numbers)
    falls = np.append(False, np.diff(numbers) < 0)
    reject(("cycles",), numbers, falls, "must be ascending")
    return numbers
