"""Serve the least that a FastAPI service can do: `python bare_endpoint.py PORT`.

It validates the body of `/v1/normal` by the same model and returns a constant, with the same
event loop and parser as the service.
"""

import sys

import uvicorn
from fastapi import FastAPI

from mdr_service.schemas.queries import NormalQuery

CONSTANT = {"contact_radius": 1.0}

app = FastAPI(openapi_url=None)


@app.post("/dict")
async def plain(query: NormalQuery):
    return CONSTANT


# Declared, the answer is written by pydantic, which is the framework's fastest way.
@app.post("/declared")
async def declared(query: NormalQuery) -> dict[str, float]:
    return CONSTANT


if __name__ == "__main__":
    uvicorn.run(
        app,
        host="127.0.0.1",
        port=int(sys.argv[1]),
        loop="uvloop",
        http="httptools",
        log_level="warning",
        server_header=False,
        access_log=False,
        lifespan="off",
        ws="none",
    )
