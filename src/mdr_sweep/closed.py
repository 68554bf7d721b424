"""Many scenes of one kind by one call of the core, with all that the service would say of each."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mdr_core import normal, tangential, validity
from mdr_core.errors import InputError
from mdr_core.normal import NormalContact
from mdr_core.profiles import KINDS, Profile
from mdr_core.tangential import TangentialContact
from mdr_service import convert
from mdr_service.schemas.queries import Moduli, NormalQuery, TangentialQuery
from mdr_sweep import single
from mdr_sweep.columns import Flags, Values
from mdr_sweep.study import Study

# What may differ from scene to scene in one call.
_NUMBERS: Final = ("load.", "tangential.", "friction_coefficient", "material.")
_MODULI: Final = frozenset({"material.e_star", "material.g_star"})
# Queries that the core answers for many scenes at once.
_AT_ONCE: Final = frozenset({"normal", "tangential"})
# Their parameters are no numbers: one profile a call.
_SINGLE_KINDS: Final = frozenset({"series", "tabulated"})


@dataclass(frozen=True)
class Found:
    """What one call says of its scenes."""

    answers: Mapping[str, Any]
    codes: Mapping[str, Flags]
    """By code, in the service's order, the scenes that it is said of."""
    open: Flags
    """Scenes that have to be asked about one by one."""


def spreads(kind: str, name: str) -> bool:
    """Whether the field of that dotted name may differ from scene to scene in one call."""
    if name.startswith("profile."):
        return kind in KINDS and kind not in _SINGLE_KINDS and name != "profile.kind"
    if name.startswith("material."):
        return name in _MODULI
    return name.startswith(_NUMBERS)


def together(study: Study, kind: str) -> bool:
    """Whether many scenes of a kind are answered by one call."""
    if study.query not in _AT_ONCE:
        return False
    # Of other kinds the largest values are looked for.
    return not study.largest or kind == "paraboloid"


def solve(
    query: NormalQuery, swept: Mapping[str, Values], answers: tuple[str, ...], scenes: int
) -> Found:
    """Return what the core says of the scenes that differ in the `swept` fields only.

    `query` is one of them, already checked, as all of them are.
    """
    rows = np.arange(scenes)
    refused = np.zeros(scenes, dtype=bool)
    while rows.size:
        part = {name: values[rows] for name, values in swept.items()} if refused.any() else swept
        try:
            with np.errstate(all="ignore"):
                found = _solve(query, part, answers, rows.size)
        except InputError as error:
            bad = _of_scenes(error, rows.size)
            refused[rows[bad]] = True
            rows = rows[~bad]
            continue
        return _spread(found, rows, refused)
    return Found({}, {}, refused)


def _of_scenes(error: InputError, size: int) -> Flags:
    """The scenes that a failure is about; all of them where it does not say."""
    scenes = np.ravel(np.asarray(error.scenes if error.scenes is not None else True))
    return np.broadcast_to(scenes if scenes.any() else True, (size,))


def _solve(
    query: NormalQuery, swept: Mapping[str, Values], answers: tuple[str, ...], size: int
) -> Found:
    profile, e_star, g_star = _profile(query, swept), *_moduli(query, swept)
    load = _control("load", query.load.control, query.load.value, swept, size)
    contact = normal.solve(profile, e_star, rtol=query.rtol, **load)
    result: NormalContact | TangentialContact = contact
    if isinstance(query, TangentialQuery):
        friction = swept.get("friction_coefficient", query.friction_coefficient)
        given = query.tangential
        pushed = _control("tangential", given.control, given.value, swept, size)
        if g_star is None:
            raise InputError(("material", "g_star"), "is needed where there is friction")
        result = tangential.solve(contact, g_star, friction, **pushed)
    values = {name: _answer(result, contact, name, size) for name in answers}
    codes = _codes(query, result, contact, size)
    numbers = [value for value in values.values() if value.dtype == np.float64]
    numbers.append(np.broadcast_to(contact.mean_pressure, (size,)))
    unusual = np.zeros(size, dtype=bool)
    for value in numbers:
        unusual |= ~np.isfinite(value)
    if not np.all(np.isfinite(profile.tip_pressure)):
        # Without a load its mean pressure is infinite, and the document says so.
        unusual |= np.broadcast_to(contact.contact_radius == 0, (size,))
    if profile.swept and contact.error_estimate > query.rtol:
        # That of the worst of them: which ones it is about is asked one by one.
        unusual[:] = True
    return Found(values, codes, unusual)


