"""What this process allows, read once from the environment (prefix ``MDR_``).

The sizes are part of the request models (a list that is too long is refused while it is being
parsed, and OpenAPI shows the bound), so they are fixed when the service starts.
"""

import os
from collections.abc import Mapping
from typing import Final, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

PREFIX: Final = "MDR_"


class Settings(BaseModel):
    """Limits of one process; each is set by ``MDR_`` and its name in capitals."""

    model_config = ConfigDict(frozen=True)

    max_body_bytes: int = Field(
        default=4 * 1024**2, ge=1024, description="Longest request body, in bytes."
    )
    max_loads: int = Field(default=100_000, ge=1, description="Most loads in one request.")
    max_radii: int = Field(
        default=100_000, ge=2, description="Most radii at which fields are asked for."
    )
    max_numbers: int = Field(
        default=1_000_000, ge=2, description="Most loads times radii in one request."
    )
    max_samples: int = Field(
        default=100_000, ge=1, description="Most points times samples_per_step of a history."
    )
    max_cycles: int = Field(
        default=100_000, ge=1, description="Most cycles of a history, or numbers of cycles of wear."
    )
    max_batch: int = Field(default=1_000, ge=1, description="Most queries in one batch.")
    max_table_points: int = Field(
        default=2_000, ge=2, description="Most points of a tabulated profile."
    )
    max_series_terms: int = Field(default=100, ge=1, description="Most terms of a series profile.")
    compute_processes: int = Field(
        default=2, ge=1, le=1_000, description="Processes that longer queries are answered by."
    )
    budget_seconds: float = Field(
        default=10.0,
        gt=0,
        le=86_400,
        description="How long one request may be worked on; what is estimated to take more than "
        "half of it is refused beforehand.",
    )
    queue_length: int = Field(
        default=16, ge=0, description="Most requests that wait for a process."
    )
    queue_seconds: float = Field(
        default=4.0,
        gt=0,
        le=86_400,
        description="How long one request may wait for a process; what is estimated to wait more "
        "than half of it is refused beforehand.",
    )
    body_seconds: float = Field(
        default=10.0, gt=0, le=86_400, description="How long a request's body may take to arrive."
    )
    shutdown_seconds: int = Field(
        default=15,
        ge=1,
        description="How long requests in flight may take after SIGTERM; more than waiting and "
        "work together.",
    )

    @model_validator(mode="after")
    def _ends_in_time(self) -> Self:
        if self.shutdown_seconds <= self.budget_seconds + self.queue_seconds:
            raise PydanticCustomError(
                "shutdown", "must be more than MDR_BUDGET_SECONDS and MDR_QUEUE_SECONDS together"
            )
        return self


def from_environment(environment: Mapping[str, str]) -> Settings:
    """Return the settings that `environment` asks for, defaults for the rest.

    A setting that makes no sense ends the process: nobody would notice it later.
    """
    given = {
        name: environment[PREFIX + name.upper()]
        for name in Settings.model_fields
        if PREFIX + name.upper() in environment
    }
    try:
        return Settings.model_validate(given)
    except ValidationError as error:
        raise SystemExit(_complaint(error)) from None


def _complaint(error: ValidationError) -> str:
    # What is about no single setting is about the last one of them, which has to follow the others.
    faults = [((*fault["loc"], "shutdown_seconds")[0], fault["msg"]) for fault in error.errors()]
    return "\n".join(f"{PREFIX}{str(name).upper()}: {message}" for name, message in faults)


SETTINGS: Final = from_environment(os.environ)
