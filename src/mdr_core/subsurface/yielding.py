"""Normal force at which yield begins, and the loads under which a contact has yielded."""

from functools import cache, lru_cache, partial
from math import exp, inf, log
from typing import Final, TypeAlias

import numpy as np
from scipy.optimize import brentq

from mdr_core import normal, tangential
from mdr_core.broadcasting import with_parameters
from mdr_core.errors import InputError
from mdr_core.history import LoadHistory
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Paraboloid, Power, Profile
from mdr_core.subsurface.foundation import Contact
from mdr_core.subsurface.peaks import MEASURES, Peak, infinite_radii, largest
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Parameter
from mdr_core.validation import require_positive
from mdr_core.validity import ASSUMED_RATIO, Finding

# Decimals of the logarithm of the stress at the onset, and accuracy of the contact coordinate's.
_DIGITS, _XTOL = 5, 1e-5
# Largest distance of that logarithm from the prescribed load.
_REACH: Final = 60.0

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
    limit = yield_strength if measure == "von_mises" else yield_strength / 2
    search = partial(largest, measure=measure, poissons_ratio=poissons_ratio, body=body)
    pressed, (columns, shape) = contact.normal, _columns(contact)
    if not np.all(pressed.loaded):
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    # Loads in one ratio of the forces share the onset.
    _, first, which = np.unique(columns[1:], axis=1, return_index=True, return_inverse=True)
    onset = [_onset(pressed.profile, columns[:, i].tolist(), search, limit) for i in first]
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
    ratios, pressed = poissons_ratios or (ASSUMED_RATIO,), contact.normal
    (columns, shape), exponent = _columns(contact), _exponent(pressed.profile)
    if exponent is not None and not columns[1].any():
        # Under a power the stresses are similar at all loads.
        factor = np.max(
            [np.vectorize(_factor, otypes=[float])(exponent, nu) for nu in ratios], axis=0
        )
        where = pressed.loaded & (2 * factor * pressed.mean_pressure >= yield_strength)
    else:

        def yields(one: Contact) -> bool:
            peaks = (largest(one, MEASURES[1], poissons_ratio=nu) for nu in ratios)
            return any(2 * peak.value >= yield_strength for peak in peaks)

        @cache
        def reaches(*case: float) -> bool:
            return yields(_under(pressed.profile, *case))

        where = np.zeros(shape, dtype=bool)
        loaded = np.flatnonzero(np.broadcast_to(pressed.loaded, shape))
        _, group = np.unique(columns[2:, loaded], axis=1, return_inverse=True)
        boxes = [loaded[group == number] for number in np.unique(group)]
        # The largest stress grows with the load, and with the ratio of the forces: a box of both is
        # cut in two unless a corner decides about all of it.
        while boxes:
            box = boxes.pop()
            low, high = columns[:, box].min(axis=1), columns[:, box].max(axis=1)
            if not reaches(*high.tolist()):
                continue
            if reaches(*low.tolist()):
                where.flat[box] = True
            else:
                order = np.argsort(columns[int(low[0] == high[0]), box], kind="stable")
                boxes += np.array_split(box[order], 2)
        if isinstance(contact, LoadHistory) and not where[-1]:
            where[-1] = yields(contact.state)

    def message() -> str:
        least = float(np.min(np.broadcast_to(pressed.normal_force, where.shape)[where]))
        return f"the stresses meet Tresca's criterion under a normal force of {least:.4g}"

    return Finding("yield", where, message)


def _columns(contact: _Contact | LoadHistory) -> tuple[Array, tuple[int, ...]]:
    """Coordinate, |F_x|/(mu F_N), mu, E* and swept parameters by load, and the shape of loads."""
    pressed, ratio, friction = contact.normal, np.zeros(()), np.zeros(())
    if not isinstance(contact, NormalContact):
        start = contact.path.start if isinstance(contact, LoadHistory) else contact
        friction = np.asarray(start.friction_coefficient)
        limit = friction * pressed.normal_force
        ratio = np.abs(contact.tangential_force) / np.where(limit > 0, limit, 1.0)
        ratio = np.where(contact.regime == "full_slip", 1.0, np.minimum(ratio, 1.0))
    swept = [pressed.profile.parameters[name] for name in pressed.profile.swept]
    columns = np.broadcast_arrays(pressed.coordinate, ratio, friction, pressed.e_star, *swept)
    return np.array([np.ravel(each) for each in columns]), columns[0].shape


def _under(
    profile: Profile, coordinate: float, ratio: float, friction: float, e_star: float, *swept: float
) -> _Contact:
    """Contact under one load; parameters: see `_columns`."""
    one = with_parameters(profile, dict(zip(profile.swept, swept, strict=True)))
    pressed = NormalContact(one, e_star, np.asarray(coordinate))
    if ratio == 0:
        return pressed
    force = ratio * friction * pressed.normal_force
    # The stresses depend on the ratio of the forces alone, not on G*.
    return tangential.solve(pressed, e_star, friction, tangential_force=force)


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


def _onset(profile: Profile, case: list[float], search: "partial[Peak]", limit: float) -> float:
    """Normal force at which a measure reaches a limit, the ratio of the forces held constant."""
    start, ratio, *rest = case

    def at(coordinate: float) -> NormalContact:
        return _under(profile, coordinate, 0.0, *rest).normal

    @cache
    def excess(place: float) -> float:
        """Logarithm of the measure over the limit, by that of the contact coordinate."""
        with np.errstate(all="ignore"):
            value = search(_under(profile, exp(place), ratio, *rest)).value
            # Next to the equator of a body no double tells the contact from it: nothing is loaded.
            return round(float(np.clip(np.log(value / limit), -_REACH, _REACH)), _DIGITS)

    one, slips_at = at(start).profile, 0.0 if ratio >= 1 else inf
    radii = infinite_radii(one, search.keywords["poissons_ratio"], slips_at)
    # The stress becomes infinite when the contact reaches this coordinate.
    beyond = [np.asarray(b) for b in radii if b > one.first_radius]
    singular = min((float(one.coordinate_from_radius(b)) for b in beyond), default=inf)
    highest = log(min(start * exp(_REACH), singular, one.last_coordinate or inf)) - _XTOL
    lowest = log(start) - _REACH
    before = place = min(log(start), highest)
    # The first step takes the stress to grow like the mean pressure, which is exact for powers.
    growth = log(at(exp(place)).mean_pressure / at(exp(place - _XTOL)).mean_pressure) / _XTOL
    sign, step = 1 if excess(place) > 0 else -1, 1 / max(growth, 1 / _REACH)
    while sign * excess(place) > 0:
        if place == (lowest if sign > 0 else highest):
            return 0.0 if sign > 0 else float(at(singular).normal_force) if singular < inf else inf
        before, place = place, min(max(place - step * excess(place), lowest), highest)
        step *= 2
    return float(at(exp(brentq(excess, before, place, xtol=_XTOL))).normal_force)
