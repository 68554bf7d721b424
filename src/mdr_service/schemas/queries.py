"""The queries: path, request and response of each, by its name."""

from typing import Final, NamedTuple

from mdr_service.schemas import answers
from mdr_service.schemas.answers import Answer
from mdr_service.schemas.contacts import NormalQuery, Query, TangentialQuery
from mdr_service.schemas.fields import StressQuery
from mdr_service.schemas.fits import FitQuery
from mdr_service.schemas.impacts import ImpactQuery
from mdr_service.schemas.load_paths import HistoryQuery
from mdr_service.schemas.subsurface import SubsurfaceQuery
from mdr_service.schemas.wear import EvolutionQuery, WearQuery


class QuerySchema(NamedTuple):
    """Path of a query, and models of its request and its response."""

    path: str
    model: type[Query]
    answer: type[Answer]


SCHEMAS: Final = {
    "normal": QuerySchema("/v1/normal", NormalQuery, answers.NormalAnswer),
    "tangential": QuerySchema("/v1/tangential", TangentialQuery, answers.TangentialAnswer),
    "history": QuerySchema("/v1/tangential/history", HistoryQuery, answers.HistoryAnswer),
    "fit": QuerySchema("/v1/normal/fit", FitQuery, answers.FitAnswer),
    "impact": QuerySchema("/v1/tangential/impact", ImpactQuery, answers.ImpactAnswer),
    "stress": QuerySchema("/v1/stress", StressQuery, answers.StressAnswer),
    "subsurface": QuerySchema("/v1/subsurface", SubsurfaceQuery, answers.SubsurfaceAnswer),
    "wear": QuerySchema("/v1/wear", WearQuery, answers.WearAnswer),
    "evolution": QuerySchema("/v1/wear/evolution", EvolutionQuery, answers.EvolutionAnswer),
}
