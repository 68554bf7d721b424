"""Twist of a contact about its axis, with slip, under a constant normal load."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ellipkm1

from mdr_core import conditioning, materials
from mdr_core.doubles import EPS
from mdr_core.elementwise import in_blocks, quotient
from mdr_core.materials import Material
from mdr_core.normal import NormalContact, SlippingContact
from mdr_core.profiles import Profile, Tabulated
from mdr_core.quadrature import composite_rule
from mdr_core.torsion.curve import DEEPEST, VirginCurves
from mdr_core.typing import Array, Flags, Indices, Parameter
from mdr_core.validation import (
    as_positive,
    common_shape,
    only_one,
    reject,
    require_finite,
    require_representable,
    require_type,
)

CONTROLS: Final = ("torque", "rotation", "stick_radius")
NEEDED: Final = (
    "a normal contact alone, without a tangential load or a load history: it is exact under a "
    "constant normal load only"
)
# Ends ln(a/c) to which a curve is resolved, one after the other until the curve contains the load.
_DEPTHS: Final = (1.0, 2.0, 4.0, 8.0, 16.0, DEEPEST)
# ln(a/x) at which int x^2 dg of g ~ x^(1/20) has converged.
_CONVERGED: Final = DEEPEST / 2
# Values for each break of the curve of one contact; they bound the size of arrays.
_VALUES: Final = 512
# A profile, n contacts of it, and the cases with the index of the contact of each.
_Group = tuple[Profile, Array, Indices, Indices]
# Number of points of the integrals over ln x of the data error, of which two digits suffice.
_OF_DATA: Final = 20
# Lower end x/a at which int x^2 dg has two digits.
_TIP: Final = 1e-4
# Rounding error of the curves relative to closed forms: twice the largest among 2,000 contacts.
_OF_CURVES: Final = 10.0


@dataclass(frozen=True, repr=False)
class TorsionalContact(SlippingContact):
    """Normal contact under a twist, at any number of pairs of loads.

    Results are arrays over the broadcast loads.
    """

    normal: NormalContact
    shear_modulus: Parameter
    friction_coefficient: Parameter
    second_moment: Array
    """int x^2 dg over the contact [length^3]."""
    torque: Array
    """M [force length]."""
    rotation: Array
    """phi [radian]."""
    stick_radius: Array
    """c [length], zero in full slip."""
    slip_width: Array
    """a - c [length], without cancellation."""
    torsional_stiffness: Array
    """dM/dphi = (16/3) G c^3 on further twist [force length]."""
    dissipated_energy: Array
    """Energy dissipated by friction since the torque was zero [force length].

    It is int (M dphi - phi dM), a quarter of the energy of a cycle of this amplitude.
    """
    regime: "np.ndarray[Any, np.dtype[np.str_]]"
    """Regime: "stick", "partial_slip" or "full_slip"; see `solve`."""
    error_estimates: Array
    """Upper bound of the relative error of each case, rounding of its loads included [1]."""
    quantities: ClassVar[tuple[str, ...]] = (
        *("torque", "rotation", "stick_radius", "slip_width", "torsional_stiffness"),
        *("dissipated_energy", "torsion_arm", "regime"),
    )
    method: ClassVar[str] = "quadrature"

    @property
    def torsion_arm(self) -> Array:
        """Largest torque divided by mu F_N: (pi/4) int x^2 dg/int x dg [length].

        At zero load it is the limit: pi b/4 on a flat of radius b.
        """
        force = self.normal.normal_force / self.normal.e_star
        limit = np.pi / 4 * self.normal.profile.first_radius
        return quotient(np.pi / 2 * self.second_moment, force, limit)

    @cached_property
    def data_error(self) -> Array | None:
        """Relative error of torque and rotation that the points of a table leave open [1].

        It estimates, at given a and c, the largest of three errors: of P(c), which determines the
        rotation, of int x^2 dg, which determines the largest torque, and of the normal contact.
        """
        normal, profile, known = self.normal, self.normal.profile, self.normal.data_error
        if known is None or not isinstance(profile, Tabulated):
            return None
        a = np.where(normal.loaded, normal.contact_radius, profile.scale) + 0 * self.rotation
        c = np.where(self.slip_width > 0, np.maximum(self.stick_radius, EPS * a), a)
        shares, weights = composite_rule(_OF_DATA)
        errors = [known + 0 * a]
        for end, power in ((c, 0), (_TIP * a, 3)):
            ratio = (end / a)[..., None] ** shares
            kernel = ratio**power if power else ellipkm1(np.square((end / a)[..., None] / ratio))
            x, kernel = a[..., None] * ratio, weights * kernel
            possible = profile.fit.spread_of(
                *(each.reshape(-1, x.shape[-1]) for each in (x, kernel))
            )
            errors.append(possible.reshape(a.shape) / (kernel * profile.dg(x)).sum(axis=-1))
        return np.where(normal.loaded, np.max(errors, axis=0), 0.0)[()]

    @property
    def g_star(self) -> float | None:
        """G* of the bodies [pressure], from which the warnings detect dissimilar bodies."""
        return self.normal.material.g_star

    @cached_property
    def model_error(self) -> Array:
        """Estimated relative error of the model in each case [1]; see the normal contact."""
        return self.normal.model_error + 0 * self.rotation

    @property
    def stick_error(self) -> Array:
        """Rounding error of the stick radius [length]."""
        return self.error_estimates * np.minimum(self.stick_radius, self.slip_width)


def solve(
    contact: NormalContact,
    shear_modulus: Parameter | Material | None,
    friction_coefficient: Parameter,
    *,
    torque: ArrayLike | None = None,
    rotation: ArrayLike | None = None,
    stick_radius: ArrayLike | None = None,
) -> TorsionalContact:
    """Return a normal contact under one monotonic twist about its axis.

    With P(c) = int_c^a K(c/x) dg(x)/x and the complete elliptic integral K, for every profile
    phi = mu E* P(c)/(2 pi G) and M = (8 mu E*/(3 pi)) [c^3 P(c) + 3 int_c^a y^2 P(y) dy], so that
    dM = (16/3) G c^3 dphi. Slip spreads inwards from the edge, into a flat as well; a flat punch
    sticks completely up to M = (2/3) mu F_N a. P grows without bound as c -> 0: no rotation reaches
    the largest torque. If c is below the machine epsilon times a, the contact is in full slip: c is
    returned as zero, and M equals the largest torque in double precision.

    Source: jaeger; lubkin; deresiewicz; notes, §16.

    Parameters
    ----------
    contact : the normal contact, from `mdr_core.normal.solve`.
    shear_modulus : G, 1/G = 1/G1 + 1/G2 [pressure], > 0, or the material that has it.
    friction_coefficient : mu > 0 [1].
    torque, rotation, stick_radius : exactly one; the first two of either sign [force length],
        [radian], [length]. Arrays broadcast with the normal loads.

    Raises
    ------
    InputError : a torque without equilibrium, which reaches the largest torque mu F_N times
        `torsion_arm` to rounding error; a stick radius outside the contact or below the machine
        epsilon times its radius; an adhesive contact; not exactly one load; parameters that are not
        positive.

    Examples
    --------
    The largest torque on a ball is 3 pi mu F_N a/16.

    >>> from mdr_core import normal
    >>> from mdr_core.profiles import Paraboloid
    >>> contact = normal.solve(Paraboloid(0.01), 1.1e11, normal_force=10.0)
    >>> twist = solve(contact, 4e10, 0.3, stick_radius=contact.contact_radius / 2)
    >>> round(float(twist.torsion_arm / contact.contact_radius * 16 / np.pi), 12)
    3.0
    >>> round(float(twist.torque / (0.3 * 10.0 * twist.torsion_arm)), 9)
    0.897338429
    """
    require_type("contact", contact, NormalContact, NEEDED)
    modulus = materials.modulus("shear_modulus", shear_modulus)
    friction_coefficient = as_positive(("friction_coefficient",), friction_coefficient)
    loads = (torque, rotation, stick_radius)
    name, given = only_one(("torsion",), dict(zip(CONTROLS, loads, strict=True)))
    require_finite(("torsion", name), given)
    others = "the normal loads", contact.coordinate, modulus, friction_coefficient
    shape = common_shape(("torsion", name), given, *others)
    cube = contact.contact_radius * contact.contact_radius * contact.contact_radius
    require_representable(("load", contact.control), contact.loaded, cube)

    def flat(value: Parameter) -> Array:
        return np.broadcast_to(value, shape).ravel()

    parts = contact.e_star, modulus, friction_coefficient
    signed, edge, a, e_star, g, friction = map(
        flat, (given, contact.coordinate, contact.contact_radius, *parts)
    )
    width = flat(_slip_width(contact, given)) if name == "stick_radius" else 0 * signed
    units = 8 / (3 * np.pi) * friction * e_star, friction * (e_star / g) / (2 * np.pi), 1.0
    load = np.abs(signed) / units[CONTROLS.index(name)]
    # Without a normal load nothing resists a rotation.
    states, second, slides = np.zeros((6, load.size)), np.zeros(load.size), load > 0
    states[0], states[5] = a, 1.0
    for profile, contacts, cases, place in _groups(contact.profile, edge, shape):
        second[cases] = VirginCurves(profile, contacts, _CONVERGED).second_moment[place]
        own = load[cases], width[cases], place
        states[:, cases], slides[cases] = _states(profile, contacts, name, *own)
    largest = 3 / 16 * np.pi**2 * second
    error, of_edge = _OF_CURVES * flat(contact.error_estimates), conditioning.of_edge_slope(contact)
    if name == "torque":
        # Next to the largest torque, the rounding error of that torque dominates the error of c.
        detail = (
            "no equilibrium: the torque reaches the largest one, friction_coefficient x "
            "normal_force x torsion_arm; reduce it, or prescribe rotation"
        )
        beyond = (load > 0) & (load >= largest * (1 - 4 * error))
        reject(("torsion", name), given, beyond, detail)
    elif name == "stick_radius":
        of_edge = contact.edge_errors * conditioning.narrow_annulus(edge, width).reshape(shape)
    slides &= name == "rotation"
    # In full slip friction dissipates the work of the largest torque.
    states[4] += np.where(slides, largest * (load - states[2]) / 3, 0.0)
    states[:4] = np.where(slides, (0 * a, a, load, largest), states[:4])
    c, width, turned, moment, work, _ = states
    results: dict[str, Any] = {
        "torque": np.copysign(units[0] * moment, signed),
        "rotation": np.copysign(units[1] * turned, signed),
        "stick_radius": c,
        "slip_width": width,
        "torsional_stiffness": 16 / 3 * g * c**3,
        "dissipated_energy": 3 * units[0] * units[1] * work,
        "regime": np.where(slides, "full_slip", np.where(width > 0, "partial_slip", "stick")),
        "error_estimates": error * _condition(name, states, slides) + flat(of_edge),
        "second_moment": second,
    }
    # The prescribed load is returned bit-identical.
    results = {key: value.reshape(shape)[()] for key, value in (results | {name: signed}).items()}
    return TorsionalContact(contact, modulus, friction_coefficient, **results)


def _groups(profile: Profile, edge: Array, shape: tuple[int, ...]) -> Iterator[_Group]:
    """Loaded cases in groups of contacts with one profile; equal contacts are merged."""
    loaded = np.flatnonzero(edge > 0)
    if profile.swept:
        names = profile.parameters
        columns = {name: np.broadcast_to(names[name], shape).ravel() for name in profile.swept}
        for case in loaded:
            own = {name: float(column[case]) for name, column in columns.items()}
            yield profile.with_parameters(own), edge[[case]], np.array([case]), np.array([0])
        return
    contacts, place = np.unique(edge[loaded], return_inverse=True)
    order = np.argsort(place, kind="stable")
    for block in in_blocks(contacts.size, _VALUES * (1 + profile.coordinate_breaks.size)):
        cases = order[slice(*np.searchsorted(place[order], (block.start, block.stop)))]
        yield profile, contacts[block], loaded[cases], place[cases] - block.start


def _states(
    profile: Profile, contacts: Array, name: str, load: Array, width: Array, place: Indices
) -> tuple[Array, Flags]:
    """States under the loads, and whether a load is beyond the deepest curve."""
    if name == "stick_radius":
        depth = float(np.log((profile.contact_radius(contacts)[place] / load).max()))
        curves = VirginCurves(profile, contacts, max(depth, _DEPTHS[0]))
        return curves.at_stick(load, width, place), load < 0
    of_moment = name == "torque"
    for depth in _DEPTHS:
        curves = VirginCurves(profile, contacts, depth)
        beyond = load >= curves.tops(of_moment=of_moment)[-1, place]
        if not beyond.any():
            break
    return curves.at_load(load, place, of_moment=of_moment), beyond


def _slip_width(contact: NormalContact, stick: Array) -> Array:
    """a - c of prescribed stick radii [length]; raises InputError if there is no such contact."""
    a, profile, path = contact.contact_radius, contact.profile, ("torsion", "stick_radius")
    outside = (stick > a) | (stick < EPS * a) | ((stick < a) & ~contact.loaded)
    detail = (
        "must lie between 2.2e-16 times the contact radius and the contact radius: as it falls to "
        "zero, the rotation grows without bound"
    )
    reject(path, stick, outside, detail)
    if profile.is_flat_punch:
        detail = "a flat punch sticks up to a finite rotation: prescribe torque or rotation"
        reject(path, stick, (stick == a) & contact.loaded, detail)
    return contact.width_outside(stick)


def _condition(name: str, states: Array, slides: Flags) -> Array:
    """Bound on the relative condition number of the results with respect to the load.

    The load determines P, and P determines c, a - c, the other load and the work.
    """
    c, width, rotation, moment, _, slope = states
    if name == "stick_radius":
        return np.ones_like(c)
    with np.errstate(all="ignore"):
        change = rotation if name == "rotation" else moment / c**3
        worst = 3 * change / np.minimum(rotation, slope * np.minimum(c, width))
    slips = (width > 0) & ~slides & (worst > 1) & (worst < np.inf)
    return np.where(slips, worst, 1.0)
