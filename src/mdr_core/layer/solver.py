"""Contacts with an elastic layer under prescribed loads."""

from math import pi, sqrt
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from mdr_core import adhesion, normal, validation
from mdr_core.elementwise import full, where
from mdr_core.equivalent_1d import coordinate_from_radius
from mdr_core.errors import InputError
from mdr_core.inversion import invert
from mdr_core.layer.adhesive import LayerCurve
from mdr_core.layer.contact import LayerContact
from mdr_core.layer.equation import allowed, largest_coordinate, require_flat_within, states
from mdr_core.layer_response import softening
from mdr_core.materials import Layer, Material
from mdr_core.normal import CONTROLS
from mdr_core.profiles import Profile
from mdr_core.typing import Array

# Upper bound of the ratio of contact radii on layer and half-space at the same depth. It is 2 for a
# thin incompressible layer.
_DEEPER: Final = 4.0


def solve(
    profile: Profile,
    e_star: Material,
    *,
    indentation_depth: ArrayLike | None = None,
    normal_force: ArrayLike | None = None,
    contact_radius: ArrayLike | None = None,
    work_of_adhesion: float | None = None,
    range_of_adhesion: float = 0.0,
) -> LayerContact | adhesion.AdhesiveContact:
    """Return the contact with an elastic layer under a prescribed depth, force or contact radius.

    Parameters
    ----------
    profile : any kind, with single numbers as parameters.
    e_star : material with a `layer`, as from `from_bodies`.
    indentation_depth, normal_force, contact_radius : see `normal.solve`.
    work_of_adhesion, range_of_adhesion : see `adhesion.solve`; without adhesion by default.

    Raises
    ------
    InputError : a contact radius above 10 times the thickness, a bonded layer without Poisson's
        ratio, or what `normal.solve` and `adhesion.solve` reject.

    Examples
    --------
    A gel of thickness 4 um on glass is 2.5 times as stiff as a half-space at this depth.

    >>> from mdr_core.materials import from_bodies, Body, RIGID
    >>> from mdr_core.profiles import Paraboloid
    >>> gel = from_bodies([RIGID, Body(2e3, 0.5)], layer=Layer(4e-6, "bonded"))
    >>> contact = solve(Paraboloid(5e-6), gel, indentation_depth=1e-6)
    >>> [float(f"{value:.6g}") for value in (contact.contact_radius, contact.normal_force)]
    [2.82794e-06, 1.90928e-08]
    """
    validation.require_type("profile", profile, Profile, "a profile such as Paraboloid(0.01)")
    validation.require_single_profile(profile.swept)
    validation.require_type("e_star", e_star, Material, "a Material with a layer")
    material, layer, modulus = e_star, e_star.layer, e_star.e_star
    if layer is None:
        raise InputError(("material", "layer"), "is needed")
    validation.require_single_positive(("material", "e_star"), modulus)
    loads = dict(zip(CONTROLS, (indentation_depth, normal_force, contact_radius), strict=True))
    softening(layer, np.ones(1))
    # Checks the loads as well.
    name, load = validation.only_one(("load",), loads)
    require_flat_within(profile, layer, ("material", "layer"))
    if name == "contact_radius":
        reach = allowed(profile, layer)
        validation.require_inside(("load", name), np.asarray(load > reach.domain), reach)
    if work_of_adhesion is not None:
        validation.require_single_positive(("material", "work_of_adhesion"), work_of_adhesion)
        c = sqrt(2 * pi) * sqrt(work_of_adhesion) / sqrt(modulus)
        curve = LayerCurve(profile, c, layer)
        return adhesion.on_curve(curve, modulus, material, loads, range_of_adhesion)
    coordinate = _coordinate(profile, layer, name, load / modulus if name == CONTROLS[1] else load)
    contact = LayerContact(profile, modulus, coordinate, name, material, layer=layer)
    vars(contact)[name] = load
    return contact


def _coordinate(profile: Profile, layer: Layer, name: str, load: Array) -> Array:
    """Contact coordinate under loads, forces over E*."""
    validation.require_not_negative(("load", name), load)
    of_force = name == "normal_force"
    if name == "contact_radius":
        return coordinate_from_radius(profile, load)
    if profile.is_flat_punch:
        return load / states(profile, layer, np.ones(1)).stiffness[0] if of_force else load
    end = largest_coordinate(profile, layer)
    within = np.minimum(load, profile.largest_loads[of_force])
    start = normal.solve(profile, 1.0, **{name: within}).coordinate
    if np.max(start) * _DEEPER > end:
        last = states(profile, layer, np.atleast_1d(end))
        beyond = np.asarray(load > (last.force if of_force else last.depth)[0])
        validation.require_inside(("load", name), beyond, allowed(profile, layer))

    def sloped(s: Array) -> tuple[Array, Array]:
        found = states(profile, layer, np.ravel(s))
        value, slope = found.depth, found.depth_slope
        if of_force:
            value, slope = found.force, found.stiffness * slope
        shape = np.shape(s)
        return value.reshape(shape)[()], (np.ravel(s) * slope / value).reshape(shape)[()]

    start = np.minimum(where(start > 0, start, end), end)
    return invert(sloped, load, start, full(0.0, start), full(end, start))
