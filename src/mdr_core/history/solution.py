"""The answers along a history: forces, displacements, energies and regimes at every sample."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import normal, sensitivity
from mdr_core.errors import InputError, Notice
from mdr_core.history import dissipation, memory, path
from mdr_core.history.branches import Branches
from mdr_core.history.memory import Chain, Tree
from mdr_core.history.path import Path, Steps
from mdr_core.history.state import State, unloaded
from mdr_core.lazy import cached_property
from mdr_core.normal import NormalContact
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Flags, Indices
from mdr_core.validity import friction_notices

# Steps walked at once: bounds the memory, and keeps what is computed of them in cache.
_BLOCK: Final = 16_384
# Pieces of a curved stretch, at first and at most, and how many steps they may be in all.
_FEWEST: Final = 16
_MOST: Final = 16_384
_MOST_STEPS: Final = 300_000
# A step on a body whose depth has no closed inverse costs some ten times as much.
_DEARER: Final = 10
# Rounding of the sums over the branches, in units of the profile's own.
_SUMS: Final = 40.0


@dataclass(frozen=True)
class History:
    """A history of loads, at every sample; each answer is computed when it is first asked for."""

    path: Path
    start: State
    """The unloaded contact."""
    steps: Steps
    rtol: float
    coarser: "History | None" = None
    """The same with steps twice as long on the curved stretches, where there are any."""

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
        return self.path.tangential if self.path.by_force else self._refined("_force")

    @cached_property
    def tangential_displacement(self) -> Array:
        """u_x = mu (E*/G*) sum k (w_i - w_i-1), from the axis on [length]."""
        return self._refined("_displacement") if self.path.by_force else self.path.tangential

    @cached_property
    def tangential_energy(self) -> Array:
        """Stored by the tangential load, int q_x^2/(2 G*) dx [force length]."""
        return self._refined("_energy")

    @cached_property
    def dissipation(self) -> Array:
        """Energy lost to friction on the way to each sample from the one before [force length]."""
        # An extrapolation may fall below zero where nothing is lost, a loss may not.
        return np.maximum(self._refined("_dissipation"), 0.0)

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
        for samples, tree, top in self._tops():
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
        chain = self.start.chain
        for _, walked in self._blocks():
            chain = memory.walk(chain, *walked).end
        if self.path.by_force and len(chain.forward) > 1:
            chain = self._in_depths(chain)
        elif self.path.by_force:
            chain = memory.gap(min(float(self.indentation_depth[-1]), 0.0), 0.0)
        return replace(self.start, chain=chain, chords=bool(self.path.curved.any()))

    @property
    def slip_fronts(self) -> Array:
        """Radii inside the contact where the branch of q_x changes at the end [length]."""
        return self.state.slip_fronts

    @cached_property
    def deviation(self) -> float:
        """How far the last halving of the chords moved the answers, relative; infinite if none."""
        if self.coarser is None:
            return 0.0
        return (
            inf
            if self.coarser.coarser is None
            else self._moved_from(self.coarser, History._refined)
        )

    @cached_property
    def chord(self) -> float:
        """How far it moved what is remembered, which is not extrapolated."""
        return 0.0 if self.coarser is None else self._moved_from(self.coarser, getattr)

    def _moved_from(self, rough: "History", answer: Callable[["History", str], Array]) -> float:
        """Largest relative difference to the rougher in the answers that chords move."""
        names = "_displacement" if self.path.by_force else "_force", "_dissipation"
        return max(_distance(answer(self, name), answer(rough, name)) for name in names)

    @property
    def method(self) -> str:
        """The dearest route among the answers."""
        return self.contact.profile.tangential_method

    @property
    def error_estimate(self) -> float:
        """Bound on the error of each answer, relative to its largest value on the way."""
        return (_SUMS + self._felt) * self.contact.error_estimate + self.deviation

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
        """The same for what is remembered at the end, which is not extrapolated."""
        return _SUMS * self.contact.error_estimate + self.chord

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

    def _blocks(self) -> Iterator[tuple[slice, tuple[Array, Array, Flags]]]:
        """Blocks of steps: their place, levels, shifts and which go on."""
        steps = self.steps
        for begin in range(0, steps.level.size, _BLOCK):
            part = slice(begin, begin + _BLOCK)
            yield part, (steps.level[part], steps.shift[part], steps.goes_on[part])

    def _tops(self) -> Iterator[tuple[slice, Tree, Indices]]:
        """For each block in which something touches: samples, vertices, their load points."""
        chain = self.start.chain
        for part, walked in self._blocks():
            tree = memory.walk(chain, *walked)
            chain = tree.end
            if not tree.level.size:
                # Nothing touches.
                continue
            samples, ends = self.steps.samples(part)
            yield samples, tree, tree.top[ends]

    def _at_samples(self, scale: float, answer: Callable[[Branches], Array]) -> Array:
        """An answer of the load points at the samples; zero where nothing touches."""
        result = np.zeros(self.path.normal.shape)
        for samples, tree, top in self._tops():
            part = answer(Branches(self.start.profile, tree, self.path.by_force))
            found = part[top]
            found[top < 0] = 0.0
            np.multiply(found, scale, out=result[samples])
        return result

    def _refined(self, name: str) -> Array:
        """An answer without the leading order of what the chords of curved stretches cost."""
        fine: Array = getattr(self, name)
        return fine if self.coarser is None else _extrapolated(getattr(self.coarser, name), fine)

    @cached_property
    def _force(self) -> Array:
        return self._at_samples(self._force_scale, lambda part: part.shear)

    @cached_property
    def _displacement(self) -> Array:
        return self._at_samples(self.start.compliance, lambda part: part.anchor)

    @cached_property
    def _energy(self) -> Array:
        scale = self._force_scale * self.start.compliance
        return self._at_samples(scale, lambda part: part.square)

    @cached_property
    def _dissipation(self) -> Array:
        lost, chain = np.zeros(self.steps.level.shape), self.start.chain
        for part, walked in self._blocks():
            tree, found = memory.slips(chain, *walked)
            chain = tree.end
            each = dissipation.per_piece(self.start.profile, found, by_force=self.path.by_force)
            np.add.at(lost, found.step + part.start, each)
        if self.steps.last is not None:
            lost = np.add.reduceat(lost, np.append(-1, self.steps.last[:-1]) + 1)
        return np.asarray(self._force_scale * self.start.compliance * lost)

    def _in_depths(self, chain: Chain) -> Chain:
        """A polyline over forces as the one over depths, with the digits of its pieces."""
        part = Branches(self.start.profile, memory.as_tree(chain), by_force=True)
        span, slope = part.depth_step[1:], part.tree.slope[1:]
        return memory.stacked(span * (1 + slope), span * (1 - slope))


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
    both change are curved, and are followed to the relative accuracy `rtol`.

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

    def follow(pieces: int, coarser: History | None) -> History:
        walked = path.steps(way, profile, e_star, scale, pieces)
        return History(way, start, walked, rtol, coarser)

    closed = profile.coordinate_from_depth(np.zeros(1)) is not None
    return _refine(way, follow, rtol, closed=closed) if way.curved.any() else follow(1, None)


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


def _refine(
    way: Path, follow: Callable[[int, History | None], History], rtol: float, *, closed: bool
) -> History:
    """Halve the steps on curved stretches until they move the answers less than rtol.

    Chords leave an error that falls with the square of their length, which two lengths tell; what
    is left beyond it falls at least as fast, so that the last change exceeds it.
    """
    steps = _MOST_STEPS if closed else _MOST_STEPS // _DEARER
    most = min(_MOST, max(steps // int(way.curved.sum()), 4 * _FEWEST))
    pieces, found = 2 * _FEWEST, follow(2 * _FEWEST, follow(_FEWEST, None))
    before = inf
    # Where rounding is all that moves, shorter steps do not help.
    while pieces < most and found.deviation > rtol and (found.deviation < before or before == inf):
        pieces, before = 2 * pieces, found.deviation
        found = follow(pieces, found)
    return found


def _extrapolated(rough: Array, fine: Array) -> Array:
    return np.asarray(fine + (fine - rough) / 3)


def _distance(fine: Array, rough: Array) -> float:
    scale = float(np.abs(fine).max())
    return float(np.abs(fine - rough).max()) / scale if scale > 0 else 0.0
