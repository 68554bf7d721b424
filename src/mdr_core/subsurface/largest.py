"""Largest von Mises and shear stress of a contact, and the normal force at which yield begins."""

from dataclasses import replace
from math import ceil, exp, inf, isfinite, log, nan
from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from scipy.optimize import brentq

from mdr_core import tangential
from mdr_core.errors import InputError
from mdr_core.fields.radii import graded
from mdr_core.normal import NormalContact
from mdr_core.profiles import Cone, Profile
from mdr_core.subsurface.stress import Rings, on_rings
from mdr_core.tangential import TangentialContact
from mdr_core.typing import Array
from mdr_core.validation import require_positive

# Radii, depths and directions of the first grid. The radii cluster at the axis, the edges and the
# breaks; the depths lie between these parts of the contact radius, by e-folds.
_RADII: Final = 24
# See _RADII.
_PER_E_FOLD: Final = 2
# See _RADII.
_DEEPEST: Final = 2.0
# See _RADII.
_SHALLOWEST: Final = 1e-4
# See _RADII.
_DIRECTIONS: Final = np.linspace(0, np.pi, 7)
# Peaks of the first grid that are refined, and the points across a box around each.
_PEAKS: Final = 3
# See _PEAKS.
_ACROSS: Final = np.linspace(-1, 1, 5)
# A round halves the boxes. A smooth peak is missed by the square of the last box's size.
_ROUNDS: Final = 12
# Tolerance of the stresses, and the relative accuracy of the largest one that follows.
_RTOL: Final = 1e-7
# Rounds, and the accuracy of the contact coordinate's logarithm, at the onset of yield.
_ONSET_ROUNDS: Final = 8
# See _ONSET_ROUNDS.
_ONSET_RTOL: Final = 1e-6
# Steps of that logarithm by which the onset is bracketed, and the largest distance.
_STEP: Final = 2.0
# See _STEP.
_REACH: Final = 60.0
# Poisson's ratio of incompressible bodies, in which the stress at the tip of a cone is hydrostatic.
_INCOMPRESSIBLE: Final = 0.5

_Contact: TypeAlias = NormalContact | TangentialContact
MEASURES: Final = ("von_mises", "maximum_shear")


class Peak(NamedTuple):
    """Largest value of a measure of stress under each load, and its place; shape of the loads.

    Where the stress is infinite, the place is a radius of infinite pressure on the surface.
    """

    value: Array
    """[pressure]"""
    x: Array
    """[length]"""
    y: Array
    """[length], >= 0: the field is symmetric."""
    z: Array
    """[length]"""


def largest(
    contact: _Contact,
    measure: str = "von_mises",
    *,
    poissons_ratio: float,
    body: int = 1,
) -> Peak:
    """Return the largest von Mises or shear stress in a body under each load, and its place.

    It is found by a grid over the half-space and its surface, refined around its highest points
    to a relative accuracy of about 1e-6.

    Source: notes, §14.

    Parameters
    ----------
    contact : a normal contact, or one that is loaded tangentially as well, under any loads.
    measure : "von_mises" or "maximum_shear".
    poissons_ratio : of this body [1].
    body : 1 for the body of the profile, 2 for the other.

    Raises
    ------
    InputError : another measure.

    Examples
    --------
    Hertz' contact, nu = 0.3: 0.31 p_0 at the depth 0.481 a, Johnson's section 4.2.

    >>> from mdr_core.normal import solve
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(2.0), 3.0, contact_radius=0.1)
    >>> peak = largest(contact, "maximum_shear", poissons_ratio=0.3)
    >>> [round(float(one), 3) for one in (peak.value / contact.maximum_pressure, peak.z / 0.1)]
    [0.31, 0.481]
    """
    if measure not in MEASURES:
        raise InputError(("measure",), f"must be one of {', '.join(MEASURES)}")
    shape = _shape(contact)
    material, found = _Body(measure, poissons_ratio, body), np.empty((4, int(np.prod(shape))))
    for i in range(found.shape[1]):
        found[:, i] = _peak(_one(contact, i, shape), material, _ROUNDS)
    return Peak(*found.reshape(4, *shape))


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
    InputError : another measure, or a yield strength that is not positive.

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
    shape = _shape(contact)
    limit = yield_strength if measure == "von_mises" else yield_strength / 2
    found = np.array(
        [
            _onset(_one(contact, i, shape), limit, _Body(measure, poissons_ratio, body))
            for i in range(int(np.prod(shape)))
        ]
    )
    return found.reshape(shape)


