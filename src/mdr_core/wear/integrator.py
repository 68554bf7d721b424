"""Implicit integration of the worn annulus over the cycles, with steps as long as wear allows."""

import warnings
from collections.abc import Callable
from math import inf, isfinite
from typing import Any, Final, cast

import numpy as np
from scipy.integrate import solve_ivp

from mdr_core.errors import AccuracyError, InputError
from mdr_core.typing import Array
from mdr_core.wear.annulus_state import AnnulusState
from mdr_core.wear.initial_state import InitialState
from mdr_core.wear.rates import jacobian, rates
from mdr_core.wear.worn_surface import WornSurface

# Absolute tolerance, over `rtol` times the wear of the first cycles. A larger one leaves errors
# above the pressure at which wear counts as ended.
_ABSOLUTE: Final = 0.01
# Slip over the largest slip, down to which the tolerance is relative to the slip itself. A growing
# stick zone erases smaller slip before it matters.
_LEAST_SLIP: Final = 0.01
# Scaled cycles below which the integrator's first step underflows.
_FIRST: Final = 1e-100
# Relative distance at which an edge has reached a place: a slope jump, or the flat or the axis,
# where full slip begins.
_REACHED: Final = 1e-3
# Maximum number of rate evaluations, three seconds. A constant depth and a constant force amplitude
# take up to 7,500 at a tolerance of 1e-9, the equator of a sphere 4,700.
_MAX_CALLS: Final = 10_000
# Largest tolerance times the square of the number of nodes, by which the pressure amplifies errors
# of the wear: from about 0.6 on it may turn negative, and the steps stall.
_LOOSEST: Final = 0.2


def integrate(initial: InitialState, cycles: Array, rtol: float) -> WornSurface:
    """Return the worn contact at ascending numbers of cycles, and when wear stopped.

    This number is infinite if wear goes on. The pressure in the annulus decays within a few units
    of scaled cycles. Once it is below `rtol` everywhere, the state is constant. Source: notes, §11.

    Raises InputError if the contact reaches the end of the profile, or full slip begins or ends,
    and AccuracyError if the integrator fails or takes too many steps, or the contact grows too far.
    """
    start, no_trail = initial.vector, np.empty((2, 0, cycles.size))
    if not initial.slips or not cycles[-1]:
        states = np.repeat(start[:, None], cycles.size, axis=1)
        return WornSurface(initial, states, no_trail, cycles=cycles)
    rtol = min(rtol, _LOOSEST / initial.maps.squares.size**2)
    unit, scaled = initial.cycle_unit, cycles / initial.cycle_unit
    if initial.growth_to_end <= 0:
        # An event is a change of sign, which comes too late here.
        _require_all_cycles(initial, cycles, 0.0, inf)
    first = float(scaled[scaled > 0][0])
    if first < _FIRST:
        detail = "the wear in so few cycles is too small to be resolved: request more cycles"
        raise AccuracyError(detail, ("cycles",))
    calls = 0

    def counted(time: float, vector: Array) -> Array:
        nonlocal calls
        calls += 1
        if calls > _MAX_CALLS:
            raise _unresolved(AnnulusState(initial, vector[:, None]), time, "a looser")
        return rates(initial, vector)

    # An error below reports a failure of LSODA: its warning would repeat it.
    with np.errstate(all="ignore"), warnings.catch_warnings(action="ignore"):
        run = solve_ivp(
            counted,
            (0.0, float(scaled[-1])),
            start,
            method="LSODA",
            dense_output=True,
            rtol=rtol,
            atol=_ABSOLUTE * rtol * min(first, 1.0) * _scale(initial),
            jac=lambda _time, vector: jacobian(initial, vector),
            events=_events(initial, rtol),
        )
    if run.status < 0 or not np.isfinite(run.y).all():
        resolved = np.flatnonzero(np.isfinite(run.y).all(axis=0))[-1:]
        state = AnnulusState(initial, run.y[:, resolved])
        raise _unresolved(state, run.t[resolved].item(), "a tighter")
    ends = (float(times[0]) * unit if times.size else inf for times in run.t_events or ())
    profile_end_at, settled_at, changed_at = ends
    _require_all_cycles(initial, cycles, profile_end_at, changed_at)
    numbers, between = np.minimum(scaled, run.t[-1]), cast("Any", run.sol)
    states, trail = np.where(numbers > 0, between(numbers), start[:, None]), no_trail
    if initial.stick_grows:
        known, last = AnnulusState(initial, run.y), AnnulusState(initial, states)
        trail = np.where(
            (run.t < numbers[:, None]).T,
            np.stack([known.stick_radius, known.retained_wear])[:, :, None],
            np.stack([last.stick_radius, last.retained_wear])[:, None],
        )
    return WornSurface(initial, states, trail, settled_at=settled_at, cycles=cycles)


