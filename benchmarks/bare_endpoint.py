"""Minimal FastAPI reference of the wire benchmarks: `python bare_endpoint.py PORT`.

It validates the body of `/v1/normal` or `/v1/stress` with the service's model and returns
constants, with the same event loop and parser as the service; `/small` validates a small model.
"""

import sys
from typing import Any

import orjson
import uvicorn
from fastapi import FastAPI, Response
from pydantic import BaseModel
from stress_wire_ratio import QUERY

from mdr_service.queries import QUERIES
from mdr_service.schemas.contacts import NormalQuery
from mdr_service.schemas.fields import StressQuery

CONSTANT = {"contact_radius": 1.0}

_STRESS = StressQuery.model_validate(QUERY)
_RESULT = QUERIES["stress"].result(_STRESS, QUERIES["stress"].solve(_STRESS))
FIELDS = {name: _RESULT[name] for name in QUERY["quantities"]}


class Small(BaseModel):
    """Members that every query has."""

    profile: dict[str, Any]
    material: dict[str, Any]


app = FastAPI(openapi_url=None)


@app.post("/dict")
async def plain(query: NormalQuery):
    return CONSTANT


# With a declared response model pydantic serialises the response, the framework's fastest way.
@app.post("/declared")
async def declared(query: NormalQuery) -> dict[str, float]:
    return CONSTANT


@app.post("/small")
async def small(query: Small) -> dict[str, float]:
    return CONSTANT


@app.post("/stress")
async def stress(query: StressQuery) -> Response:
    # All arrays of the service's response, of which the radii are those of the request.
    arrays = {name: rows[:, : query.radii] for name, rows in FIELDS.items()}
    return Response(
        orjson.dumps({"radius": query.radius} | arrays, option=orjson.OPT_SERIALIZE_NUMPY),
        media_type="application/json",
    )


if __name__ == "__main__":
    uvicorn.run(
        app,
        host="127.0.0.1",
        port=int(sys.argv[1]),
        loop="asyncio",
        http="h11",
        log_level="warning",
        server_header=False,
        access_log=False,
        lifespan="off",
        ws="none",
    )
