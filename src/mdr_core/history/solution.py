"""The answers along a history: forces, displacements, energies and regimes at every sample."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import normal, sensitivity
from mdr_core.errors import InputError, Notice
from mdr_core.history import memory, path
from mdr_core.history.branches import Branches
from mdr_core.history.followed import Arcs, Followed, Straight
from mdr_core.history.path import Path
from mdr_core.history.state import State, unloaded
from mdr_core.lazy import cached_property
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices
from mdr_core.validity import friction_notices

# Rounding of the sums over the branches, in units of the profile's own.
_SUMS: Final = 40.0


@dataclass(frozen=True)
class History:
    """A history of loads, at every sample; each answer is computed when it is first asked for."""

    path: Path
    start: State
    """The unloaded contact."""
    followed: Followed
    rtol: float

    @cached_property
    def contact(self) -> NormalContact:
        """Normal contact of every sample; gaps as zero load."""
        loads = {self.path.normal_name: np.maximum(self.path.normal, 0.0)}
        return normal.solve(self.start.profile, self.start.e_star, **loads, rtol=self.rtol)

    @property
    def step(self) -> Indices:
        """Index of the given point that each sample leads to."""
        return self.path.step

    @cached_property
    def indentation_depth(self) -> Array:
        """d [length]; negative in a gap."""
        if self.path.normal_name == "indentation_depth":
            return self.path.normal
        return self.contact.indentation_depth

    @cached_property
    def normal_force(self) -> Array:
        """F_N [force]."""
        return self.contact.normal_force

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]; zero in a gap."""
        return np.where(self._separated, 0.0, self.contact.contact_radius)

    @cached_property
    def elastic_energy(self) -> Array:
        """Stored by the normal load, int F_N dd [force length]."""
        return self.contact.elastic_energy

    @property
    def _separated(self) -> "np.ndarray[Any, np.dtype[np.bool_]]":
        if self.path.normal_name == "indentation_depth":
            return self.path.normal < 0
        return np.zeros(self.path.normal.shape, dtype=bool)

    @cached_property
    def tangential_force(self) -> Array:
        """F_x = mu E* sum k (I_i - I_i-1) over the branches [force]. Source: notes, §10."""
        return self.path.tangential if self.path.by_force else self._force

    @cached_property
    def tangential_displacement(self) -> Array:
        """u_x = mu (E*/G*) sum k (w_i - w_i-1), from the axis on [length]."""
        return self._displacement if self.path.by_force else self.path.tangential

    @cached_property
    def tangential_energy(self) -> Array:
        """Stored by the tangential load, int q_x^2/(2 G*) dx [force length]."""
        scale = self._force_scale * self.start.compliance
        return self._at_samples(scale, lambda part: part.square)

    @cached_property
    def dissipation(self) -> Array:
        """Energy lost to friction on the way to each sample from the one before [force length]."""
        return self._force_scale * self.start.compliance * self.followed.lost()

    @cached_property
    def dissipated_energy(self) -> Array:
        """Energy lost to friction since the start [force length]."""
        return np.cumsum(self.dissipation)

    @cached_property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Regime: "no_contact", "stick", "partial_slip" or "full_slip".

        By what is at its limit at the sample: nothing, the outermost springs, or all.
        """
        names = np.array(["no_contact", "stick", "partial_slip", "full_slip"])
        codes = np.zeros(self.path.normal.shape, dtype=np.intp)
        for samples, part, top in self.followed.tops():
            tree = part.tree
            below = tree.parent[top]
            slipping = (tree.forward_step[top] == 0) | (tree.backward_step[top] == 0)
            full = slipping & (tree.parent[below] < 0)
            partial = 1 if self.start.profile.slips_at_once else 2
            code = np.where(full, 3, np.where(slipping, partial, 1))
            codes[samples] = np.where(top >= 0, code, 0)
        return names[codes]

    @cached_property
    def state(self) -> State:
        """What the contact remembers at the end."""
        chain = self.followed.end()
        if self.path.by_force and len(chain.forward) < 2:
            chain = memory.gap(min(float(self.indentation_depth[-1]), 0.0), 0.0)
        return replace(
            self.start, chain=chain, chords=self.followed.curved, curved=self.followed.arcs()
        )

    @property
    def slip_fronts(self) -> Array:
        """Radii inside the contact where the branch of q_x changes at the end [length]."""
        return self.state.slip_fronts

    @property
    def method(self) -> str:
        """The dearest route among the answers."""
        return self.contact.profile.tangential_method

    @property
    def error_estimate(self) -> float:
        """Bound on the error of each answer, relative to its largest value on the way."""
        return (_SUMS + self._felt) * self.contact.error_estimate + self.followed.deviation

    @cached_property
    def _felt(self) -> float:
        """The most by which an answer changes relatively for a relative change of the loads."""
        limit = self.start.friction_coefficient * np.asarray(self.normal_force)
        if self.path.by_force:
            return sensitivity.of_forces(self.contact, np.abs(self.path.tangential), limit)
        way = self.path.tangential, self.tangential_force, limit
        return sensitivity.of_travel(*way, lambda: self.dissipation)

    @property
    def state_error_estimate(self) -> float:
        """The same for what `advance` goes on from, where chords stand for arcs.

        Fields of the end take the arcs themselves: for them `error_estimate` holds.
        """
        return _SUMS * self.contact.error_estimate + self.followed.chord

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """Those of the normal contacts, `friction`, and `accuracy` where rtol is missed."""
        start = self.start
        found = [notice for notice in self.contact.warnings if notice.code != "accuracy"]
        found += friction_notices(start.friction_coefficient, start.e_star, start.g_star)
        if self.error_estimate > self.rtol:
            found.append(
                Notice(
                    "accuracy",
                    f"rtol = {self.rtol:.1e} is not reached on this way: see error_estimate",
                )
            )
        return tuple(found)

    @property
    def _force_scale(self) -> float:
        return self.start.friction_coefficient * self.start.e_star

    def _at_samples(self, scale: float, answer: Callable[[Branches], Array]) -> Array:
        """An answer of the load points at the samples; zero where nothing touches."""
        result = np.zeros(self.path.normal.shape)
        for samples, part, top in self.followed.tops():
            found = answer(part)[top]
            found[top < 0] = 0.0
            np.multiply(found, scale, out=result[samples])
        return result

    @cached_property
    def _force(self) -> Array:
        return self._at_samples(self._force_scale, lambda part: part.shear)

    @cached_property
    def _displacement(self) -> Array:
        return self._at_samples(self.start.compliance, lambda part: part.anchor)


def solve(
    profile: Profile,
    e_star: float,
    g_star: float,
    friction_coefficient: float,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    tangential_displacement: ArrayLike | None = None,
    tangential_force: ArrayLike | None = None,
    samples_per_step: int = 1,
    rtol: float = 1e-10,
) -> History:
    """Return a history of normal and tangential load, which starts from bodies that just touch.

    The load goes straight, in the controlled quantities, from zero to the first point and on from
    point to point. Depths with displacements and normal with tangential forces are followed
    exactly. A depth below zero is a gap: the contact is lost, and its return finds no memory. If
    depth and tangential force or normal force and displacement are controlled, steps in which
    both change are arcs, along which integrals are taken to the relative accuracy `rtol`.

    Source: mdr-5, Eqs. (5.4)-(5.9), (5.19)-(5.23), (5.71); notes, §10.

    Parameters
    ----------
    profile : any kind, one scene.
    e_star, g_star : effective moduli [pressure], > 0.
    friction_coefficient : mu > 0 [1].
    indentation_depth, normal_force : exactly one, the points [length], [force], shape (n,).
    tangential_displacement, tangential_force : exactly one, of either sign, shape (n,). Of the
        two rows one may hold a single value, which then holds at all points.
    samples_per_step : how many samples, evenly, from each point to the next.
    rtol : relative accuracy asked for, 1e-13 to 1e-3.

    Returns
    -------
    The answers at n x samples_per_step samples.

    Raises
    ------
    InputError : not exactly one of each pair, points that are not finite, a negative normal force,
        a depth past the profile's end, or |F_x| > mu F_N at any place on the way.

    Examples
    --------
    Unloading a tangential force to zero leaves a displacement, Eq. (5.16) and Masing's rule.

    >>> from mdr_core.profiles import Paraboloid
    >>> way = solve(Paraboloid(0.01), 1.1e11, 0.9e11, 0.3,
    ...             normal_force=10.0, tangential_force=[0.0, 2.0, 0.0])
    >>> u = way.tangential_displacement
    >>> rho = 2.0 / 3.0
    >>> residual = (1 - (1 - rho) ** (2 / 3)) - 2 * (1 - (1 - rho / 2) ** (2 / 3))
    >>> bool(abs(u[2] / u[1] - residual / (1 - (1 - rho) ** (2 / 3))) < 1e-13)
    True
    """
    start = unloaded(profile, e_star, g_star, friction_coefficient)
    pressed = {"indentation_depth": indentation_depth, "normal_force": normal_force}
    pushed = {
        "tangential_displacement": tangential_displacement,
        "tangential_force": tangential_force,
    }
    way = path.build(_one("normal", pressed), _one("tangential", pushed), samples_per_step)
    _require_reach(start, way)
    scale = friction_coefficient * e_star / (1.0 if way.by_force else g_star)

    curved = bool(way.curved.any()) and not profile.slips_at_once
    return History(way, start, (_arcs if curved else _straight)(way, start, scale, rtol), rtol)


def _straight(way: Path, start: State, scale: float, _: float) -> Followed:
    steps = path.steps(way, start.profile, start.e_star, scale)
    return Straight(start.profile, way.by_force, start.chain, steps)


def _arcs(way: Path, start: State, scale: float, rtol: float) -> Followed:
    points, last = path.points(way, start.profile, start.e_star, scale)
    return Arcs(start.profile, way.by_force, points, last, rtol)


def _one(axis: str, given: dict[str, ArrayLike | None]) -> tuple[str, ArrayLike]:
    named = [(name, value) for name, value in given.items() if value is not None]
    if len(named) != 1:
        raise InputError(("history", axis), f"exactly one of {', '.join(given)} is needed")
    return named[0]


def _require_reach(start: State, way: Path) -> None:
    """Refuse a load past the profile's end: if the largest is not, none is."""
    name = way.normal_name
    try:
        normal.solve(start.profile, start.e_star, **{name: max(float(way.normal.max()), 0.0)})
    except InputError as error:
        if error.path[:1] != ("load",):
            raise
        at = ("history", "normal", name, int(way.step[way.normal.argmax()]))
        raise InputError(at, error.detail) from None
