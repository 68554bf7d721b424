"""What the cost of a query depends on, and what is counted of it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from math import log10
from typing import Any, Final, NamedTuple

from mdr_service import pictures, table, wire
from mdr_service.schemas.loads import Cycles, History
from mdr_service.schemas.profiles import Series, Tabulated
from mdr_service.schemas.queries import HistoryQuery, NormalQuery, Query, StressQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery

Counts = Iterator[tuple[str, float]]

_FORMS: Final = {wire.MEDIA_TYPE: "json", table.MEDIA_TYPE: "csv", pictures.MEDIA_TYPE: "svg"}
_OTHER_FORM: Final = "npz"
# Numbers of an answer for each load, sample or number of cycles.
_COLUMNS: Final = {"normal": 6, "tangential": 12, "history": 9, "wear": 6, "evolution": 7}

# Legs of mixed control beyond these are taken together with the first.
_FIRST_ARCS: Final = 8
_OF_SHEAR: Final = frozenset({"shear_stress", "slip", "foundation_shear"})


class Sizes(NamedTuple):
    """What the cost of a query depends on."""

    question: str
    profile: str
    form: str
    digits: float
    length: int = 0
    """Points of a table, or terms of a series."""
    loads: int = 1
    """Or numbers of cycles."""
    inverted: int = 0
    """Loads whose contact radius is to be found."""
    radii: int = 0
    quantities: tuple[str, ...] = ()
    rubbed: bool = False
    samples: int = 0
    curved: int = 0
    """How many of the samples end a leg that is not straight."""
    forced: int = 0
    """How many of them have a normal force of their own."""
    kinked: bool = False
    """Whether the profile is a table of straight pieces."""
    nodes: int = 0
    moving: bool = False
    """Whether the stick edge moves as it wears."""


def of(question: str, query: Query, media_type: str) -> Sizes:
    """Return the sizes of a query, also of one that is to be refused."""
    return Sizes(
        question,
        query.profile.kind,
        _FORMS.get(media_type, _OTHER_FORM),
        -log10(query.rtol),
        _length(query),
        kinked=isinstance(query.profile, Tabulated) and query.profile.interpolation == "linear",
        **_MORE[question](query),
    )


def counts(sizes: Sizes) -> Counts:
    """Yield what is counted of the work, by names of which each kind of profile has rates."""
    yield from _COUNTS[sizes.question](sizes)


def written(sizes: Sizes) -> Counts:
    """Yield what is counted of the writing, whatever the profile."""
    numbers = sizes.loads * sizes.radii * len(sizes.quantities)
    rows = sizes.samples or sizes.loads
    yield sizes.form, 1
    yield f"{sizes.form}/number", numbers + rows * _COLUMNS.get(sizes.question, 0)


def _length(query: Query) -> int:
    if isinstance(query.profile, Tabulated):
        return len(query.profile.r)
    return len(query.profile.terms) if isinstance(query.profile, Series) else 0


def _of_loads(query: NormalQuery) -> dict[str, Any]:
    return {"loads": query.loads, "inverted": _inverted(query)}


def _inverted(query: NormalQuery | StressQuery) -> int:
    if "load" not in query.model_fields_set or query.load.control == "contact_radius":
        return 0
    return query.load.count


def _of_history(query: HistoryQuery) -> dict[str, Any]:
    # Both or neither may be there; that is found out where it is solved.
    ways: dict[str, History | Cycles] = {"history": query.history, "cycles": query.cycles}
    given = [ways[name] for name in ways.keys() & query.model_fields_set]
    return {"rubbed": True} | _of_ways(given)


def _of_ways(ways: Sequence[History | Cycles]) -> dict[str, int]:
    return {
        "samples": sum(way.samples for way in ways),
        "curved": sum(way.curved for way in ways),
        "forced": sum(way.forced for way in ways),
    }


def _of_stress(query: StressQuery) -> dict[str, Any]:
    return {
        "loads": query.loads,
        "inverted": _inverted(query),
        "radii": query.radii,
        "quantities": tuple(query.quantities),
        "rubbed": query.has_friction,
    } | _of_ways([query.history] if query.has_history else [])


def _of_wear(query: WearQuery | EvolutionQuery) -> dict[str, Any]:
    found: dict[str, Any] = {
        "loads": query.loads,
        "radii": query.radii,
        "quantities": tuple(query.quantities),
    }
    if isinstance(query, EvolutionQuery):
        held = (query.load.control, query.oscillation.control)
        found["nodes"] = query.resolution
        found["moving"] = held == ("normal_force", "tangential_displacement")
    return found


_MORE: Final[Mapping[str, Callable[[Any], dict[str, Any]]]] = {
    "normal": _of_loads,
    "tangential": _of_loads,
    "history": _of_history,
    "stress": _of_stress,
    "wear": _of_wear,
    "evolution": _of_wear,
}


def _normal(sizes: Sizes) -> Counts:
    yield "normal", 1
    yield "normal/load", sizes.loads
    yield from _inverses(sizes)


def _tangential(sizes: Sizes) -> Counts:
    yield "tangential", 1
    yield "tangential/load", sizes.loads
    yield from _inverses(sizes)


def _inverses(sizes: Sizes) -> Counts:
    yield "inverse", min(sizes.inverted, 1)
    yield "inverse/load", sizes.inverted


def _history(sizes: Sizes) -> Counts:
    yield "history", 1
    if not sizes.curved:
        yield "history/sample", sizes.samples
        yield "history/forced sample", sizes.forced
        return
    # Every round of the integrals takes all arcs at once, and more digits take more rounds.
    digits = sizes.digits
    arcs = min(sizes.curved, _FIRST_ARCS) * digits
    yield "history/arcs", digits if sizes.curved > 1 else 0
    yield "history/arc", arcs
    yield "history/arc sample", sizes.samples
    if sizes.kinked:
        yield "history/kinks", digits
        yield "history/kink", arcs
        yield "history/kink sample", sizes.samples * digits


def _on_arcs(sizes: Sizes) -> Counts:
    """What the fields of the end take besides for arcs, of which few are left, or none."""
    if sizes.curved:
        yield "end of arcs", 1
        for name in _OF_SHEAR.intersection(sizes.quantities):
            yield f"{name}/number on arcs", sizes.radii


def _stress(sizes: Sizes) -> Counts:
    if sizes.samples:
        yield from _history(sizes)
        yield from _on_arcs(sizes)
    elif sizes.rubbed:
        yield from _tangential(sizes)
    else:
        yield from _normal(sizes)
    for name in sizes.quantities:
        yield name, 1
        # Alone among them this one takes nodes by the digits, everywhere.
        digits = sizes.digits if name == "normal_displacement" else 1
        yield f"{name}/number", sizes.loads * sizes.radii * digits


def _wear(sizes: Sizes) -> Counts:
    yield "wear", 1
    yield "wear/load", sizes.loads
    yield "wear/number", sizes.loads * sizes.radii * len(sizes.quantities)


def _evolution(sizes: Sizes) -> Counts:
    # A stick edge that moves is followed as well.
    times = sizes.digits * (2 if sizes.moving else 1)
    yield "evolution", times
    yield "evolution/node", times * sizes.nodes
    yield "evolution/node^2", times * sizes.nodes**2
    yield "evolution/halt", sizes.loads * sizes.nodes
    yield "evolution/number", sizes.loads * sizes.radii * len(sizes.quantities)


_COUNTS: Final[Mapping[str, Callable[[Sizes], Counts]]] = {
    "normal": _normal,
    "tangential": _tangential,
    "history": _history,
    "stress": _stress,
    "wear": _wear,
    "evolution": _evolution,
}
