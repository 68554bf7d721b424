"""The worn annulus over the cycles: an implicit integrator that steps as far as the wear allows."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf, isinf

import numpy as np
from scipy.integrate import solve_ivp

from mdr_core.errors import AccuracyError
from mdr_core.typing import Array
from mdr_core.wear.rates import State, System

# Absolute tolerances, in parts of the relative one and of what has worn by the first answer.
_ABSOLUTE = 0.01
# Answers within so large a factor of cycles share one run, and so one absolute tolerance.
_DECADE = 10.0

# Cycles nearer than this part to their goal have reached it: no step is so short.
_SPAN = 1e-9
# Scaled cycles below which the integrator's first step is no double.
_FIRST = 1e-100
# Some times what the finest resolution takes at the tightest tolerance in use.
_MOST_CALLS = 40_000

Progress = Callable[[int], None]
"""Is told of values of the profile's g each time some have been asked for."""


@dataclass(frozen=True)
class Trail:
    """Where the stick edge has been, and what the springs it passed keep of their wear, w_c."""

    radius: Array
    worn: Array

    def until(self, state: State) -> "Trail":
        """The part that a moment has behind it: at a resting edge w_c goes on rising."""
        before = self.radius <= state.stick
        return Trail(
            np.append(self.radius[before], state.stick),
            np.append(self.worn[before], _passed(state)),
        )

    @property
    def steps(self) -> tuple[Array, Array]:
        """Radii and steps of w_c between the points."""
        return (self.radius[1:] + self.radius[:-1]) / 2, np.diff(self.worn)


@dataclass(frozen=True)
class Course:
    """The states at the asked cycles, and the trail of the stick edge."""

    states: tuple[State, ...]
    trail: Trail
    settled: float
    """Scaled cycles from which on nothing wears any more, infinite if that was not reached."""
    left: float
    """Scaled cycles at which the contact reached the end of the shape, infinite if it did not."""


def course(
    system: System, cycles: Array, rtol: float, stop: float, progress: Progress | None = None
) -> Course:
    """Return the course over ascending scaled cycles, up to contact radius `stop`.

    The annulus relaxes to a state without pressure in a few units of scaled cycles; once all
    pressure is below `rtol` the wear that is left is too, whatever the number of cycles.

    Source: notes, §11.
    """
    run = _Run(system, rtol, stop, progress)
    states = {}
    for number in np.unique(cycles):
        states[float(number)] = State(system, run.to(float(number)))
    trail = np.array(run.trail) if run.trail else np.empty((0, 2))
    return Course(
        tuple(states[float(number)] for number in cycles),
        Trail(trail[:, 0], trail[:, 1]),
        run.settled,
        run.left,
    )


@dataclass(frozen=True)
class _Event:
    """Ends a run where the function of the state passes zero."""

    function: Callable[[Array], float]
    terminal: bool = True

    def __call__(self, _time: float, vector: Array) -> float:
        return self.function(vector)


class _Run:
    """The integration as far as it has come."""

    def __init__(self, system: System, rtol: float, stop: float, progress: Progress | None) -> None:
        self.system, self.rtol, self.stop, self.progress = system, rtol, stop, progress
        vector = self.vector = system.start
        self.moving = system.control.stick_moves
        self.now = 0.0
        self.settled = self.left = inf
        self.trail: list[tuple[float, float]] = []
        self._note(vector)
        edge = float(State(system, vector).x[-1])
        self.scale = np.ones(vector.size)
        # In a narrow annulus all but its own width and the work change that much less.
        inner = system.maps.zeta.size - 1
        self.scale[:] = 1 / edge
        self.scale[[inner, inner + 3]] = 1.0
        self.calls, self.nodes = 0, inner + 1

    def to(self, goal: float) -> Array:
        """Go on to the goal and return the state there."""
        if 0 < goal < _FIRST:
            detail = "so few cycles wear less than the integrator can tell from none"
            raise AccuracyError(detail, ("cycles",))
        while goal - self.now > _SPAN * goal and isinf(self.settled) and isinf(self.left):
            # What little has worn after few cycles is to have digits of its own.
            end = min(goal, _DECADE * self.now) if 0 < self.now < 1 else goal
            self._advance(end, min(end, 1.0))
        return self.vector

    def _advance(self, end: float, worn: float) -> None:
        events = [_Event(self._beyond), _Event(self._loud)]
        if self.moving:
            events.append(_Event(self.system.settling))
        with np.errstate(over="ignore", invalid="ignore"):
            found = solve_ivp(
                partial(self._rates, moving=self.moving),
                (self.now, end),
                self.vector,
                method="LSODA",
                rtol=self.rtol,
                atol=_ABSOLUTE * self.rtol * worn * self.scale,
                events=events,
            )
        if found.status < 0 or not np.isfinite(found.y[:, -1]).all():
            raise AccuracyError(f"the wear over the cycles was not resolved: {found.message}")
        if self.moving:
            for column in found.y.T[1:]:
                self._note(column)
        self.vector, self.now = found.y[:, -1], float(found.t[-1])
        left, settled, *stopped = (times.size > 0 for times in found.t_events or ())
        self.left = self.now if left else inf
        self.settled = self.now if settled else inf
        self.moving = self.moving and not any(stopped)

    def _note(self, vector: Array) -> None:
        if self.system.control.stick_moves:
            state = State(self.system, vector)
            self.trail.append((state.stick, _passed(state)))

    def _rates(self, _time: float, vector: Array, *, moving: bool) -> Array:
        self.calls += 1
        if self.progress:
            self.progress(self.nodes)
        if self.calls > _MOST_CALLS:
            raise AccuracyError(
                "the wear over the cycles was not resolved: the integration takes too many steps"
            )
        return self.system.rates(vector, moving=moving)

    def _loud(self, vector: Array) -> float:
        """Negative once the pressure's work is below rounding at this tolerance."""
        state = State(self.system, vector)
        largest = float(np.abs(state.smooth_pressure * self.system.root).max())
        return largest - self.rtol * state.drive

    def _beyond(self, vector: Array) -> float:
        return float(State(self.system, vector).x[-1]) - self.stop


def _passed(state: State) -> float:
    """w_c = g(c) - g_0(c) of a stick edge that moves under a held displacement."""
    rise = state.system.shape.rise(np.array([state.stick]))
    return state.risen - float(rise[0])
