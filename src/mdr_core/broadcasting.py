"""Parts of a profile whose parameters are arrays over the cases of a sweep."""

from collections.abc import Mapping
from typing import Any

from mdr_core.profiles import Profile


def with_parameters(profile: Profile, parameters: Mapping[str, Any]) -> Profile:
    """Return the profile with some parameters replaced, without a check."""
    if not parameters:
        return profile
    part = object.__new__(type(profile))
    vars(part).update({**profile.parameters, **parameters})
    return part
