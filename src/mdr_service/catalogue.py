"""The kinds of profile, as the service lists them."""

from collections.abc import Mapping

from mdr_core import profiles
from mdr_core.errors import DefectError
from mdr_service.schemas.answers import Catalogue, ProfileField, ProfileKind
from mdr_service.schemas.profiles import MODELS
from mdr_service.schemas.quantities import Strict


def listed() -> Catalogue:
    """Return every kind of profile with its formula, its fields and its closed forms."""
    return Catalogue(
        profiles=[
            ProfileKind(
                kind=kind,
                formula=known.formula,
                fields=_profile_fields(model),
                closed_forms=list(known.closed_forms),
            )
            for (kind, known), model in zip(profiles.KINDS.items(), MODELS, strict=True)
        ]
    )


def _profile_fields(model: type[Strict]) -> list[ProfileField]:
    return [
        ProfileField(
            name=name,
            dimension=_dimension(field.json_schema_extra),
            description=str(field.description).rpartition(" [")[0],
            required=field.is_required(),
        )
        for name, field in model.model_fields.items()
        if name != "kind"
    ]


def _dimension(extra: object) -> str:
    if not isinstance(extra, Mapping):
        raise DefectError("a field without a dimension")
    return str(extra["dimension"])
