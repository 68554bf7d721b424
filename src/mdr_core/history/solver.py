"""Load histories: forces, displacements, energies and slip regimes at every sample."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import conditioning, normal, validity
from mdr_core.doubles import EPS, ROUNDING
from mdr_core.elementwise import in_blocks, quotient
from mdr_core.errors import InputError
from mdr_core.history import load_path, slip_memory
from mdr_core.history.contact_state import ContactState, unloaded
from mdr_core.history.load_path import UNLOADED, SampledPath, SavedState
from mdr_core.history.slip_layout import NORMAL
from mdr_core.history.slip_memory import Polylines
from mdr_core.history.tractions import (
    REGIMES,
    TractionVertices,
    decides_regime,
    regime_codes,
)
from mdr_core.materials import Material
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices, Numbers
from mdr_core.validation import not_negative, only_one

# Number of steps whose vertices are kept for later results, which takes 40 MB. The vertices of more
# steps are computed again: that is faster than storing them, and memory is bounded.
_KEPT: Final = 262_144
# Vertices of a range of steps, and the polyline after these steps.
_Block = tuple[TractionVertices, Polylines]
# Location in the request of the normal load from which a history starts.
_BEGIN: Final = ("initial_state", "normal")


@dataclass(frozen=True, repr=False)
class LoadHistory(validity.ResultsOverLoads):
    """Results of a load history at every sample; each is computed on first use."""

    path: SampledPath
    e_star: float | Material
    """Effective modulus [pressure], or the material that has it."""
    before: Polylines
    """Slip memory at the start."""
    quantities: ClassVar[tuple[str, ...]] = (
        "step",
        "indentation_depth",
        "normal_force",
        "contact_radius",
        "tangential_displacement",
        "tangential_force",
        "dissipated_energy",
        "elastic_energy",
        "tangential_energy",
        "regime",
        "slip_fronts",
    )

    @cached_property
    def normal(self) -> NormalContact:
        """Normal contact of every sample, with zero load in separation."""
        given = {self.path.controls[0]: np.maximum(self._load, 0.0)}
        return normal.solve(self.path.start.profile, self.e_star, **given)

    @property
    def _load(self) -> Array:
        """Prescribed depth or normal force of every sample."""
        return self.path.loads[0, 1:]

    @property
    def step(self) -> Indices:
        """Index of the given point at which the load step of each sample ends."""
        return self.path.step

    @property
    def indentation_depth(self) -> Array:
        """d [length]; negative in separation."""
        if self.path.depth_prescribed:
            return self._load
        return self.normal.indentation_depth

    @property
    def normal_force(self) -> Array:
        """F_N [force]."""
        return self.normal.normal_force

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]; zero in separation."""
        return np.where(self._load <= 0, 0.0, self.normal.contact_radius)

    @property
    def elastic_energy(self) -> Array:
        """Energy stored by the normal load, int F_N dd [force length]."""
        return self.normal.elastic_energy

    @cached_property
    def tangential_force(self) -> Array:
        """F_x = mu E* sum k_i (I_i - I_i-1) over the segments [force]. Source: notes, §10."""
        start = self.path.start
        if self.path.over_forces:
            return self.path.loads[1, 1:]
        shear = self._per_step(lambda each: each.tree.at_load_points(each.shear))
        return start.friction_coefficient * start.e_star * shear

    @cached_property
    def tangential_displacement(self) -> Array:
        """u_x = mu (E*/G*) sum k_i (w_i - w_i-1) over the segments [length].

        Source: notes, §10. Full slip under a prescribed force leaves the displacement undetermined;
        from then on it is counted from the axis.
        """
        if not self.path.over_forces:
            return self.path.loads[1, 1:]
        anchor = self._per_step(lambda each: each.tree.at_load_points(each.anchor))
        return self.path.start.displacement_ratio * anchor

    @cached_property
    def tangential_energy(self) -> Array:
        """Energy stored by the tangential load, int q_x^2/(2 G*) dx [force length], >= 0."""
        energy = self._per_step(lambda each: each.tree.at_load_points(each.square))
        return self.path.start.energy_unit * energy

    @cached_property
    def dissipation(self) -> Array:
        """Energy dissipated by friction since the sample before [force length], >= 0."""
        return self.path.start.energy_unit * self._per_step(lambda each: each.dissipation)

    @cached_property
    def dissipated_energy(self) -> Array:
        """Energy dissipated by friction since the bodies were unloaded [force length]."""
        return self.path.begin.dissipated_energy + np.cumsum(self.dissipation)

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Slip regime: "no_contact", "stick", "partial_slip" or "full_slip".

        It depends on the springs at their friction limit: see `regime_codes`, `decides_regime`.
        """
        codes = self._per_step(regime_codes).astype(np.intp)
        coordinates, before = self.path.coordinates, REGIMES.index(self.path.begin.regime)
        known = decides_regime(codes, coordinates[0, 1:], *np.diff(coordinates))
        last = np.maximum.accumulate(np.where(known, np.arange(codes.size), -1))
        codes = np.maximum(np.where(last < 0, before, codes[last]), codes > 0)
        return np.array(REGIMES)[codes]

    @property
    def g_star(self) -> float:
        """Effective shear modulus [pressure]."""
        return self.path.start.g_star

    @property
    def _blocks(self) -> Iterable[_Block]:
        return self._kept if self._load.size <= _KEPT else self._follow()

    @cached_property
    def _kept(self) -> list[_Block]:
        return list(self._follow())

    def _follow(self) -> Iterator[_Block]:
        line, path, continues = self.before, self.path.coordinates[:, 1:], self.path.continues
        for block in in_blocks(continues.size):
            tree, line = slip_memory.follow(line, path[:, block], continues[block])
            yield TractionVertices(self.path.moments, tree), line

    def _per_step(self, result: Callable[[TractionVertices], Numbers]) -> Numbers:
        """Return a result of every step."""
        return np.concatenate([result(vertices) for vertices, _ in self._blocks])

    @cached_property
    def _after(self) -> Polylines:
        """Slip memory at the end."""
        return deque(self._blocks, maxlen=1)[0][1]

    @cached_property
    def state(self) -> ContactState:
        """State of the contact at the end of the history."""
        line = self._after
        if self.path.over_forces and len(line.vertices):
            vertices = TractionVertices(self.path.moments, line.tree(line.load_points))
            line = slip_memory.stacked(vertices.conjugate_step[1:], vertices.tree.slope[1:])
        return replace(self.path.start, polyline=line, before=line)

    @property
    def final_state(self) -> dict[str, Any]:
        """State at the end, from which `solve` continues the history; it can be stored as JSON."""
        normal, tangential = self.path.loads[:, -1].tolist()
        return SavedState(
            load_path.digest(self.path.start, *self.path.controls),
            normal,
            tangential,
            float(self.dissipated_energy[-1]),
            str(self.regime[-1]),
            self._after.vertices[:-1, :NORMAL].tolist(),
        )._asdict()

    @property
    def slip_fronts(self) -> Array:
        """Radii of the slip fronts at the end of the history, ascending [length]."""
        return self.state.slip_fronts

    @property
    def method(self) -> str:
        """Most expensive method among the results."""
        return self.path.start.profile.tangential_method

    @property
    def error_estimate(self) -> float:
        """Bound on the error of each result, relative to its largest value in the history."""
        of_sums = (conditioning.OF_SUMS + self._condition_number) * self.normal.error_estimate
        return of_sums + self.rounding

    @cached_property
    def rounding(self) -> float:
        """Relative rounding error of steps of the tangential load and of the slip front [1].

        Both have the rounding error of the larger coordinate. It passes with the slope 2a or 1/(2a)
        to the other tangential load, thence to the stored energy, and with the way of the springs
        to the dissipated energy.
        """
        path, start, radius = self.path, self.path.start, 2 * self.contact_radius
        normal, size = np.maximum(path.coordinates[0], 0.0), np.abs(path.coordinates[1])
        deeper, further = np.diff(normal), np.abs(np.diff(path.coordinates[1]))
        most, held = np.maximum(normal, size), np.minimum(normal, size)[1:]
        found = self.tangential_force / (start.friction_coefficient * start.e_star)
        moved = most[1:] * radius
        if path.over_forces:
            found = self.tangential_displacement / start.displacement_ratio
            moved = quotient(most[1:], radius)
        energy = self.tangential_energy / start.energy_unit
        error = quotient(moved.max(), np.abs(found).max(), quotient(most.max(), held.max()))
        error += quotient((moved * held).max(), energy.max())
        # Springs that the normal load releases slip back by no more than they were displaced.
        way = np.where(deeper > 0, further - deeper, np.abs(further + deeper))
        way = np.minimum(way, np.maximum.accumulate(size)[1:])
        most = np.maximum(most[1:], most[:-1])
        # If the loads grow in the ratio of friction, only rounding errors move the front.
        lost = self.dissipation * quotient(most, np.where(way > ROUNDING * most, way, 0.0))
        error += quotient(lost.sum(), self.dissipated_energy[-1])
        # The conversion of the normal coordinate adds the rounding error of an inverse.
        return float(error * (ROUNDING if path.mixed else 2 * EPS))

    @cached_property
    def _condition_number(self) -> float:
        """Largest relative condition number of the results with respect to the loads."""
        limit = self.path.start.friction_coefficient * np.asarray(self.normal_force)
        if self.path.over_forces:
            return conditioning.of_forces(self.normal, np.abs(self.tangential_force), limit)
        loads = self.tangential_displacement, self.tangential_force, limit
        return conditioning.of_sliding(*loads, lambda: float(self.dissipated_energy[-1]))

    @property
    def slips_from(self) -> Array:
        """Smallest radius with slip [length] in full slip; infinite otherwise."""
        return np.where(self.regime == "full_slip", 0.0, np.inf)


def solve(
    profile: Profile,
    e_star: float | Material,
    g_star: float | Material | None,
    friction_coefficient: float,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    tangential_displacement: ArrayLike | None = None,
    tangential_force: ArrayLike | None = None,
    samples_per_step: int = 1,
    initial_state: Mapping[str, Any] | None = None,
) -> LoadHistory:
    """Return the results of a load history that starts from the unloaded bodies.

    Between two samples both loads vary linearly: depth and displacement where a displacement is
    prescribed, normal and tangential force where a tangential force is prescribed. Every such path
    is solved exactly. A negative depth separates the bodies and erases the slip memory.

    A depth with a tangential force, or a normal force with a displacement, is prescribed at the
    samples. Where both change on a step, more samples approach the curve on which both vary
    linearly. The first step is one straight line from zero load, because under a tangential force
    there is no equilibrium on the curve next to first contact.

    Source: mdr-5, Eqs. (5.4)-(5.9), (5.19)-(5.23), (5.71); notes, §10.

    Parameters
    ----------
    profile : profile of any kind, with single numbers as parameters.
    e_star, g_star : effective moduli [pressure], > 0, or the material that has them, for each.
    friction_coefficient : mu [1], > 0.
    indentation_depth, normal_force : exactly one, the points [length], [force], shape (n,).
    tangential_displacement, tangential_force : exactly one, the points [length], [force] of either
        sign, shape (n,). One of the two may be a single value for all points.
    samples_per_step : samples from each point to the next, evenly spaced in the normal load, >= 1.
    initial_state : `final_state` of an earlier history of this contact under these controls. A path
        in pieces has the results of the whole path.

    Returns
    -------
    The results at n x samples_per_step samples, arrays of that length.

    Raises
    ------
    InputError : not exactly one of each pair, points that are not finite, a negative normal force,
        a depth beyond the end of the profile, |F_x| > mu F_N anywhere on the path, a tangential
        force where the bodies touch or separate on a step, or an initial state of another contact.

    Examples
    --------
    Unloading a tangential force to zero leaves a displacement, Eq. (5.16) and Masing's rule.

    >>> from mdr_core.profiles import Paraboloid
    >>> history = solve(Paraboloid(0.01), 1.1e11, 0.9e11, 0.3,
    ...                 normal_force=10.0, tangential_force=[0.0, 2.0, 0.0])
    >>> u = history.tangential_displacement
    >>> rho = 2.0 / 3.0
    >>> residual = (1 - (1 - rho) ** (2 / 3)) - 2 * (1 - (1 - rho / 2) ** (2 / 3))
    >>> bool(abs(u[2] / u[1] - residual / (1 - (1 - rho) ** (2 / 3))) < 1e-13)
    True
    """
    start = unloaded(profile, e_star, g_star, friction_coefficient)
    normal_load = {"indentation_depth": indentation_depth, "normal_force": normal_force}
    tangential_load = {
        "tangential_displacement": tangential_displacement,
        "tangential_force": tangential_force,
    }
    pressed = only_one(("history", "normal"), normal_load)
    pushed = only_one(("history", "tangential"), tangential_load)
    begin = UNLOADED
    if initial_state is not None:
        contact = load_path.digest(start, pressed[0], pushed[0])
        begin = SavedState.parsed(initial_state, contact)
        if pressed[0] == "normal_force" and begin.normal < 0:
            raise InputError(_BEGIN, not_negative("normal_force"))
    path = load_path.build(start, pressed, pushed, samples_per_step, begin)
    _require_solvable(path)
    return LoadHistory(path, e_star, begin.restored(path.coordinates[:, 0]))


def _require_solvable(path: SampledPath) -> None:
    """Raise InputError unless the normal contact has a solution at the start and at all samples.

    It suffices that the largest load and the smallest load above zero have a solution.
    """
    loads, name = np.maximum(path.even_samples[0], 0.0), path.controls[0]
    ends = np.array([loads.argmax(), np.where(loads > 0, loads, np.inf).argmin()])
    try:
        normal.solve(path.start.profile, path.start.e_star, **{name: loads[ends]})
    except InputError as error:
        if error.path[:1] != ("load",):
            raise
        at = int(ends[error.path[2]])
        place = "history", "normal", name, int(path.step[at - 1])
        raise InputError(place if at else _BEGIN, error.detail) from None
