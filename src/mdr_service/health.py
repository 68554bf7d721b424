"""Self-test of a compute process: a Hertzian contact against its closed form."""

from math import isclose, sqrt
from typing import Any, Final

import orjson

from mdr_service import problems
from mdr_service.dispatch import respond
from mdr_service.problems import ServiceError
from mdr_service.schemas.contacts import NormalQuery
from mdr_service.serializers import JSON

# A steel ball of 10 mm pressed into steel by a micrometre (SI units).
_RADIUS, _MODULUS, _DEPTH = 0.01, 1.15e11, 1e-6
_QUERY: Final = {
    "profile": {"kind": "paraboloid", "radius": _RADIUS},
    "material": {"e_star": _MODULUS},
    "load": {"indentation_depth": _DEPTH},
}
# F_N = (4/3) E* R^(1/2) d^(3/2), a = (R d)^(1/2): Hertz.
_EXPECTED: Final = {
    "normal_force": 4 / 3 * _MODULUS * sqrt(_RADIUS * _DEPTH) * _DEPTH,
    "contact_radius": sqrt(_RADIUS * _DEPTH),
}
# Some tens of units in the last place.
_ROUNDING: Final = 1e-14


def self_test() -> None:
    """Solve a Hertzian contact; raise ServiceError if the result is wrong."""
    query = NormalQuery.model_validate(_QUERY)
    result: dict[str, Any] = orjson.loads(respond("normal", query, JSON))
    for name, expected in _EXPECTED.items():
        if not isclose(result[name][0], expected, rel_tol=_ROUNDING):
            raise ServiceError(problems.NOT_READY, f"{name} of a Hertzian contact is wrong")
