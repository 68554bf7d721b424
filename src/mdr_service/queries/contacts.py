"""Queries about contacts, and functions that all queries share.

Profile, material and load become arguments of the core. Results of the core, checked for overflow,
become the members of a response, together with their warnings.
"""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from typing import Any, Final

import numpy as np

from mdr_core import adhesion, layer, profiles, subsurface, thresholds, validity
from mdr_core import normal as normal_contact
from mdr_core import tangential as tangential_contact
from mdr_core.elementwise import every
from mdr_core.errors import DefectError, InputError, Notice
from mdr_core.fit import Fit
from mdr_core.history import LoadHistory
from mdr_core.impact import Impact
from mdr_core.materials import UNUSABLE
from mdr_core.normal import NormalContact
from mdr_core.results import Results
from mdr_core.tangential import TangentialContact
from mdr_core.torsion import TorsionalContact
from mdr_core.typing import Array, Flags
from mdr_core.validity import MODEL_ERRORS, sources_of
from mdr_service.schemas.contacts import Choice, NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import LoadedQuery, StressQuery
from mdr_service.schemas.profiles import Profile
from mdr_service.schemas.torsion import TorsionQuery
from mdr_service.schemas.wear import WearQuery

Arguments = dict[str, Any]
ADHESION: Final = {"work_of_adhesion", "range_of_adhesion"}
"""Members of the material that make a contact adhesive."""

Result = dict[str, Any]
"""Members of a JSON response in their order, with arrays for long lists."""
Contact = NormalContact | TangentialContact | LoadHistory


def solve_normal(query: NormalQuery | LoadedQuery | WearQuery | TorsionQuery) -> NormalContact:
    """Compute the frictionless contact of a profile with an elastic half-space.

    Every list of the response has one entry per load. `method` names the most expensive method
    used; `error_estimate` is an upper bound on the relative error of every number.
    """
    arguments = body(query) | control(query.load)
    given = query.material.model_dump(include=ADHESION, exclude_unset=True)
    if given and "maximum_pressure" in arguments:
        detail = "is undetermined with adhesion, under tension at the edge: give another load"
        raise InputError(("load", "maximum_pressure"), detail)
    if query.material.has("layer") and "maximum_pressure" in arguments:
        detail = "is not a load of a contact with a layer: give the depth, force or contact radius"
        raise InputError(("load", "maximum_pressure"), detail)
    solve: Any = adhesion.solve if given else normal_contact.solve
    solve = layer.solve if query.material.has("layer") else solve
    contact: NormalContact = solve(**arguments, **given)
    return contact


def solve_tangential(query: TangentialQuery | LoadedQuery) -> TangentialContact:
    """Compute a contact with friction, loaded normally first and then tangentially once.

    Every list of the response has one entry per pair of loads. A tangential force beyond µ F_N has
    no equilibrium and is rejected; a displacement beyond full slip has the regime `full_slip`.
    """
    tangential = control(query.tangential)
    return tangential_contact.solve(solve_normal(query), **friction(query), **tangential)


def profile(model: Profile) -> profiles.Profile:
    """Return the profile; fields have the same names in the model and in the core."""
    given: Arguments = {
        name: tuple(value) if isinstance(value, list) else value
        for name, value in vars(model).items()
        if name != "kind"
    }
    if (half_angle := given.pop("half_angle", None)) is not None:
        given["slope"] = profiles.slope_of_half_angle(half_angle)
    if model.kind == "series":
        given["terms"] = tuple(profiles.PowerTerm(**vars(term)) for term in model.terms)
    # Parameters that are arrays over the cases of a sweep cannot be keys of a cache.
    is_swept = any(isinstance(value, np.ndarray) for value in given.values())
    make = _by_parameters.__wrapped__ if is_swept else _by_parameters
    return make(model.kind, **given)


# The cache pays off, because fitting a table takes up to a hundred times as long as a contact, and
# a profile computes its break and the contact coordinate of the break on first use.
@lru_cache(maxsize=32)
def _by_parameters(kind: str, **given: Any) -> profiles.Profile:
    return profiles.KINDS[kind](**given)


