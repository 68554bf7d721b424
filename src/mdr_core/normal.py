"""Normal contact: of depth, force and radius, one is given and the others follow."""

from dataclasses import dataclass
from math import inf, isfinite
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from mdr_core.checks import extremes, first_index, largest, least, require_positive
from mdr_core.errors import InputError, Notice
from mdr_core.foundation import (
    coordinate_from_depth,
    coordinate_from_force,
    coordinate_from_radius,
)
from mdr_core.lazy import cached_property
from mdr_core.profiles import Profile
from mdr_core.range import require_range
from mdr_core.sweeps import BLOCK, in_blocks
from mdr_core.typing import Array, Parameter
from mdr_core.validity import normal_notices, top

_FROM: Final = {
    "indentation_depth": coordinate_from_depth,
    "normal_force": coordinate_from_force,
    "contact_radius": coordinate_from_radius,
}


class Load(NamedTuple):
    """One load's contact, as plain numbers; `edge` is a where it is what was given."""

    profile: Profile
    e_star: float
    coordinate: float
    a: float
    edge: Array | None


@dataclass(frozen=True)
class NormalContact:
    """A profile pressed into the half-space, at every load at once.

    Each answer is computed when it is first asked for. All are arrays over the loads (and, for
    a sweep, over the scenes), without dimension where the load was a single number.
    """

    profile: Profile
    e_star: Parameter
    coordinate: Array
    """The contact's edge in the profile's own contact coordinate."""
    rtol: float = 1e-10
    control: str = "contact_radius"
    """Which of the three was given: it is the one known exactly."""

    @cached_property
    def contact_radius(self) -> Array:
        """a [length]."""
        return self.profile.contact_radius(self.coordinate)

    @cached_property
    def indentation_depth(self) -> Array:
        """d = g(a) [length]."""
        return self.profile.depth(self.coordinate)

    @cached_property
    def normal_force(self) -> Array:
        """F_N = 2 E* int_0^a x g'(x) dx [force]. Source: notes, §1."""
        return self.e_star * self.profile.reduced_force(self.coordinate)

    @cached_property
    def mean_pressure(self) -> Array:
        """F_N / (pi a^2) [pressure]; at zero load its limit, infinite on a needle's tip."""
        area = np.pi * (self.contact_radius * self.contact_radius)
        if least(area) > 0:
            return self.normal_force / area
        limit = np.multiply(self.e_star, self.profile.tip_pressure)
        return np.where(area > 0, self.normal_force / np.where(area > 0, area, 1.0), limit)

    @cached_property
    def normal_stiffness(self) -> Array:
        """dF_N/dd = 2 E* a [force/length]. Source: mdr-5, text after Eq. (5.1)."""
        return 2 * self.e_star * self.contact_radius

    @cached_property
    def elastic_energy(self) -> Array:
        """E* int_0^a (d - g)^2 dx = int_0^d F_N dd [force length]."""
        return self.e_star * self.profile.reduced_energy(self.coordinate)

    @cached_property
    def loads(self) -> list[Load]:
        """The loads one by one, for what is answered over the radius."""
        exact = self.control == "contact_radius"
        e_star = float(self.e_star)
        edges, coordinates = np.ravel(self.contact_radius), np.ravel(self.coordinate)
        return [
            Load(self.profile, e_star, coordinate, a, np.array([a]) if exact else None)
            for a, coordinate in zip(edges.tolist(), coordinates.tolist(), strict=True)
        ]

    @property
    def method(self) -> str:
        """The dearest route that the answers of a normal query need for this profile."""
        return self.profile.normal_method

    @property
    def error_estimate(self) -> float:
        """Bound on the relative error of each answer."""
        return self.profile.rounding

    @property
    def warnings(self) -> tuple[Notice, ...]:
        """What `mdr_core.validity` says, and `singular` and `accuracy` where they apply."""
        found = list(normal_notices(self.profile, self.contact_radius))
        if not isfinite(top(self.mean_pressure)):
            found.append(
                Notice(
                    "singular",
                    "the mean pressure is infinite where the load vanishes: "
                    "the tip is sharper than a cone",
                )
            )
        if self.error_estimate > self.rtol:
            found.append(
                Notice(
                    "accuracy",
                    f"rtol = {self.rtol:.1e} is below what double precision reaches here: "
                    "see error_estimate",
                )
            )
        return tuple(found)


