"""Implicit integration of the worn annulus over the cycles, with steps as long as wear allows."""

import warnings
from collections.abc import Callable, Iterator
from math import inf
from typing import Any, Final, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from mdr_core.errors import AccuracyError
from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusModel, AnnulusState
from mdr_core.wear.rates import jacobian, rates

# Absolute tolerance, as a part of the relative one and of the wear so far.
_ABSOLUTE: Final = 0.01
# Part of the largest slip up to which the tolerance of the slip is a part of itself: where there is
# less, a growing stick zone takes it back before it counts.
_MIN_SLIP: Final = 0.01
# The wear of the first cycles has a separate tolerance in each such factor of cycles.
_DECADE: Final = 10.0
# Scaled cycles below which the integrator's first step underflows.
_FIRST: Final = 1e-100
# About 5 times as many as 96 nodes take at a tolerance of 1e-10.
_MAX_CALLS: Final = 40_000


class StickTrail(NamedTuple):
    """Radii that a growing stick zone has passed, and the wear w_c that the springs there keep."""

    radius: Array
    worn: Array

    def until(self, state: AnnulusState) -> "StickTrail":
        """Return the part that the stick edge has passed in one state."""
        # While the stick edge rests, the wear at its radius grows.
        rests = (self.radius == state.stick) & (self.worn <= state.retained_wear)
        before = (self.radius < state.stick) | rests
        return StickTrail(
            np.append(self.radius[before], state.stick),
            np.append(self.worn[before], state.retained_wear),
        )

    @property
    def steps(self) -> tuple[Array, Array]:
        """Middle radii of the intervals, and the steps of w_c over them."""
        return (self.radius[1:] + self.radius[:-1]) / 2, np.diff(self.worn)


NO_TRAIL: Final = StickTrail(np.empty(0), np.empty(0))


class Integration(NamedTuple):
    """States at the requested cycles, and the trail of the stick edge."""

    states: tuple[AnnulusState, ...]
    trail: StickTrail
    settled_at: float
    """Scaled cycles from which on nothing wears, infinite if these were not reached."""
    profile_end_at: float
    """Scaled cycles at which the contact reaches the end of the profile, or infinity."""
    full_slip_at: float
    """Scaled cycles at which the stick zone vanishes, or infinity."""


def integrate(
    model: AnnulusModel, cycles: Array, rtol: float, ends: tuple[float, float]
) -> Integration:
    """Return the states of the annulus at ascending numbers of cycles.

    The pressure in the annulus decays within some units of scaled cycles. Once it is below `rtol`
    everywhere, the state stays as it is, whatever the number of cycles. Source: notes, §11.

    Parameters
    ----------
    model : rates of wear.
    cycles : scaled numbers of cycles, ascending, (k,).
    rtol : relative tolerance.
    ends : growth of the contact, and stick radius, at which the integration ends; in its unit.

    Raises
    ------
    AccuracyError : the integrator failed, or takes too many steps.
    """
    first = cycles[cycles > 0][:1]
    if first.size and first[0] < _FIRST:
        detail = "so few cycles wear less than the integrator can resolve"
        raise AccuracyError(detail, ("cycles",))
    calls = 0

    def counted(_time: float, vector: Array) -> Array:
        nonlocal calls
        calls += 1
        if calls > _MAX_CALLS:
            detail = "the wear over the cycles takes too many steps: fewer nodes may take less"
            raise AccuracyError(detail, ("resolution",))
        return rates(model, vector)

    vector, now, stopped = model.start, 0.0, [inf, inf, inf]
    steps, states = [vector], []
    for halt in _halts(cycles):
        # A failure of LSODA is reported by an error below, not by a warning.
        with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
            run = solve_ivp(
                counted,
                (now, halt),
                vector,
                method="LSODA",
                dense_output=True,
                rtol=rtol,
                atol=_ABSOLUTE * rtol * min(halt, 1.0) * _scale(model),
                jac=lambda _time, vector: jacobian(model, vector),
                events=_events(model, rtol, ends),
            )
        if run.status < 0 or not np.isfinite(run.y).all():
            detail = "the wear over the cycles is not resolved: more nodes may resolve it"
            raise AccuracyError(detail, ("resolution",))
        last = float(run.t[-1])
        between: Any = run.sol
        states += [between(number) for number in cycles[(cycles > now) & (cycles <= last)]]
        steps += [*run.y.T[1:]]
        vector, now = run.y[:, -1], last
        stopped = [now if times.size else inf for times in run.t_events or ()]
        if run.status:
            break
    states = [model.start] * int((cycles == 0).sum()) + states
    # Nothing wears from where it ended on.
    states += [vector] * (cycles.size - len(states))
    profile_end_at, settled_at, full_slip_at = stopped
    trail = _trail(model, steps)
    ended = tuple(AnnulusState(model, v) for v in states)
    return Integration(ended, trail, settled_at, profile_end_at, full_slip_at)


def _halts(cycles: Array) -> Iterator[float]:
    """Yield the scaled cycles at which the absolute tolerance changes, and the last."""
    last = float(cycles[-1])
    halt = float(cycles[cycles > 0][0]) if last > 0 else 1.0
    # An interval as short as the rounding error of its end is not integrated.
    while halt < min(last / 2, 1.0):
        yield halt
        halt *= _DECADE
    if last > 0:
        yield last


def _scale(model: AnnulusModel) -> Array:
    """Return the sizes of the changes of the vector by wear."""
    edge = model.first_edge
    # In a narrow annulus all but b and the work change by a part b_0/a_0 only.
    scale = np.full(model.start.size, 1 / (model.first_stick + model.first_width))
    scale[:edge] = np.maximum(AnnulusState(model, model.start).slip[:-1], _MIN_SLIP)
    scale[[edge, edge + 3]] = 1.0
    return scale


def _events(model: AnnulusModel, rtol: float, ends: tuple[float, float]) -> list[Any]:
    """Return the events that end the integration, in the order of `Integration`."""
    latest = AnnulusState(model, model.start)

    def event(function: Callable[[AnnulusState], float]) -> Any:
        def value(_time: float, vector: Array) -> float:
            nonlocal latest
            # All events of a step are evaluated for one vector.
            if latest.vector is not vector:
                latest = AnnulusState(model, vector)
            return function(latest)

        value.terminal = True  # type: ignore[attr-defined]  # read by `solve_ivp`
        return value

    return [
        event(lambda state: state.growth - ends[0]),
        # The work of a cycle is of the order of the square of the pressure.
        event(lambda state: state.end * state.pressure.max() - rtol * state.reduced_amplitude),
        event(lambda state: state.stick - ends[1]),
    ]


def _trail(model: AnnulusModel, steps: list[Array]) -> StickTrail:
    """Return the trail of a growing stick zone."""
    if not model.constant.stick_grows:
        return NO_TRAIL
    states = [AnnulusState(model, vector) for vector in steps]
    return StickTrail(
        np.array([state.stick for state in states]),
        np.array([state.retained_wear for state in states]),
    )