def body(query: Query) -> Arguments:
    """Return profile and material, as arguments of the core.

    Raises InputError if adhesion is combined with friction or yield, or has a range but no work,
    and if yield is to be checked under a twist, whose stresses in the bodies are not computed.
    """
    material = query.material
    if isinstance(query, TorsionQuery) and material.has("yield_strength"):
        detail = "is not checked under a twist: leave it out, and check the contact by /v1/normal"
        raise InputError(("material", "yield_strength"), detail)
    if material.has("layer"):
        other = not isinstance(query, NormalQuery | StressQuery) or material.has("yield_strength")
        if other or query.has("friction_coefficient"):
            raise InputError(("material", "layer"), UNUSABLE)
    if material.has("work_of_adhesion"):
        if query.has("friction_coefficient"):
            raise InputError(("material", "work_of_adhesion"), adhesion.AdhesiveContact.unusable)
        if material.has("yield_strength"):
            raise InputError(("material", "yield_strength"), adhesion.AdhesiveContact.unusable)
    elif material.has("range_of_adhesion"):
        raise InputError(("material", "work_of_adhesion"), "is needed with range_of_adhesion")
    return {"profile": profile(query.profile), "e_star": material.effective}


def friction(query: Any) -> Arguments:
    """Return material and coefficient of friction, as arguments of the core."""
    known = query.material.effective
    return {"g_star": known, "friction_coefficient": query.friction_coefficient}


def control(given: Choice) -> Arguments:
    """Return the given control by its name, as an argument of the core."""
    value = given.value
    return {given.control: np.array(value, dtype=float) if isinstance(value, list) else value}


@contextmanager
def pointing(names: Mapping[str, tuple[str, ...]]) -> Iterator[None]:
    """Point errors within the context into the request, which has other `names` for arguments."""
    try:
        yield
    except InputError as error:
        first, *rest = error.path or ("",)
        if first not in names:
            raise
        raise InputError((*names[str(first)], *rest), error.detail) from None


def plain_result(query: Query, source: Results) -> Result:
    """Return the available quantities of a solution, single numbers as lists of one entry."""
    known = {name: value for name, value in source.computed().items() if value is not None}
    return response(query, source, {name: np.atleast_1d(value) for name, value in known.items()})


def contact_result(query: NormalQuery, source: NormalContact | TangentialContact) -> Result:
    """Return the quantities of a contact under its loads, with or without friction."""
    values, infinite = contact_values(query, source)
    return response(query, source, values | holds_while(query, source), infinite=infinite)


def holds_while(query: NormalQuery | StressQuery, source: Contact) -> Result:
    """Return the member `holds_while` of a response, empty unless it is requested."""
    if not query.has("holds_within"):
        return {}
    if isinstance(source, LoadHistory):
        raise InputError(("holds_within",), "needs a load in place of a history")
    found = [
        {
            "effect": limit.effect,
            "quantity": limit.quantity,
            "above" if limit.is_least else "below": np.full(query.loads, limit.value).tolist(),
            "changes": limit.changes,
            "instead": limit.instead,
        }
        for limit in thresholds.of_contact(source.normal, query.holds_within)
    ]
    return {"holds_while": found}


def contact_values(
    query: Query, source: NormalContact | TangentialContact | TorsionalContact
) -> tuple[Result, dict[str, Any]]:
    """Return the quantities of a contact by load, and flags of those that can be infinite."""
    values = by_load(source, query.loads)
    known = source if isinstance(source, TorsionalContact) else source.normal
    normal = source.normal
    errors = {"data_error": known.data_error, "pressure_data_error": normal.pressure_data_error}
    if isinstance(normal, adhesion.AdhesiveContact):
        errors["pull_off_data_error"] = normal.pull_off_data_error
    values |= {
        name: np.full(query.loads, error) for name, error in errors.items() if error is not None
    }
    singular = any(notice.code == "singular" for notice in source.warnings)
    names = ("mean_pressure", "maximum_pressure", "normal_stiffness", "pressure_data_error")
    return values, dict.fromkeys(names, singular)