def _unresolved(state: AnnulusState, scaled: float, other: str) -> AccuracyError:
    """Return the error for the last state that is resolved, at a scaled number of cycles.

    `other` is the kind of tolerance that may help.
    """
    initial = state.initial
    stick, edge = state.stick_radius.item(), state.x[-1].item()
    jumps = np.array(initial.normal.profile.infinite_pressure_radii)
    room = _REACHED * edge
    inside = jumps[(jumps > max(stick - room, 0.0)) & (jumps < edge + room)]
    if not inside.size:
        detail = f"the wear over the cycles is not resolved: more nodes or {other} rtol may help"
        return AccuracyError(detail, ("resolution",))
    passes = initial.stick_moves and abs(inside[0] - stick) < room
    detail = (
        f"after about {scaled * initial.cycle_unit:.2g} cycles the {'stick' if passes else 'worn'} "
        f"{'edge moves past' if passes else 'annulus contains'} radius {inside[0]:.6g}, where a "
        f"jump of the profile's slope is not resolved: request fewer cycles or {other} rtol, or "
        "round the profile there"
    )
    return AccuracyError(detail, ("cycles",))


def _require_all_cycles(
    initial: InitialState, cycles: Array, profile_end_at: float, changed_at: float
) -> None:
    """Raise an error if the integration has ended before the last of the cycles."""
    if isfinite(profile_end_at):
        if initial.largest_growth < initial.growth_to_end:
            detail = "the contact grows beyond the range of this method"
            raise AccuracyError(detail, ("cycles",))
        raise InputError(
            ("cycles", int(np.searchsorted(cycles, profile_end_at))),
            f"after about {profile_end_at:.2g} cycles the worn contact reaches radius "
            f"{initial.domain:.6g}, where the profile ends or is no longer admissible",
        )
    if isfinite(changed_at):
        detail = (
            "full slip begins: wear at this depth reduces the normal force until it no longer "
            "carries the tangential force"
        )
        if initial.full_slip:
            detail = "the axis sticks, which this method does not follow: increase the amplitude"
        where = ("cycles", int(np.searchsorted(cycles, changed_at)))
        raise InputError(where, f"after about {changed_at:.2g} cycles {detail}")


def _scale(initial: InitialState) -> Array:
    """Return the sizes of the changes of the vector due to wear."""
    inner = initial.maps.squares.size - 1
    slip = AnnulusState(initial, initial.vector[:, None]).slip[:-1] / initial.units[:inner]
    found = np.full(initial.units.size, initial.length_unit / float(initial.normal.contact_radius))
    found[:inner] = np.maximum(slip[:, 0], _LEAST_SLIP)
    # In full slip the depth that can wear off is a part of the slip.
    found *= initial.step / initial.depth_unit
    # In a narrow annulus only b changes as a whole, the others by the fraction b_0/a_0.
    found[inner] = 1.0
    return found


def _events(initial: InitialState, rtol: float) -> list[Any]:
    """Return the events that end the integration.

    They are the profile's end, no more wear, and the beginning or the end of full slip.
    """
    flat = float(initial.normal.profile.first_radius)
    vanished = flat + _REACHED * (initial.stick - flat)

    def settling(state: AnnulusState) -> Array:
        if initial.full_slip and initial.constant_force:
            return np.ones(1)
        # The work of a cycle is of the order of the square of the pressure.
        return state.end * state.stress.max() - rtol * state.reduced_amplitude

    def changing(state: AnnulusState) -> Array:
        if initial.full_slip:
            return state.slip.min(axis=0)
        return state.stick_radius - vanished if initial.stick_shrinks else np.ones(1)

    def event(function: Callable[[AnnulusState], Array]) -> Any:
        def value(_time: float, vector: Array) -> float:
            return float(function(AnnulusState(initial, vector[:, None])).item())

        value.terminal = True  # type: ignore[attr-defined]  # read by `solve_ivp`
        return value

    return [
        event(lambda state: state.growth - initial.largest_growth),
        event(settling),
        event(changing),
    ]
