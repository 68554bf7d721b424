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
from mdr_core.subsurface.peaks import MEASURES, largest
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import require_positive
from mdr_core.validity import ASSUMED_RATIO, Finding, infinite_deviator

# Refinements of the grid, and accuracy of the contact coordinate's logarithm, at the onset.
_ROUNDS: Final = 5
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
    loads = _loads(contact)
    options = {"measure": measure, "poissons_ratio": poissons_ratio, "body": body}
    found = [_onset(loads, i, limit, options) for i in range(loads.coordinate.size)]
    return np.array(found).reshape(loads.loaded.shape)


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
    ratios, loads = poissons_ratios or (ASSUMED_RATIO,), _loads(contact)
    normal, flags = loads.normal, np.zeros(loads.coordinate.shape, dtype=bool)
    exponent: Parameter | None = {Cone: 1.0, Paraboloid: 2.0}.get(type(normal.profile))
    if isinstance(normal.profile, Power):
        exponent = normal.profile.exponent
    if exponent is not None and not loads.ratio.any():
        factor = np.max([_similar(nu)(np.asarray(exponent)) for nu in ratios], axis=0)
        shear = np.multiply(factor, normal.mean_pressure)
        flags |= np.broadcast_to(2 * shear >= yield_strength, loads.loaded.shape).ravel()
        flags &= loads.loaded.ravel()
    else:
        keys = np.stack([loads.e_star, loads.friction, *loads.parameters.values()])
        group = np.unique(keys, axis=1, return_inverse=True)[1].ravel()
        for one in range(int(group.max(initial=-1)) + 1):
            index = np.flatnonzero((group == one) & loads.loaded.ravel())
            if index.size:
                _mark(flags, index, loads, ratios, yield_strength)
    if isinstance(contact, LoadHistory) and not flags[-1]:
        flags[-1] = _reaches(contact.state, ratios, yield_strength)
    where = flags.reshape(loads.loaded.shape)

    def message() -> str:
        least = float(np.min(np.broadcast_to(normal.normal_force, where.shape)[where]))
        return f"the stresses meet Tresca's criterion under a normal force of {least:.4g}"

    return Finding("yield", where, message)


class _Loads(NamedTuple):
    """Cases of a contact; arrays of shape (m,) but for `loaded`."""

    normal: NormalContact
    coordinate: Array
    ratio: Array
    """|F_x|/(mu F_N) [1]."""
    e_star: Array
    friction: Array
    parameters: dict[str, Array]
    """Parameters of the profile that are arrays over the cases."""
    loaded: Flags
    """Of the shape of the loads."""

    def under(self, i: int, coordinate: float, ratio: float) -> _Contact:
        """Return the contact of a case under another load."""
        swept = {name: values[i] for name, values in self.parameters.items()}
        profile = with_parameters(self.normal.profile, swept)
        at = np.asarray(coordinate)
        pressed = replace(self.normal, profile=profile, e_star=float(self.e_star[i]), coordinate=at)
        if ratio == 0:
            return pressed
        # The stresses depend on the ratio of the forces alone, not on G*.
        g_star, friction = float(self.e_star[i]), float(self.friction[i])
        if ratio > _SLIDES:
            beyond = 2 * friction * pressed.indentation_depth
            return tangential.solve(pressed, g_star, friction, tangential_displacement=beyond)
        force = ratio * (friction * pressed.normal_force)
        return tangential.solve(pressed, g_star, friction, tangential_force=force)


def _loads(contact: _Contact | LoadHistory) -> _Loads:
    normal, friction, ratio = _pressed(contact), np.zeros(()), np.zeros(())
    if not isinstance(contact, NormalContact):
        start = contact.start if isinstance(contact, LoadHistory) else contact
        friction = np.asarray(start.friction_coefficient)
        limit = friction * normal.normal_force
        slides = contact.regime == "full_slip"
        force = np.abs(contact.tangential_force)
        ratio = np.where(slides, 1.0, force / np.where(limit > 0, limit, 1.0))
    swept = {name: normal.profile.parameters[name] for name in normal.profile.swept}
    columns = normal.coordinate, ratio, normal.e_star, friction, *swept.values()
    loaded, *wide = np.broadcast_arrays(normal.loaded, *columns)
    flat = [np.ravel(part) for part in wide]
    parameters = dict(zip(swept, flat[4:], strict=True))
    return _Loads(normal, flat[0], flat[1], flat[2], flat[3], parameters, loaded)


def _mark(
    flags: Flags, index: Indices, loads: _Loads, ratios: tuple[float, ...], strength: float
) -> None:
    """Set the flags of cases that yield, which differ in load alone, by bisection of the loads."""
    places = loads.coordinate[index], loads.ratio[index]

    def reaches(coordinate: float, ratio: float) -> bool:
        return _reaches(loads.under(int(index[0]), coordinate, ratio), ratios, strength)

    high, low = ([bound(part) for part in places] for bound in (np.max, np.min))
    if not reaches(*high):
        return
    if low == high or reaches(*low):
        flags[index] = True
        return
    order = np.argsort(places[0] if low[0] < high[0] else places[1], kind="stable")
    for half in np.array_split(index[order], 2):
        _mark(flags, half, loads, ratios, strength)


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


def _onset(loads: _Loads, i: int, limit: float, options: dict[str, Any]) -> float:
    """Normal force at which a measure reaches a limit, the ratio of the loads held constant."""
    start, ratio = float(loads.coordinate[i]), float(loads.ratio[i])
    if not loads.loaded.flat[i]:
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    profile = _pressed(loads.under(i, start, 0.0)).profile
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
        return float(_pressed(loads.under(i, coordinate, 0.0)).normal_force)

    def excess(place: float) -> float:
        with np.errstate(all="ignore"):
            contact = loads.under(i, exp(place), ratio)
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