def _profile(query: NormalQuery, swept: Mapping[str, Values]) -> Profile:
    names = [name for name in swept if name.startswith("profile.")]
    if not names:
        return convert.profile(query.profile)
    parameters = {name: value for name, value in vars(query.profile).items() if name != "kind"}
    parameters |= {name.partition(".")[2]: swept[name] for name in names}
    return KINDS[query.profile.kind](**parameters)


def _moduli(query: NormalQuery, swept: Mapping[str, Values]) -> tuple[Any, Any]:
    if not isinstance(query.material, Moduli):
        known = convert.material(query.material)
        return known.e_star, known.g_star
    given = query.material
    return swept.get("material.e_star", given.e_star), swept.get("material.g_star", given.g_star)


def _control(
    group: str, name: str, value: Any, swept: Mapping[str, Values], size: int
) -> dict[str, Any]:
    values = swept.get(f"{group}.{name}")
    return {name: np.full(size, float(value)) if values is None else values}


def _answer(
    result: NormalContact | TangentialContact, contact: NormalContact, name: str, size: int
) -> np.ndarray[Any, np.dtype[Any]]:
    if name.startswith("maximum_"):
        return np.broadcast_to(single.largest(name, result, contact.rtol), (size,))
    own = result if hasattr(type(result), name) else contact
    return np.broadcast_to(getattr(own, name), (size,))


def _codes(
    query: NormalQuery,
    result: NormalContact | TangentialContact,
    contact: NormalContact,
    size: int,
) -> dict[str, Flags]:
    """By code the scenes that the service would say it of, in its order."""
    profile, a = contact.profile, np.broadcast_to(contact.contact_radius, (size,))
    found: dict[str, Flags] = {"half_space": validity.steep(profile, a)}
    found["table_end"] = validity.near_end(profile, a)
    found["plastic"] = validity.plastic(profile, a)
    found["accuracy"] = np.broadcast_to(np.asarray(contact.error_estimate > query.rtol), (size,))
    if isinstance(result, TangentialContact):
        moduli = contact.e_star, result.g_star
        slips = validity.transverse(result.friction_coefficient, *moduli)
        found["friction"] = np.broadcast_to(slips, (size,))
        said = convert.material(query.material).warnings
        found |= {notice.code: np.ones(size, dtype=bool) for notice in said}
    if "yield_strength" in query.material.model_fields_set:
        found |= _yields(query, result, contact, a)
    return found


def _yields(
    query: NormalQuery,
    result: NormalContact | TangentialContact,
    contact: NormalContact,
    a: Values,
) -> dict[str, Flags]:
    friction: dict[str, Any] = {}
    if isinstance(result, TangentialContact):
        friction = {
            "friction_coefficient": result.friction_coefficient,
            "full_slip": result.full_slip,
        }
    return validity.yields(
        contact.profile,
        contact.e_star,
        a,
        query.material.yield_strength,
        poissons_ratios=convert.poissons_ratios(query.material),
        **friction,
    )


def _spread(found: Found, rows: np.ndarray[Any, np.dtype[np.intp]], refused: Flags) -> Found:
    """The same for all scenes, where some were refused."""
    if rows.size == refused.size:
        return found

    def over(values: np.ndarray[Any, np.dtype[Any]]) -> np.ndarray[Any, np.dtype[Any]]:
        whole = np.zeros(refused.size, values.dtype)
        whole[rows] = values
        return whole

    answers = {name: over(values) for name, values in found.answers.items()}
    codes = {name: over(flags) for name, flags in found.codes.items()}
    return Found(answers, codes, refused | over(found.open))
