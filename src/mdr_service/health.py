"""Whether the answers are right: one whose closed form is known, computed like any other."""

from math import isclose, sqrt
from typing import Any, Final

import orjson

from mdr_service import problems, questions, wire
from mdr_service.compute import COMPUTE
from mdr_service.problems import ServiceError

FAILURES: Final = (problems.LOST, problems.NOT_READY, problems.TIME_EXCEEDED)

_RADIUS, _MODULUS, _DEPTH = 0.01, 1.15e11, 1e-6
_QUERY: Final = {
    "profile": {"kind": "paraboloid", "radius": _RADIUS},
    "material": {"e_star": _MODULUS},
    "load": {"indentation_depth": _DEPTH},
}
# F_N = (4/3) E* R^(1/2) d^(3/2), a = (R d)^(1/2): Hertz.
_KNOWN: Final = {
    "normal_force": 4 / 3 * _MODULUS * sqrt(_RADIUS * _DEPTH) * _DEPTH,
    "contact_radius": sqrt(_RADIUS * _DEPTH),
}
_ROUNDING: Final = 1e-14
_SECONDS: Final = 1e-3


async def check() -> None:
    """Have a compute process answer what is known; raise ServiceError where it does not."""
    query = questions.QUESTIONS["normal"].model.model_validate(_QUERY)
    found = await COMPUTE.run_apart(_SECONDS, questions.answer, "normal", query, wire.MEDIA_TYPE)
    answer: dict[str, Any] = orjson.loads(found.content)
    for name, known in _KNOWN.items():
        if not isclose(answer[name][0], known, rel_tol=_ROUNDING):
            raise ServiceError(problems.NOT_READY, f"{name} of a Hertzian contact is wrong")
