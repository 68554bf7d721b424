"""Queries by GET: the parameters of `query_parameters` in the URL."""

from collections.abc import Awaitable, Callable
from hashlib import blake2b
from typing import Annotated, Any, Final

from fastapi import APIRouter, Depends, Query, Request
from starlette.responses import Response

from mdr_service.api.documentation import GET_RESPONSES
from mdr_service.api.queries import Responder, url_parameters
from mdr_service.middleware import header
from mdr_service.query_parameters import PARAMETERS
from mdr_service.schemas.queries import SCHEMAS

# A response depends on the query and on the version of the service alone.
_CACHE_CONTROL: Final = "max-age=3600"


def _cacheable(request: Request, response: Response) -> Response:
    """Return the response with a validator, or 304 if the client has it already.

    The tag is weak, since a proxy may compress the same numbers.
    """
    digest = blake2b(response.body, digest_size=16).hexdigest()
    headers = {"ETag": f'W/"{digest}"', "Cache-Control": _CACHE_CONTROL, "Vary": "Accept"}
    known = header(request.scope, b"if-none-match")
    tags = {tag.strip().removeprefix("W/") for tag in known.split(",")}
    if tags & {f'"{digest}"', "*"}:
        return Response(status_code=304, headers=headers)
    response.headers.update(headers)
    return response


def _endpoint(name: str, model: Any) -> Callable[..., Awaitable[Response]]:
    async def get(parameters: Annotated[model, Query()], request: Request) -> Response:
        """Return the response of `POST` for numbers and at most one range.

        A range `..._from`, `..._to` and `n` stands for a list of `n` numbers.
        """
        respond = Responder(request, parameters.format, parameters.size)
        with parameters.pointing():
            response = await respond(name, parameters.query(), parameters.members)
        return _cacheable(request, response)

    return get


_TITLES: Final = {
    "normal": "Normal contact",
    "tangential": "Partial slip",
    "history": "Cycles of the tangential load",
    "stress": "Fields over the radius",
    "wear": "Limiting state of fretting wear",
}
router = APIRouter(responses=GET_RESPONSES, dependencies=[Depends(url_parameters)])
for _name, _title in _TITLES.items():
    router.get(
        SCHEMAS[_name].path,
        operation_id=f"get_{_name}",
        tags=[SCHEMAS[_name].tag],
        summary=f"{_title} by parameters, for spreadsheets and browsers",
        response_model=SCHEMAS[_name].answer,
    )(_endpoint(_name, PARAMETERS[_name]))
