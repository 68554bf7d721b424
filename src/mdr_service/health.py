"""Self-test of a compute process: a Hertzian contact against its closed form."""

from math import isclose
from typing import Any, Final

import orjson

from mdr_service import problems
from mdr_service.dispatch import respond
from mdr_service.problems import ServiceError
from mdr_service.schemas.contacts import NormalQuery
from mdr_service.serializers import JSON

_QUERY: Final = {
    "profile": {"kind": "paraboloid", "radius": 1.0},
    "material": {"e_star": 0.75},
    "load": {"indentation_depth": 1.0},
}
# A self-test takes a millisecond. A process that cannot finish it within this time is useless.
SECONDS: Final = 2.0
# Hertz: F_N = (4/3) E* R^(1/2) d^(3/2), a = (R d)^(1/2).
_EXPECTED: Final = {"normal_force": 1.0, "contact_radius": 1.0}


def self_test() -> None:
    """Solve a Hertzian contact; raise ServiceError if the result is wrong."""
    query = NormalQuery.model_validate(_QUERY)
    result: dict[str, Any] = orjson.loads(respond("normal", query, JSON))
    for name, expected in _EXPECTED.items():
        if not isclose(result[name][0], expected):
            raise ServiceError(problems.NOT_READY, f"{name} of a Hertzian contact is wrong")
