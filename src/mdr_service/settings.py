"""What this process allows, read once from the environment (prefix ``MDR_``).

The sizes are part of the request models (a list that is too long is refused while it is being
parsed, and OpenAPI shows the bound), so they are fixed when the service starts.
"""

import os
from collections.abc import Mapping
from typing import Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError

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
    max_curved_samples: int = Field(
        default=1_000,
        ge=1,
        description="Most of them where a depth and a tangential force change, or a normal force "
        "and a displacement.",
    )
    max_evaluations: int = Field(
        default=2_000_000,
        ge=100_000,
        description="Most values of a profile that following its wear over the cycles takes, as "
        "estimated beforehand; a million take some seconds.",
    )
    max_batch: int = Field(default=1_000, ge=1, description="Most queries in one batch.")
    max_table_points: int = Field(
        default=2_000, ge=2, description="Most points of a tabulated profile."
    )
    max_series_terms: int = Field(default=100, ge=1, description="Most terms of a series profile.")
    shutdown_seconds: int = Field(
        default=15, ge=1, description="How long requests in flight may take after SIGTERM."
    )


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
    faults = error.errors(include_url=False)
    return "\n".join(f"{PREFIX}{str(fault['loc'][0]).upper()}: {fault['msg']}" for fault in faults)


SETTINGS: Final = from_environment(os.environ)