class _Body(NamedTuple):
    """A body and a measure of its stress."""

    measure: str
    poissons_ratio: float
    body: int

    def at(self, contact: _Contact, r: Array, z: Array, angle: Array) -> Array:
        """Return the measure at points; zero where it is infinite.

        Parameters
        ----------
        r, z : radii and depths [length], shape (m,).
        angle : directions, shape (k, m).
        """
        place = Rings(r, z, np.cos(angle), np.sin(angle))
        found = on_rings(contact, place, self.poissons_ratio, body=self.body, rtol=_RTOL)
        values = np.asarray(getattr(found, self.measure))
        return np.where(np.isinf(values), 0.0, values)


def _shape(contact: _Contact) -> tuple[int, ...]:
    if isinstance(contact, TangentialContact):
        return contact.width.shape
    return contact.coordinate.shape


def _one(contact: _Contact, i: int, shape: tuple[int, ...]) -> _Contact:
    """The contact under one of its loads."""

    def pick(part: Any) -> Any:
        return np.asarray(np.broadcast_to(part, shape).ravel()[i])

    normal = _normal(contact)
    pressed = replace(normal, e_star=pick(normal.e_star), coordinate=pick(normal.coordinate))
    if isinstance(contact, NormalContact):
        return pressed
    return replace(
        contact,
        normal=pressed,
        g_star=pick(contact.g_star),
        friction_coefficient=pick(contact.friction_coefficient),
        stick_coordinate=pick(contact.stick_coordinate),
        width=pick(contact.width),
        sign=pick(contact.sign),
        full_slip=pick(contact.full_slip),
        excess=pick(contact.excess),
    )


def _peak(contact: _Contact, material: _Body, rounds: int) -> tuple[float, float, float, float]:
    """Value and place of the largest stress under one load."""
    pressed = _normal(contact)
    profile, a = pressed.profile, float(pressed.contact_radius)
    if not pressed.loaded:
        return 0.0, 0.0, 0.0, 0.0
    singular = _singular_radius(profile, a, material.poissons_ratio)
    if singular is not None:
        return inf, singular, 0.0, 0.0
    sheared = isinstance(contact, TangentialContact) and bool(contact.tangential_force != 0)
    edges = [float(contact.stick_radius)] if isinstance(contact, TangentialContact) else []
    breaks = [float(np.asarray(b)) for b in profile.breaks]
    stops = np.unique([0.0, a, *(b for b in (*edges, *breaks) if b < a)])
    r = graded(np.append(stops, 1.5 * a), max(_RADII, 4 * stops.size))
    shallow = min(_SHALLOWEST * a, 0.1 * float(np.diff(stops).min()))
    count = ceil(_PER_E_FOLD * log(_DEEPEST * a / shallow))
    z = np.append(0.0, np.geomspace(shallow, _DEEPEST * a, count))
    angle = _DIRECTIONS if sheared else np.zeros(1)
    at_r, at_z = (part.ravel() for part in np.meshgrid(r, z, indexing="ij"))
    values = material.at(contact, at_r, at_z, np.repeat(angle[:, None], at_r.size, axis=1))
    values = values.T.reshape(r.size, z.size, angle.size)
    steps = [
        np.maximum(np.diff(axis, append=axis[-1]), np.diff(axis, prepend=axis[0]))
        for axis in (r, z, angle)
    ]
    centre, box = [], []
    for index in _highest(values):
        centre.append([axis[i] for axis, i in zip((r, z, angle), index, strict=True)])
        box.append([step[i] for step, i in zip(steps, index, strict=True)])
    return _refined(contact, material, np.array(centre), np.array(box), rounds)


