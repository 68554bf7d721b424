"""Normal force at which yield begins, and the loads under which a contact has yielded."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from math import exp, inf, isfinite, log, nan
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from scipy.optimize import brentq

from mdr_core import normal, tangential
from mdr_core.broadcasting import with_parameters
from mdr_core.errors import InputError
from mdr_core.history import ContactState, LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Paraboloid, Power
from mdr_core.subsurface.foundation import shape_of
from mdr_core.subsurface.peaks import MEASURES, largest
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags, Parameter
from mdr_core.validation import require_positive
from mdr_core.validity import ASSUMED_RATIO, Finding, infinite_deviator

# Refinements of the grid at the onset.
_ROUNDS: Final = 5
# Accuracy of the contact coordinate's logarithm there.
_ONSET_RTOL: Final = 1e-6
# Steps of that logarithm by which the onset is bracketed, and the largest distance.
_STEP, _REACH = 2.0, 60.0
# Refinements of the grid where only the excess over the yield strength matters: to 1e-4.
_FEW_ROUNDS: Final = 3
# Ratio of the forces from which a contact counts as being in full slip.
_SLIDES: Final = 1 - 1e-12

_Contact: TypeAlias = NormalContact | TangentialContact


def yield_onset_force(
    contact: _Contact,
    yield_strength: float,
    measure: str = "von_mises",
    *,
    poissons_ratio: float,
    body: int = 1,
) -> Array:
    """Return the normal force at which yield begins, in the ratio F_x/F_N of each load [force].

    Yield begins where the von Mises stress reaches the yield strength, or the largest shear stress
    half of it (Tresca). The force is 0 where the stress is infinite under any load, and inf where
    no load up to the end of the profile reaches it.

    Source: johnson, section 4.2; notes, §14.

    Parameters
    ----------
    yield_strength : in uniaxial tension [pressure].
    contact, measure, poissons_ratio, body : see `largest`.

    Raises
    ------
    InputError : another measure, no load, or a yield strength that is not positive.

    Examples
    --------
    Hertz' contact, nu = 0.3: p_0 = 1.61 Y, Johnson's Eq. (4.10).

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> force = yield_onset_force(contact, 0.01, "maximum_shear", poissons_ratio=0.3)
    >>> p0 = float(solve(Paraboloid(2.0), 3.0, normal_force=force).maximum_pressure)
    >>> round(p0 / 0.01, 3)
    1.613
    """
    require_positive(("yield_strength",), yield_strength)
    if measure not in MEASURES:
        raise InputError(("measure",), f"must be one of {', '.join(MEASURES)}")
    limit = yield_strength if measure == "von_mises" else yield_strength / 2
    options = {"measure": measure, "poissons_ratio": poissons_ratio, "body": body}
    found = [_onset(case, limit, options) for case in _cases(contact)]
    return np.array(found).reshape(shape_of(contact))


def yielding(
    contact: _Contact | LoadHistory, poissons_ratios: tuple[float, ...], yield_strength: float
) -> Finding:
    """Return `yield`: loads under which a body has yielded by Tresca's criterion.

    The largest stress grows with the load, and with the ratio of the forces. Along a load history
    the forces of every sample count as applied once; at its end the traction is that of the path.

    Source: johnson, section 4.2; notes, §14.

    Parameters
    ----------
    contact : a contact under any loads, or a load history.
    poissons_ratios : of the elastic bodies; empty if they are unknown, 0.3 is assumed then.
    yield_strength : of the softer body, in uniaxial tension [pressure].
    """
    ratios, normal = poissons_ratios or (ASSUMED_RATIO,), _pressed(contact)
    sheared = not isinstance(contact, NormalContact) and bool(np.any(contact.tangential_force))
    exponent: Parameter | None = {Cone: 1.0, Paraboloid: 2.0}.get(type(normal.profile))
    if isinstance(normal.profile, Power):
        exponent = normal.profile.exponent
    if exponent is not None and not sheared:
        factor = np.max([_similar(nu)(np.asarray(exponent)) for nu in ratios], axis=0)
        where = normal.loaded & (2 * factor * normal.mean_pressure >= yield_strength)
    else:
        cases = _cases(contact)
        flags, groups = np.zeros(len(cases), dtype=bool), dict[tuple[float, ...], list[int]]()
        for i, case in enumerate(cases):
            if case.normal.loaded:
                groups.setdefault(case.body, []).append(i)
        for index in groups.values():
            _mark(flags, index, cases, ratios, yield_strength)
        if isinstance(contact, LoadHistory) and not flags[-1]:
            flags[-1] = _reaches(contact.state, ratios, yield_strength)
        where = flags.reshape(_ratio(contact).shape)

    def message() -> str:
        least = float(np.min(np.broadcast_to(normal.normal_force, where.shape)[where]))
        return f"the stresses meet Tresca's criterion under a normal force of {least:.4g}"

    return Finding("yield", where, message)


class _Case(NamedTuple):
    """A contact under a single load."""

    normal: NormalContact
    ratio: float
    """|F_x|/(mu F_N) [1]."""
    friction: float
    body: tuple[float, ...]
    """Friction, E* and parameters of the profile, by which cases differ beside their loads."""

    def under(self, coordinate: float, ratio: float) -> _Contact:
        """Return the contact under another load, of this contact coordinate and ratio."""
        pressed = replace(self.normal, coordinate=np.asarray(coordinate))
        if ratio == 0:
            return pressed
        # The stresses depend on the ratio of the forces alone, not on G*.
        moduli = self.normal.e_star, self.friction
        if ratio > _SLIDES:
            beyond = 2 * self.friction * pressed.indentation_depth
            return tangential.solve(pressed, *moduli, tangential_displacement=beyond)
        force = ratio * (self.friction * pressed.normal_force)
        return tangential.solve(pressed, *moduli, tangential_force=force)


def _cases(contact: _Contact | LoadHistory) -> list[_Case]:
    normal, names = _pressed(contact), _pressed(contact).profile.swept
    start = contact.start if isinstance(contact, LoadHistory) else contact
    friction = 0.0 if isinstance(start, NormalContact) else start.friction_coefficient
    swept = [normal.profile.parameters[name] for name in names]
    columns = normal.coordinate, _ratio(contact), friction, normal.e_star, *swept
    found = []
    for row in zip(*(part.ravel().tolist() for part in np.broadcast_arrays(*columns)), strict=True):
        coordinate, ratio, *body = row
        profile = with_parameters(normal.profile, dict(zip(names, body[2:], strict=True)))
        own = replace(normal, profile=profile, e_star=body[1], coordinate=np.asarray(coordinate))
        found.append(_Case(own, ratio, body[0], tuple(body)))
    return found


def _ratio(contact: _Contact | LoadHistory) -> Array:
    """|F_x|/(mu F_N) under each load [1], of the shape of the loads."""
    if isinstance(contact, NormalContact):
        return np.zeros(contact.coordinate.shape)
    start = contact.start if isinstance(contact, LoadHistory) else contact
    limit = start.friction_coefficient * _pressed(contact).normal_force
    ratio = np.abs(contact.tangential_force) / np.where(limit > 0, limit, 1.0)
    return np.where(contact.regime == "full_slip", 1.0, ratio)


def _mark(
    flags: Flags, index: list[int], cases: list[_Case], ratios: tuple[float, ...], strength: float
) -> None:
    """Set the flags of cases that yield, which differ in load alone, by bisection of the loads."""
    places = np.array([(float(cases[i].normal.coordinate), cases[i].ratio) for i in index]).T

    def reaches(place: Array) -> bool:
        return _reaches(cases[index[0]].under(*place.tolist()), ratios, strength)

    low, high = places.min(axis=1), places.max(axis=1)
    if not reaches(high):
        return
    if np.array_equal(low, high) or reaches(low):
        flags[index] = True
        return
    order = np.argsort(places[0] if low[0] < high[0] else places[1], kind="stable")
    for half in np.array_split(order, 2):
        _mark(flags, [index[i] for i in half], cases, ratios, strength)


def _reaches(contact: _Contact | ContactState, ratios: tuple[float, ...], strength: float) -> bool:
    """Return whether the largest shear stress in a body reaches half of the yield strength."""
    given: dict[str, Any] = {"rounds": _FEW_ROUNDS, "limit": strength / 2}
    peaks = (largest(contact, MEASURES[1], poissons_ratio=nu, **given) for nu in ratios)
    return any(peak.value >= strength / 2 for peak in peaks)


@lru_cache(maxsize=64)
def _similar(poissons_ratio: float) -> Any:
    """Largest shear stress over the mean pressure under a power, by its exponent, vectorised."""

    @lru_cache(maxsize=256)
    def factor(exponent: float) -> float:
        contact = normal.solve(Power(1.0, exponent), 1.0, contact_radius=1.0)
        peak = largest(contact, "maximum_shear", poissons_ratio=poissons_ratio)
        return float(peak.value / contact.mean_pressure)

    return np.vectorize(factor, otypes=[float])


def _onset(case: _Case, limit: float, options: dict[str, Any]) -> float:
    """Normal force at which a measure reaches a limit, the ratio of the loads held constant."""
    profile, start, ratio = case.normal.profile, float(case.normal.coordinate), case.ratio
    if not case.normal.loaded:
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    slips_from, ratios = (0.0 if ratio > _SLIDES else inf), (options["poissons_ratio"],)
    singular = [
        float(np.asarray(b))
        for b in profile.infinite_pressure_radii
        if infinite_deviator(profile, b, ratios, slips_from)
    ]
    first = min(singular, default=inf)
    if first <= profile.contact_radius(np.zeros(())):
        return 0.0

    def force(coordinate: float) -> float:
        return float(_pressed(case.under(coordinate, 0.0)).normal_force)

    def excess(place: float) -> float:
        with np.errstate(all="ignore"):
            contact = case.under(exp(place), ratio)
            value = float(largest(contact, rounds=_ROUNDS, **options).value)
        return log(value / limit) if value > 0 else nan

    if isinstance(profile, Cone):
        # The largest stress is that of any load.
        return 0.0 if excess(log(start)) >= 0 else inf
    end = profile.last_coordinate or inf
    if first < inf:
        # At a slope discontinuity the stress is infinite.
        end = float(profile.coordinate_from_radius(np.asarray(first)))
    low, high = _bracket(excess, log(start), log(end) - _ONSET_RTOL)
    if low == -inf:
        return 0.0
    if high == inf:
        return force(end) if first < inf else inf
    return force(exp(brentq(excess, low, high, xtol=_ONSET_RTOL)))


def _bracket(excess: Callable[[float], float], start: float, last: float) -> tuple[float, float]:
    """Places up to the last one between which the excess changes its sign; infinite without."""
    place = min(start, last)
    above = excess(place) > 0
    while abs(place - start) < _REACH and (above or place < last):
        before, place = place, min(place + (-_STEP if above else _STEP), last)
        value = excess(place)
        if not isfinite(value):
            # Next to the equator of a body no double tells the contact from it.
            break
        if (value > 0) != above:
            return min(before, place), max(before, place)
    return (-inf, place) if above else (place, inf)


def _pressed(contact: _Contact | LoadHistory) -> NormalContact:
    if isinstance(contact, NormalContact):
        return contact
    return contact.contact if isinstance(contact, LoadHistory) else contact.normal
