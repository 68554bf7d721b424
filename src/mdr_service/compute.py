"""Where a query runs, so that a long one does not keep the short ones waiting."""

from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

from anyio import to_thread

_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")

# So few loads and points of a table take milliseconds at most; the usual single load takes less
# time than handing it to a thread and back.
_AT_ONCE: Final = 100


async def run(
    numbers: int,
    work: Callable[_Arguments, _Result],
    *arguments: _Arguments.args,
    **named: _Arguments.kwargs,
) -> _Result:
    """Return what `work` returns: at once if it is about few `numbers`, else by a thread."""
    if numbers <= _AT_ONCE:
        return work(*arguments, **named)
    return await to_thread.run_sync(lambda: work(*arguments, **named))
