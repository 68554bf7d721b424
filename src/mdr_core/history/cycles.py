"""Cycles between two tangential loads, under a constant or an oscillating normal load."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from mdr_core.controls import default_samples
from mdr_core.errors import AccuracyError, InputError
from mdr_core.history.solver import LoadHistory, solve
from mdr_core.materials import Material
from mdr_core.profiles import Profile
from mdr_core.typing import Array
from mdr_core.validation import UNRESOLVED, only_one, require_whole, single


@dataclass(frozen=True, repr=False)
class LoadCycles(LoadHistory):
    """Load history of identical cycles, with the energy and the stiffness of each."""

    count: int
    quantities: ClassVar[tuple[str, ...]] = (
        *LoadHistory.quantities,
        "energy_per_cycle",
        "secant_stiffness",
    )

    @cached_property
    def energy_per_cycle(self) -> Array:
        """Energy dissipated in each cycle, the area of its loop [force length]."""
        return np.asarray(self._by_cycle(self.dissipation).sum(axis=1))

    @cached_property
    def secant_stiffness(self) -> Array:
        """(F_max - F_min)/(u_max - u_min) of each loop [force/length], infinite at constant u."""
        force = self._turning_points(self.tangential_force)
        displacement = self._turning_points(self.tangential_displacement)
        return np.asarray(np.ptp(force, axis=1) / np.ptp(displacement, axis=1))

    def _by_cycle(self, values: Array) -> Array:
        """Values in rows, one for each cycle from upper turning point to upper turning point."""
        return values[2 * self.path.per_step :].reshape(self.count, -1)

    def _turning_points(self, values: Array) -> Array:
        """Values at the turning points of each cycle."""
        return self._by_cycle(values)[:, self.path.per_step - 1 :: self.path.per_step]


def cycles(
    profile: Profile,
    e_star: float | Material,
    g_star: float | Material | None,
    friction_coefficient: float,
    *,
    indentation_depth: float | None = None,
    normal_force: float | None = None,
    normal_amplitude: float = 0.0,
    tangential_displacement: float | None = None,
    tangential_force: float | None = None,
    count: int = 1,
    samples_per_step: int | None = None,
) -> LoadCycles:
    """Return cycles of tangential load, the normal load constant or in phase with it.

    The path leads from the mean normal load to the upper turning point (mean + normal amplitude, +
    amplitude), then `count` times to the lower turning point (mean - normal amplitude, - amplitude)
    and back.

    Source: mdr-5, Eqs. (5.19), (5.20), (5.71); physics of the loop: notes, §10.

    Parameters
    ----------
    profile, e_star, g_star, friction_coefficient : as for `solve`.
    indentation_depth, normal_force : exactly one, the mean [length], [force].
    normal_amplitude : amplitude of the normal load [length], [force], >= 0, at most the mean.
    tangential_displacement, tangential_force : exactly one, the amplitude [length], [force].
    count : number of cycles.
    samples_per_step : evenly spaced samples on each of the 2 + 2 `count` load steps; by default
        20 where controls of different pairs both oscillate, else 1.

    Returns
    -------
    The results at the samples of all load steps, and the energy and stiffness of each cycle.

    Raises
    ------
    InputError : as for `solve`, and a normal amplitude outside 0 to the mean.
    AccuracyError : a tangential load below the rounding error of the normal load.

    Examples
    --------
    Mindlin and Deresiewicz' loop with F_x = mu F_N/2 on a sphere.

    >>> from mdr_core.profiles import Paraboloid
    >>> loop = cycles(Paraboloid(1.0), 1.0, 1.0, 0.1, normal_force=4 / 3,
    ...               tangential_force=0.2 / 3)
    >>> rho = 0.5
    >>> factor = 1 - (1 - rho) ** (5 / 3) - 5 / 6 * rho * (1 + (1 - rho) ** (2 / 3))
    >>> bool(abs(loop.energy_per_cycle[0] / (18 / 5 * (4 / 30) ** 2 * factor) - 1) < 1e-12)
    True
    """
    require_whole(("history", "count"), count)
    normal_loads = {"indentation_depth": indentation_depth, "normal_force": normal_force}
    tangential_loads = {
        "tangential_displacement": tangential_displacement,
        "tangential_force": tangential_force,
    }
    normal, given_mean = only_one(("history", "normal"), normal_loads)
    tangential, tangential_amplitude = only_one(("history", "tangential"), tangential_loads)
    amplitude = single(("history", "normal", "amplitude"), normal_amplitude)
    if samples_per_step is None:
        samples_per_step = default_samples(normal, tangential) if amplitude else 1
    mean = single(("history", "normal", normal), given_mean)
    if not 0 <= amplitude <= mean:
        raise InputError(("history", "normal", "amplitude"), "must lie between 0 and the mean")
    if count < 1:
        raise InputError(("history", "count"), "must be at least 1")
    phase = np.append([0.0, 1.0], np.tile([-1.0, 1.0], count))
    points = single(("history", "tangential", tangential), tangential_amplitude) * phase
    loads: dict[str, Any] = {normal: mean + amplitude * phase, tangential: points}
    contact = profile, e_star, g_star, friction_coefficient
    history = solve(*contact, **loads, samples_per_step=samples_per_step)
    found = LoadCycles(history.path, e_star, history.before, count)
    if found.rounding > UNRESOLVED:
        detail = (
            "the tangential load is lost in the rounding errors of the normal load: increase it"
        )
        raise AccuracyError(detail, ("cycles", "tangential"))
    return found