def require_one_of(query: Query, first: str, second: str) -> None:
    """Raise InputError unless exactly one of two fields is given."""
    if query.has(first) == query.has(second):
        place = second if query.has(second) else first
        raise InputError((place,), f"exactly one of {first}, {second} is needed")


def by_load(source: Results, loads: int) -> Result:
    """Return the quantities of a solution by name, each with one entry per load."""
    return {name: np.full(loads, value) for name, value in source.computed().items()}


def _require_finite(query: Query, values: Result, infinite: Mapping[str, bool | Flags]) -> None:
    """Require finite arrays, apart from entries that `infinite` allows to be infinite.

    Raises InputError if a value overflows, and DefectError if one is NaN without an overflow.
    """
    undefined = ""
    for name, array in values.items():
        is_numbers = isinstance(array, np.ndarray) and array.dtype.kind == "f"
        if not is_numbers or every(np.isfinite(array)):
            continue
        stray = np.isinf(array) & ~np.asarray(infinite.get(name, False))
        if stray.any():
            first = int(np.argwhere(stray)[0][0])
            detail = f"{name} leaves the range of double precision at its entry {first}"
            raise InputError(tuple(query.controls)[:1], detail)
        if np.isnan(array).any():
            undefined = name
    if undefined:
        raise DefectError(f"{undefined} is not a number")


def response(
    query: Query,
    source: Any,
    values: Result,
    *,
    infinite: Mapping[str, bool | Flags] | None = None,
    method: str = "",
    error: float | None = None,
    warnings: Iterable[Notice] = (),
) -> Result:
    """Return the values of a response with the method, the error estimates and the warnings.

    Parameters
    ----------
    query : the request.
    source : the solution, a result of the core.
    values : members of the response, of which arrays are checked.
    infinite : True for the members, or their entries, that can be infinite.
    method, error : method and error estimate of the values, if they differ from the source.
    warnings : warnings beside those of the source.

    Raises
    ------
    InputError : a value overflows.
    DefectError : a value is not a number.
    """
    found = [*source.warnings, *validity.notices(yields(query, source))]
    if "mean_pressure" not in values:
        # Other responses contain no singular scalar; their fields have warnings of their own.
        found = [notice for notice in found if notice.code != "singular"]
    found += warnings
    if error is None:
        error = source.error_estimate
    else:
        # The warnings of the source cover its own error, not the error of fields.
        found = [notice for notice in found if notice.code != "accuracy"]
        found += validity.notices([validity.inaccurate(error)])
    about = {
        "method": method or source.method,
        "sources": [*dict.fromkeys((*source.sources, *sources_of(*values)))],
        "error_estimate": error,
        **_model_errors(source, query.loads),
        "warnings": [vars(notice) for notice in found],
    }
    _require_finite(query, values, infinite or {})
    return values | about


def _model_errors(source: Any, loads: int) -> Result:
    """Return the available estimates of the error of the model, over the loads."""
    known = {name: np.ravel(getattr(source, name)) for name in MODEL_ERRORS}
    return {
        # Fields at the end of a history have the error of its last sample.
        name: error[-1:] if loads == 1 else np.full(loads, error)
        for name, error in known.items()
        if error[0] is not None
    }


def yields(query: Query, source: Any) -> list[validity.Finding]:
    """Return the finding `yield` of the bodies of a query with a yield strength."""
    # The material of a fit can be left out.
    if not query.has("material") or not query.material.has("yield_strength"):
        return []
    pressed = source.normal if isinstance(source, Fit | Impact) else source.solved
    ratios = query.material.effective.poissons_ratios
    return [subsurface.yield_finding(pressed, ratios, query.material.yield_strength)]


def singular(
    radius: Array, values: Mapping[str, Array], possible: Mapping[str, Flags | bool]
) -> list[Notice]:
    """Return a warning for each field that is infinite at some of the `possible` radii."""
    found = []
    for name, flags in possible.items():
        if name not in values:
            continue
        at = radius[flags & np.isinf(np.atleast_2d(values[name])).any(axis=0)]
        if at.size:
            places = validity.listed([repr(r).removesuffix(".0") for r in at.tolist()])
            found.append(Notice("singular", f"{name} is infinite at radius {places}"))
    return found