def _highest(values: Array) -> list[tuple[int, int, int]]:
    """Indices of the highest points of a grid that are not neighbours of one another."""
    left, found = values.copy(), []
    for _ in range(_PEAKS):
        i, j, k = np.unravel_index(int(np.argmax(left)), left.shape)
        found.append((int(i), int(j), int(k)))
        left[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = -1.0
    return found


def _refined(
    contact: _Contact, material: _Body, centre: Array, box: Array, rounds: int
) -> tuple[float, float, float, float]:
    """Halve a box around each peak, (peaks, 3) in r, z and the angle, about its highest point."""
    around = _ACROSS if box[:, 2].any() else np.zeros(1)
    across, down = (part.ravel() for part in np.meshgrid(_ACROSS, _ACROSS, indexing="ij"))
    every = np.arange(len(centre))
    for _ in range(rounds):
        r = np.maximum(centre[:, :1] + box[:, :1] * across, 0.0)
        z = np.maximum(centre[:, 1:2] + box[:, 1:2] * down, 0.0)
        angle = np.clip(centre[:, 2:] + box[:, 2:] * around, 0.0, np.pi)
        turned = np.repeat(angle.T, across.size, axis=1)
        values = material.at(contact, r.ravel(), z.ravel(), turned)
        values = values.reshape(around.size, len(centre), across.size)
        flat = np.moveaxis(values, 0, 1).reshape(len(centre), -1)
        turn, place = np.divmod(flat.argmax(axis=1), across.size)
        value = flat.max(axis=1)
        centre = np.stack([r[every, place], z[every, place], angle[every, turn]], axis=1)
        box = box / 2
    top = int(np.argmax(value))
    r, z, angle = centre[top]
    # sin(pi) is not zero in double precision.
    y = 0.0 if angle == np.pi else r * np.sin(angle)
    return float(value[top]), r * np.cos(angle), y, z


def _singular_radius(profile: Profile, a: float, poissons_ratio: float) -> float | None:
    """Smallest radius of infinite deviatoric stress in the contact.

    At the tip of a cone on an incompressible body the infinite stress is hydrostatic.
    """
    hydrostatic = poissons_ratio == _INCOMPRESSIBLE and np.all(np.isfinite(profile.tip_pressure))
    radii = [float(np.asarray(b)) for b in profile.infinite_pressure_radii]
    reached = [b for b in radii if b <= a and (b > 0 or not hydrostatic)]
    return min(reached, default=None)


def _onset(contact: _Contact, limit: float, material: _Body) -> float:
    """Normal force at which a measure reaches a limit, the ratio of the loads held constant."""
    pressed = _normal(contact)
    profile, start = pressed.profile, float(pressed.coordinate)
    if not pressed.loaded:
        raise InputError(("load",), "the onset of yield needs a load that is not zero")
    singular = _singular_radius(profile, inf, material.poissons_ratio)
    if singular is not None and singular <= profile.contact_radius(np.zeros(())):
        return 0.0
    end = profile.last_coordinate or inf
    if singular is not None:
        end = float(profile.coordinate_from_radius(np.asarray(singular)))

    def excess(place: float) -> float:
        with np.errstate(all="ignore"):
            value, *_ = _peak(_scaled(contact, start * exp(place)), material, _ONSET_ROUNDS)
        return log(value / limit) if value > 0 else nan

    last = log(end / start) - _ONSET_RTOL
    place = min(0.0, last)
    value = excess(place)
    if isinstance(profile, Cone):
        # The largest stress is that of any load.
        return 0.0 if value >= 0 else inf
    step, before = (-_STEP if value > 0 else _STEP), place
    while (value > 0) == (step < 0):
        if place == last:
            # At a slope discontinuity the stress is infinite.
            return float(_normal(_scaled(contact, end)).normal_force) if singular else inf
        if abs(place) > _REACH:
            return 0.0 if step < 0 else inf
        before, place = place, min(place + step, last)
        value = excess(place)
        if not isfinite(value):
            # Next to the equator of a body no double tells the contact from it.
            return inf
    root = brentq(excess, min(before, place), max(before, place), xtol=_ONSET_RTOL)
    return float(_normal(_scaled(contact, start * exp(root))).normal_force)


def _scaled(contact: _Contact, coordinate: float) -> _Contact:
    """The contact under another normal load, in the same ratio of tangential to normal force."""
    pressed = replace(_normal(contact), coordinate=np.asarray(coordinate))
    if isinstance(contact, NormalContact):
        return pressed
    moduli = contact.g_star, contact.friction_coefficient
    if contact.full_slip:
        beyond = 2 * contact.sign * contact.compliance * pressed.indentation_depth
        return tangential.solve(pressed, *moduli, tangential_displacement=beyond)
    ratio = contact.tangential_force / contact.limiting_force
    force = ratio * (contact.friction_coefficient * pressed.normal_force)
    return tangential.solve(pressed, *moduli, tangential_force=force)


def _normal(contact: _Contact) -> NormalContact:
    return contact.normal if isinstance(contact, TangentialContact) else contact
