"""Limits of the service, read once from environment variables with the prefix ``MDR_``.

The size limits are fixed when the service starts, because they are part of the OpenAPI document and
of the request models, which reject a list that is too long during parsing.
"""

import os
from collections.abc import Mapping
from math import ceil
from typing import Annotated, Final

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

PREFIX: Final = "MDR_"

_Seconds = Annotated[float, Field(gt=0, le=86_400)]
_Origin = Annotated[str, Field(pattern=r"^(\*|https?://[^/\s]+)$")]


def _separated(text: object) -> object:
    return [part.strip() for part in text.split(",") if part] if isinstance(text, str) else text


class Settings(BaseModel):
    """Limits of a server process; the variable is ``MDR_`` and the name in capitals."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    max_body_bytes: int = Field(4 * 1024**2, ge=1024)
    """Maximum length of a request body [bytes]."""
    max_length: int = Field(100_000, ge=2)
    """Maximum number of loads, radii, cycles or samples in a request."""
    max_numbers: int = Field(1_000_000, ge=2)
    """Maximum number of values in a response: loads × radii × quantities."""
    max_batch: int = Field(1_000, ge=1)
    """Maximum number of queries in a batch."""
    max_table_points: int = Field(2_000, ge=2)
    """Maximum number of points of a table."""
    max_transfer_bytes: int = Field(32 * 1024**2, ge=0)
    """Maximum total length of large bodies in memory; a single request may exceed it [bytes]."""
    compute_processes: int = Field(2, ge=1, le=1_000)
    """Number of compute processes."""
    budget_seconds: _Seconds = 10.0
    """Maximum time of a query in a compute process [s]."""
    queue_length: int = Field(64, ge=0)
    """Maximum number of queries that wait for a process."""
    queue_seconds: _Seconds = 4.0
    """Maximum time for which a query waits for a process [s]."""
    request_seconds: _Seconds = 10.0
    """Maximum time for a request to arrive, and for a client to read nothing of a response [s]."""
    cors_origins: Annotated[tuple[_Origin, ...], BeforeValidator(_separated)] = ()
    """Origins allowed by CORS, separated by commas."""

    @property
    def shutdown_seconds(self) -> int:
        """Maximum time for requests in flight after SIGTERM [s]."""
        return ceil(self.queue_seconds + self.budget_seconds) + 1


def from_environment(environment: Mapping[str, str]) -> Settings:
    """Return the settings in `environment`, with defaults for the rest.

    An invalid setting terminates the process at its start, with one line per error.
    """
    given = {
        name: environment[PREFIX + name.upper()]
        for name in Settings.model_fields
        if PREFIX + name.upper() in environment
    }
    try:
        return Settings.model_validate(given)
    except ValidationError as error:
        found = [(str(each["loc"][0]), each["msg"]) for each in error.errors()]
        lines = [f"{PREFIX}{name.upper()}: {message}" for name, message in found]
        raise SystemExit("\n".join(lines)) from None


SETTINGS: Final = from_environment(os.environ)
