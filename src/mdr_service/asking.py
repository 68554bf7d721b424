"""How a request becomes a question, and the answer a response."""

from hashlib import blake2b
from typing import Final

from fastapi import Request
from starlette.responses import Response

from mdr_service import address, batch, body, cost, forms, headers, problems, questions, wire
from mdr_service.compute import COMPUTE
from mdr_service.questions import QUESTIONS, Answer
from mdr_service.schemas.batch import BatchQuery
from mdr_service.schemas.queries import Query

# What is answered depends on what is asked, and on the version of the service alone.
_KEPT: Final = "max-age=3600"
_LONG_BODY: Final = 500_000


async def posted(request: Request, name: str) -> Response:
    """Return the answer to the question `name` that the body holds."""
    question = QUESTIONS[name]
    media_type = _form(request, question.media_types, _format(request))
    query = wire.read(question.model, await _body(request))
    return _sent(await _answer(name, query, media_type))


async def got(request: Request, name: str) -> Response:
    """Return the answer to the question `name` that the address holds."""
    question = QUESTIONS[name]
    given = address.split(_query_string(request))
    media_type = _form(request, question.media_types, given.get(address.FORMAT))
    text = address.request(name, given)
    try:
        found = await _answer(name, wire.read(question.model, text), media_type)
    except problems.FAILURES as error:
        raise address.pointed(problems.told(error), name, given) from None
    return _kept(request, _sent(found))


async def batched(request: Request) -> Response:
    """Return the answers to all queries of a batch."""
    _form(request, (wire.MEDIA_TYPE,), _format(request))
    asked = batch.read(wire.read(BatchQuery, await _body(request)))
    tried, seconds = batch.priced(asked, COMPUTE.most_seconds, COMPUTE.slowness)
    content = await COMPUTE.run(seconds, batch.answer, tried)
    return _sent(Answer(content, wire.MEDIA_TYPE))


async def _body(request: Request) -> bytes:
    text = await body.read(request)
    # What is this long is not answered at once, and takes milliseconds to be parsed.
    if len(text) > _LONG_BODY:
        COMPUTE.require_room()
    return text


async def _answer(name: str, query: Query, media_type: str) -> Answer:
    seconds = cost.seconds(name, query, media_type)
    if seconds > COMPUTE.most_seconds:
        raise cost.too_costly(name, query, media_type, COMPUTE.most_seconds, COMPUTE.slowness)
    return await COMPUTE.run(seconds, questions.answer, name, query, media_type)


def _format(request: Request) -> str | None:
    query_string = _query_string(request)
    return address.only_format(query_string) if query_string else None


def _query_string(request: Request) -> str:
    # The request's `url` puts the whole address together first.
    found: bytes = request.scope["query_string"]
    return found.decode("latin-1")


def _form(request: Request, offered: tuple[str, ...], name: str | None) -> str:
    """Return the media type that is asked for: by name, or else by what is accepted."""
    if name is not None:
        return forms.named(name, offered)
    return forms.accepted(headers.first(request.scope, b"accept", "*/*"), offered)


def _sent(answer: Answer) -> Response:
    return Response(answer.content, media_type=answer.media_type)


def _kept(request: Request, response: Response) -> Response:
    """Return the response with what caches need, and without what the client has already.

    The tag is weak: the same numbers may be sent compressed as well.
    """
    digest = blake2b(response.body, digest_size=16).hexdigest()
    told = {"ETag": f'W/"{digest}"', "Cache-Control": _KEPT, "Vary": "Accept"}
    known = headers.first(request.scope, b"if-none-match")
    tags = {tag.strip().removeprefix("W/") for tag in known.split(",")}
    if tags & {f'"{digest}"', "*"}:
        return Response(status_code=304, headers=told)
    response.headers.update(told)
    return response
