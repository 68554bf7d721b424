"""One verification case, and requests that several modules share."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import mpmath

mpmath.mp.dps = 30

# Bound for closed forms: the rounding error of the reference's inputs and of the service.
ROUNDING: Final = 1e-12
# Bound for quantities that the service integrates.
QUADRATURE: Final = 1e-10
# Indices of a number in a response, from its name on.
Place = tuple[str | int, ...]
Json = Mapping[str, Any]


@dataclass(frozen=True)
class Case:
    """Reference value, and the request whose response must agree with it.

    Parameters
    ----------
    source : key of `sources.SOURCES`.
    equation : equation, table or section of the source.
    case : profile, parameters and quantity in words.
    path : endpoint.
    request : its JSON.
    place : indices of the number in the response.
    expected : reference value.
    bound : largest deviation, relative to `scale`.
    uncertainty : that of the reference itself, relative to `scale`; 0 for an exact closed form.
    scale : magnitude to which deviations refer; that of the reference value unless given.
    as_ratio : True if the deviation is the larger of both values over the smaller one, less one.
    """

    source: str
    equation: str
    case: str
    path: str
    request: Json
    place: Place
    expected: Any
    bound: float = ROUNDING
    uncertainty: float = 0.0
    scale: Any = None
    as_ratio: bool = False

    def deviation(self, response: Json) -> float:
        """Return the deviation of the response from the reference, relative to `scale`."""
        found: Any = response
        for index in self.place:
            found = found[index]
        if self.as_ratio:
            return float(max(found / self.expected, self.expected / found) - 1)
        scale = self.expected if self.scale is None else self.scale
        return float(abs((found - self.expected) / scale))


def normal(profile: Json, load: Json, e_star: Any = 1.0) -> dict[str, Any]:
    """Return the request of a frictionless contact."""
    return {"profile": profile, "material": {"e_star": float(e_star)}, "load": dict(load)}


def tangential(
    profile: Json, load: Json, shear: Json, friction: float = 0.3, g_star: float = 1.0
) -> dict[str, Any]:
    """Return the request of a contact with friction, at E* = 1."""
    material = {"e_star": 1.0, "g_star": g_star}
    return {
        "profile": profile,
        "material": material,
        "load": dict(load),
        "friction_coefficient": friction,
        "tangential": dict(shear),
    }


def fields(request: Json, quantity: str, radius: Sequence[float]) -> dict[str, Any]:
    """Return the request of one field over the radius."""
    return dict(request) | {"radius": [float(r) for r in radius], "quantities": [quantity]}


def at(name: str, *index: int) -> Place:
    """Return the place of a quantity, of the first load unless indices are given."""
    return (name, *(index or (0,)))
