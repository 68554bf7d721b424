"""States of many contacts, for discrete elements, and one step of all of them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, overload

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.errors import InputError
from mdr_core.history import slip_memory
from mdr_core.history.contact_state import ContactState, LoadPointResults
from mdr_core.history.slip_memory import read_only
from mdr_core.history.tractions import REGIMES, decides_regime, regime_codes
from mdr_core.materials import Material, modulus
from mdr_core.profiles import Profile
from mdr_core.typing import Array, Indices, Parameter
from mdr_core.validation import (
    as_numbers,
    as_positive,
    require_finite,
    require_inside,
    require_type,
)


@dataclass(frozen=True, repr=False, eq=False)
class ContactStates(LoadPointResults):
    """States of many contacts with profiles of one kind.

    `states[i]` is one of them as a `ContactState`; a mask, a slice or indices choose several.
    """

    regime_before: Indices
    """Index of the slip regime in `REGIMES` before that step."""
    quantities: ClassVar[tuple[str, ...]] = (*LoadPointResults.quantities, "regime")
    moduli: ClassVar[tuple[str, ...]] = ("e_star", "g_star", "friction_coefficient")

    def __len__(self) -> int:
        return self.polyline.ends.size

    @overload
    def __getitem__(self, index: int) -> ContactState: ...

    @overload
    def __getitem__(self, index: Any) -> "ContactStates": ...

    def __getitem__(self, index: Any) -> "ContactState | ContactStates":
        chosen: Any = np.arange(len(self))[index]
        rows = np.ravel(chosen)
        at = rows if chosen.ndim else chosen
        swept = {name: self.profile.parameters[name][at] for name in self.profile.swept}
        profile = self.profile.with_parameters(swept)
        moduli = (getattr(self, name) for name in self.moduli)
        e_star, g_star, friction = (each[at] if np.ndim(each) else each for each in moduli)
        given = profile, e_star, g_star, friction, self.polyline.at(rows), self.before.at(rows)
        if not chosen.ndim:
            return ContactState(*given)
        return ContactStates(*given, self.regime_before[rows])

    @cached_property
    def regime_codes(self) -> Indices:
        """Index of the slip regime in `REGIMES`."""
        codes, after = regime_codes(self.vertices), self.polyline.load_points
        known = decides_regime(codes, after[0], *(after - self.before.load_points))
        return np.where(known, codes, np.maximum(self.regime_before, codes > 0))

    @property
    def regime(self) -> "np.ndarray[Any, np.dtype[np.str_]]":
        """Slip regime: "no_contact", "stick", "partial_slip" or "full_slip"."""
        return np.array(REGIMES)[self.regime_codes]


def unloaded_many(
    profile: Profile,
    e_star: ArrayLike | Material,
    g_star: ArrayLike | Material | None,
    friction_coefficient: ArrayLike,
) -> ContactStates:
    """Return the states of many pairs of bodies before first contact, at zero displacement.

    Parameters
    ----------
    profile : profile of any kind; its parameters are numbers, or arrays of shape (n,).
    e_star, g_star : effective moduli [pressure], > 0, of all contacts or of shape (n,), or the
        material that has them, for each.
    friction_coefficient : mu [1], > 0, of all contacts or of shape (n,).

    Returns
    -------
    The states from which `advance_many` takes the first step; one without arrays.

    Raises
    ------
    InputError : values that are not positive and finite, or arrays of different lengths.

    Examples
    --------
    Hertz contacts of two radii: F_N = 4/3 E* sqrt(R d^3).

    >>> from mdr_core.profiles import Paraboloid
    >>> states = unloaded_many(Paraboloid([1.0, 4.0]), 1.0, 1.0, 0.5)
    >>> (advance_many(states, 0.09, 0.0).normal_force / 0.09**1.5).round(12).tolist()
    [1.333333333333, 2.666666666667]
    """
    require_type("profile", profile, Profile, "a profile such as Paraboloid([0.01, 0.02])")
    given: dict[tuple[str, ...], Any] = {
        ("material", "e_star"): modulus("e_star", e_star),
        ("material", "g_star"): modulus("g_star", g_star),
        ("friction_coefficient",): friction_coefficient,
    }
    given |= {("profile", name): profile.parameters[name] for name in profile.swept}
    (normal, shear, friction, *_), count = _per_contact(given)
    for path, value in given.items():
        as_positive(path, value)
    lines = slip_memory.separated(np.zeros((2, count)))
    return ContactStates(profile, normal, shear, friction, lines, lines, lines.ends)


def advance_many(
    states: ContactState | ContactStates,
    indentation_depth: ArrayLike,
    tangential_displacement: ArrayLike,
) -> ContactStates:
    """Return the exact states of many contacts after one straight step of each.

    Each contact has the results of `advance`, in at most a tenth of its time.

    Source: mdr-5, Eqs. (5.4)-(5.9); notes, §10.

    Parameters
    ----------
    states : states from `unloaded_many` or an earlier step, or one state for all contacts.
    indentation_depth : d of each contact after the step [length], shape (n,); <= 0 in separation.
    tangential_displacement : u_x of each contact after the step [length], shape (n,).

    Returns
    -------
    The new states; the given ones are not changed.

    Raises
    ------
    InputError : numbers that are not finite, lengths that differ, or a depth beyond the end of the
        profile.

    Examples
    --------
    Cones at zero, half and full displacement at full slip: Eqs. (5.47), (5.49).

    >>> from mdr_core.history import unloaded
    >>> from mdr_core.profiles import Cone
    >>> states = advance_many(unloaded(Cone(0.1), 1.0, 1.0, 0.5), [2.0, 2.0, 2.0], 0.0)
    >>> states = advance_many(states, 2.0, [0.0, 0.5, 1.0])
    >>> (states.tangential_force / (0.5 * states.normal_force)).round(12).tolist()
    [0.0, 0.75, 1.0]
    """
    needed = "the states from advance_many or unloaded_many, or one state, as from history.unloaded"
    require_type("states", states, ContactState | ContactStates, needed)
    given: dict[tuple[str, ...], Any] = {
        ("indentation_depth",): indentation_depth,
        ("tangential_displacement",): tangential_displacement,
    }
    loads, count = _per_contact(given, len(states) if isinstance(states, ContactStates) else None)
    for path, values in zip(given, loads, strict=True):
        require_finite(path, values)
    if isinstance(states, ContactState):
        states = _repeated(states, count)
    profile = states.profile
    require_inside(("indentation_depth",), loads[0] > profile.largest_loads[0], profile)
    after = np.empty((2, count))
    after[0], after[1] = loads[0], loads[1] / states.displacement_ratio
    lines, codes = slip_memory.moved_each(states.polyline, read_only(after)), states.regime_codes
    return replace(states, polyline=lines, before=states.polyline, regime_before=codes)


def join(*states: ContactState | ContactStates) -> ContactStates:
    """Return the states of several sets of contacts as one set, in their order.

    Parameters, moduli and coefficients of friction may differ, but not a table or a series. Raises
    InputError without states, and for profiles of several kinds.

    Examples
    --------
    >>> from mdr_core.profiles import Paraboloid
    >>> states = [unloaded_many(Paraboloid(radius), 1.0, 1.0, 0.5) for radius in (1.0, 4.0)]
    >>> join(*states).profile.radius.tolist()
    [1.0, 4.0]
    """
    for each in states:
        require_type("states", each, ContactState | ContactStates, "states of contacts")
    many = [_repeated(each, 1) if isinstance(each, ContactState) else each for each in states]
    if not many:
        raise InputError(("states",), "at least one is needed")
    profile, sizes = many[0].profile, [len(each) for each in many]
    parameters = [each.profile.parameters for each in many]
    # A table has no parameters, and a series has parameters that are not numbers.
    numbers = parameters[0] and not any(isinstance(one, tuple) for one in parameters[0].values())
    for other in (each.profile for each in many):
        if other != profile if not numbers else type(other) is not type(profile):
            detail = f"a {profile.kind} and another {other.kind} cannot be joined"
            raise InputError(("states",), detail)
    if numbers:
        profile = profile.with_parameters(_joined(parameters, sizes))
    moduli = [{name: getattr(each, name) for name in ContactStates.moduli} for each in many]
    return ContactStates(
        profile=profile,
        polyline=slip_memory.joined([each.polyline for each in many]),
        before=slip_memory.joined([each.before for each in many]),
        regime_before=np.concatenate([each.regime_before for each in many]),
        **_joined(moduli, sizes),
    )


def _joined(values: Sequence[Mapping[str, Parameter]], sizes: Sequence[int]) -> dict[str, Any]:
    """Return values by name over all contacts; one that is common to them stays a number."""
    found = {}
    for name in values[0]:
        each = [given[name] for given in values]
        if any(map(np.ndim, each)) or len(set(each)) > 1:
            each = [np.concatenate(list(map(np.broadcast_to, each, sizes)))]
        found[name] = each[0]
    return found


def _per_contact(
    given: Mapping[tuple[str, ...], Any], count: int | None = None
) -> tuple[list[Array], int]:
    """Return values by path as numbers or arrays of one length, and the number of contacts."""
    values = [as_numbers(path, value) for path, value in given.items()]
    if count is None:
        count = next((value.size for value in values if value.ndim), 1)
    for path, value in zip(given, values, strict=True):
        if value.shape not in {(), (count,)}:
            raise InputError(path, f"must be one number, or one for each of {count} contacts")
    return values, count


def _repeated(state: ContactState, count: int) -> ContactStates:
    """Return copies of one state for several contacts."""
    lines = state.polyline.at(np.zeros(count, dtype=np.intp))
    moduli = {name: getattr(state, name) for name in ContactStates.moduli}
    codes = np.repeat(regime_codes(state.vertices), count)
    return ContactStates(state.profile, **moduli, polyline=lines, before=lines, regime_before=codes)