def solve(
    profile: Profile,
    e_star: Parameter,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    contact_radius: ArrayLike | None = None,
    rtol: float = 1e-10,
) -> NormalContact:
    """Return the normal contact under one given load.

    a(d) inverts d = g(a); F_N = 2 E* int_0^a x g'(x) dx. Closed forms are used wherever they
    exist; the inverses of the others are solved to rounding, in the contact coordinate.

    Source: mdr-5, Eqs. (5.7), (5.14), (5.25)-(5.27), (5.59), (5.61); notes, §1.

    Parameters
    ----------
    profile : any kind; array parameters broadcast with the load.
    e_star : effective modulus [pressure], > 0.
    indentation_depth, normal_force, contact_radius : exactly one, >= 0
        [length], [force], [length]; a number or an array.
    rtol : relative accuracy asked for, 1e-13 to 1e-3.

    Raises
    ------
    InputError : not exactly one load, a load that is negative or not finite, shapes that do not
        agree, a contact beyond the profile's end, or the radius of a flat punch given as the load.

    Examples
    --------
    Eq. (5.14): a = (3 F R / (4 E*))^(1/3).

    >>> from mdr_core.profiles import Paraboloid
    >>> contact = solve(Paraboloid(0.01), 1e11, normal_force=[10.0, 80.0])
    >>> [float(f"{a:.6g}") for a in contact.contact_radius]
    [9.0856e-05, 0.000181712]
    """
    loads = (indentation_depth, normal_force, contact_radius)
    named = [(name, load) for name, load in zip(_FROM, loads, strict=True) if load is not None]
    if len(named) != 1:
        raise InputError(("load",), f"exactly one of {', '.join(_FROM)} is needed")
    name, load = named[0][0], np.asarray(named[0][1], dtype=float)
    if load.size == 0:
        raise InputError(("load", name), "at least one load is needed")
    spread = _over_scenes(profile, e_star, name, load)
    coordinate = _sweep(profile, e_star, name, spread) if spread.size > BLOCK else None
    if coordinate is None:
        require_modulus(e_star)
        _require_load(name, load)
        coordinate = _FROM[name](profile, _amount(e_star, name, spread))
        require_range(profile, e_star, name, spread, coordinate)
    contact = NormalContact(profile, e_star, coordinate, rtol, name)
    # What was given is answered as given, to the last digit.
    vars(contact)[name] = spread
    return contact


def require_modulus(e_star: Parameter) -> None:
    """Raise InputError unless E* is positive and finite."""
    require_positive(("material", "e_star"), e_star)


def _require_load(name: str, load: Array) -> None:
    """Raise InputError unless the load is finite and not negative."""
    # Of many loads one pass says that all are good; only if it does not, which are bad.
    good = largest(load) < inf if load.ndim and load.flags.c_contiguous else False
    low, high = (0.0, 0.0) if good else extremes(load)
    if not (low >= 0 and high < inf):
        bad = np.asarray(~((load >= 0) & (load < inf)))
        detail = "must be finite and not negative"
        raise InputError(("load", name, *first_index(bad)), detail, bad)


def _sweep(profile: Profile, e_star: Parameter, name: str, load: Array) -> Array | None:
    """The coordinate of many scenes; None if one is refused, which no block can name."""

    def block(part: Profile, moduli: Parameter, loads: Array) -> tuple[Array]:
        # The division waits for the memory anyway: after it the checks find all in the cache.
        amount = _amount(moduli, name, loads)
        _require_load(name, loads)
        coordinate = _FROM[name](part, amount)
        require_range(part, moduli, name, loads, coordinate)
        return (coordinate,)

    try:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            (coordinate,) = in_blocks(block, profile, (e_star, load))
    except (InputError, FloatingPointError):
        return None
    return coordinate


def _amount(e_star: Parameter, name: str, load: Array) -> Array:
    """What determines the contact: the depth, the radius, or F_N/E*."""
    return load / e_star if name == "normal_force" else load


def _over_scenes(profile: Profile, e_star: Parameter, name: str, load: Array) -> Array:
    """The load for every scene of a sweep, shapes that do not agree refused."""
    shapes = [
        part.shape
        for part in (e_star, *profile.parameters.values())
        if isinstance(part, np.ndarray)
    ]
    if not shapes:
        return load
    try:
        shape = np.broadcast_shapes(load.shape, *shapes)
    except ValueError:
        told = ", ".join(map(str, shapes))
        raise InputError(
            ("load", name),
            f"the shape {load.shape} of the load does not agree with the parameters' {told}",
        ) from None
    return load if shape == load.shape else np.broadcast_to(load, shape)
