"""Single headers of a request."""

from starlette.types import Scope


def first(scope: Scope, name: bytes, default: str = "") -> str:
    """Return the first header of this name, in small letters as the server gives them.

    The framework's own mapping of all headers takes longer to put together than to look through.
    """
    for each, value in scope["headers"]:
        if each == name:
            found: str = value.decode("latin-1")
            return found
    return default
