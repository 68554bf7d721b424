"""Normal force at which yield begins, and the loads under which a contact has yielded."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, lru_cache
from math import exp, inf, isclose, log
from typing import Any, Final, TypeAlias

import numpy as np
from scipy.optimize import brentq

from mdr_core import normal, tangential
from mdr_core.errors import InputError
from mdr_core.history import LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Paraboloid, Power, Profile
from mdr_core.subsurface.annuli import Contact, normal_of, single
from mdr_core.subsurface.peaks import MEASURES, infinite_radii, largest
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import require_positive
from mdr_core.validity import ASSUMED_RATIO, Finding

# Accuracy of the stress at the onset, and of the contact coordinate's logarithm.
_ONSET_RTOL: Final = 1e-5
# Largest distance of that logarithm from the prescribed load.
_REACH: Final = 60.0
# Ratio of the forces that stands for full slip: but for a stick radius of 1e-4 a, it is.
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
    pressed, (columns, shape) = normal_of(contact), _columns(contact)
    if not np.all(pressed.loaded):
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    # Loads in one ratio of the forces share the onset.
    _, first, which = np.unique(columns[1:], axis=1, return_index=True, return_inverse=True)
    onset = [
        _onset(single(pressed, i, shape), columns[1, i], columns[2, i], limit, options)
        for i in first.tolist()
    ]
    return np.array(onset)[which].reshape(shape)


def yielding(
    contact: _Contact | LoadHistory, poissons_ratios: tuple[float, ...], yield_strength: float
) -> Finding:
    """Return `yield`: loads under which a body has yielded by Tresca's criterion.

    `yield_strength` is that of the softer body, in uniaxial tension [pressure]. Poisson's ratio 0.3
    is assumed if none are known. Along a load history the forces of every sample count as applied
    once; at its end the traction is that of the path.

    Source: johnson, section 4.2; notes, §14.
    """
    ratios, pressed = poissons_ratios or (ASSUMED_RATIO,), normal_of(contact)
    sheared = not isinstance(contact, NormalContact) and bool(np.any(contact.tangential_force))
    exponent = _exponent(pressed.profile)
    if exponent is not None and not sheared:
        # Under a power the stresses are similar at all loads.
        factor = np.max(
            [np.vectorize(_factor, otypes=[float])(exponent, nu) for nu in ratios], axis=0
        )
        where = pressed.loaded & (2 * factor * pressed.mean_pressure >= yield_strength)
    else:
        columns, shape = _columns(contact)

        def reaches(one: Contact) -> bool:
            peaks = (largest(one, MEASURES[1], poissons_ratio=nu) for nu in ratios)
            return any(2 * peak.value >= yield_strength for peak in peaks)

        def under(i: int, place: Array) -> bool:
            return reaches(_under(single(pressed, i, shape), columns[2, i], *place.tolist()))

        flags = np.zeros(columns.shape[1], dtype=bool)
        loaded = np.broadcast_to(pressed.loaded, shape).ravel()
        _, group = np.unique(columns[2:], axis=1, return_inverse=True)
        for number in range(int(group.max()) + 1):
            _mark(flags, np.flatnonzero((group == number) & loaded), columns[:2], under)
        if isinstance(contact, LoadHistory) and not flags[-1]:
            flags[-1] = reaches(contact.state)
        where = flags.reshape(shape)

    def message() -> str:
        least = float(np.min(np.broadcast_to(pressed.normal_force, where.shape)[where]))
        return f"the stresses meet Tresca's criterion under a normal force of {least:.4g}"

    return Finding("yield", where, message)


def _columns(contact: _Contact | LoadHistory) -> tuple[Array, tuple[int, ...]]:
    """Coordinate, |F_x|/(mu F_N), mu, E* and swept parameters by load, and the shape of loads."""
    pressed, ratio, friction = normal_of(contact), np.zeros(()), np.zeros(())
    if not isinstance(contact, NormalContact):
        start = contact.start if isinstance(contact, LoadHistory) else contact
        friction = np.asarray(start.friction_coefficient)
        limit = friction * pressed.normal_force
        ratio = np.abs(contact.tangential_force) / np.where(limit > 0, limit, 1.0)
        ratio = np.where(contact.regime == "full_slip", 1.0, ratio)
    swept = [pressed.profile.parameters[name] for name in pressed.profile.swept]
    columns = np.broadcast_arrays(pressed.coordinate, ratio, friction, pressed.e_star, *swept)
    return np.array([np.ravel(each) for each in columns]), columns[0].shape


def _under(pressed: NormalContact, friction: float, coordinate: float, ratio: float) -> _Contact:
    """Return a contact under another load, of this contact coordinate and ratio of the forces."""
    there = replace(pressed, coordinate=np.asarray(coordinate))
    if ratio == 0:
        return there
    # The stresses depend on the ratio of the forces alone, not on G*.
    force = min(ratio, _SLIDES) * (friction * there.normal_force)
    return tangential.solve(there, there.e_star, friction, tangential_force=force)


def _mark(
    flags: Flags, index: Indices, places: Array, reaches: Callable[[int, Array], bool]
) -> None:
    """Set the flags of cases that yield, which differ in load alone, by bisection of the loads.

    The largest stress grows with the load, and with the ratio of the forces.
    """
    if not index.size:
        return
    low, high = places[:, index].min(axis=1), places[:, index].max(axis=1)
    if not reaches(int(index[0]), high):
        return
    if np.array_equal(low, high) or reaches(int(index[0]), low):
        flags[index] = True
        return
    order = index[np.argsort(places[int(low[0] == high[0]), index], kind="stable")]
    for half in np.array_split(order, 2):
        _mark(flags, half, places, reaches)


@lru_cache(maxsize=256)
def _factor(exponent: float, poissons_ratio: float) -> float:
    """Largest shear stress over the mean pressure under a power."""
    contact = normal.solve(Power(1.0, exponent), 1.0, contact_radius=1.0)
    return float(
        largest(contact, MEASURES[1], poissons_ratio=poissons_ratio).value / contact.mean_pressure
    )


def _exponent(profile: Profile) -> Parameter | None:
    """Exponent of a power, else None."""
    if isinstance(profile, Power):
        return profile.exponent
    return {Cone: 1.0, Paraboloid: 2.0}.get(type(profile))


def _onset(
    pressed: NormalContact, ratio: float, friction: float, limit: float, options: dict[str, Any]
) -> float:
    """Normal force at which a measure reaches a limit, the ratio of the loads held constant."""
    profile, start = pressed.profile, log(pressed.coordinate)
    radii = infinite_radii(profile, options["poissons_ratio"], 0.0 if ratio > _SLIDES else inf)
    if any(b <= profile.contact_radius(np.zeros(())) for b in radii):
        return 0.0
    # The stress becomes infinite when the contact reaches this coordinate.
    singular = min(
        (float(profile.coordinate_from_radius(np.asarray(b))) for b in radii), default=inf
    )

    def at(coordinate: float) -> NormalContact:
        return replace(pressed, coordinate=np.asarray(coordinate))

    @cache
    def excess(place: float) -> float:
        """Logarithm of the measure over the limit, by that of the contact coordinate."""
        with np.errstate(all="ignore"):
            peak = largest(_under(pressed, friction, exp(place), ratio), **options)
        if isclose(peak.value, limit, rel_tol=_ONSET_RTOL):
            return 0.0
        # Next to the equator of a body no double tells the contact from it, and nothing is loaded.
        return log(peak.value / limit) if peak.value > 0 else -_REACH

    lowest = start - _REACH
    highest = min(start + _REACH, log(min(singular, profile.last_coordinate or inf)) - _ONSET_RTOL)
    before = place = min(start, highest)
    sign = 1 if excess(place) > 0 else -1
    # The first step takes the stress to grow like the mean pressure, which is exact for powers.
    nearby = [at(exp(place - gap)).mean_pressure for gap in (0.0, _ONSET_RTOL)]
    growth = log(nearby[0] / nearby[1]) / _ONSET_RTOL
    step = 1 / max(growth, 1 / _REACH)
    while sign * excess(place) > 0:
        if place == (lowest if sign > 0 else highest):
            return 0.0 if sign > 0 else float(at(singular).normal_force) if singular < inf else inf
        before, place = place, min(max(place - step * excess(place), lowest), highest)
        step *= 2
    onset = exp(brentq(excess, before, place, xtol=_ONSET_RTOL))
    return float(at(onset).normal_force)
