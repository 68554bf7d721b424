"""What a sweep asks: the query, the constants of all scenes, and the answers that are wanted."""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any, Final

from pydantic import BaseModel

from mdr_service.schemas.answers import NormalAnswer, TangentialAnswer, WearAnswer

# The numbers of an answer that has one of each for every scene.
_OF_QUERY: Final[Mapping[str, type[BaseModel]]] = {
    "normal": NormalAnswer,
    "tangential": TangentialAnswer,
    "wear": WearAnswer,
}
_NOT_OF_SCENES: Final = frozenset(
    {"method", "error_estimate", "warnings", "radius"}
    | {"initial_profile", "limiting_profile", "worn_depth", "pressure"}
)
ANSWERS: Final[Mapping[str, tuple[str, ...]]] = {
    query: tuple(name for name in model.model_fields if name not in _NOT_OF_SCENES)
    for query, model in _OF_QUERY.items()
}
# What a field is at the most: dear where it has to be looked for, and answered if asked by name.
LARGEST: Final[Mapping[str, tuple[str, ...]]] = {
    "normal": ("maximum_pressure",),
    "tangential": ("maximum_pressure", "maximum_shear_stress"),
    "wear": (),
}
# Whose versions the last digits depend on.
_PACKAGES: Final = ("mdr", "numpy", "scipy", "pyarrow")


def versions() -> dict[str, str]:
    """Return the versions of all that the answers, and the bytes of their table, depend on."""
    return {name: version(name) for name in _PACKAGES}


@dataclass(frozen=True)
class Study:
    """The same for every chunk of a sweep; it goes to the workers."""

    query: str
    constants: Mapping[str, Any]
    """Fields of all scenes, by their dotted names."""
    answers: tuple[str, ...]
    kept: tuple[str, ...] = ()
    """Columns that are copied and not read."""
    versions: Mapping[str, str] | None = None
    """What the workers have to run."""

    @property
    def largest(self) -> tuple[str, ...]:
        """The answers that are the largest values of fields."""
        return tuple(name for name in self.answers if name in LARGEST[self.query])
