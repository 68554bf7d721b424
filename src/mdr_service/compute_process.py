"""A compute process: its handle in the server, and the loop that it runs.

Calls and outcomes are preceded by their length, and pickled unless they are bytes. The process sets
an alarm for the time limit of a call, whose default action terminates it during any computation. A
process that still exists after the limit is stopped or hung, and is killed.
"""

import os
import pickle
import signal
import struct
import sys
import threading
import traceback
from asyncio import StreamReader, StreamWriter, create_subprocess_exec, subprocess, timeout
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager, nullcontext, suppress
from time import sleep
from typing import Any, Final, Self, TypeVar, cast

from anyio import CancelScope

from mdr_core.errors import DefectError
from mdr_service import problems
from mdr_service.problems import ServiceError

_Result = TypeVar("_Result")
Room = Callable[[int], AbstractAsyncContextManager[None]]
"""Context in which a result of a given length is read; it raises ServiceError to reject that."""

# Before each message: whether it is bytes rather than a pickle, and its length.
_HEAD: Final = struct.Struct("?Q")
# Length above which a result is read in the room that `Room` provides [bytes].
_LARGE: Final = 65_536
# Time for the alarm to take effect, or for the outcome to be read, on a busy machine.
_GRACE_SECONDS: Final = 1.0
# Interval at which a process checks that its parent exists.
_PARENT_SECONDS: Final = 0.5
# With fewer cores than processes, the event loop has priority.
_NICENESS: Final = 5


class ProcessLostError(Exception):
    """The process ended or did not respond."""


class ComputeProcess:
    """Handle of a compute process, `usable` until a call takes too long or is cancelled."""

    def __init__(self, process: subprocess.Process, room: Room) -> None:
        self._process = process
        self._room = room
        self._calls = cast("StreamWriter", process.stdin)
        self._outcomes = cast("StreamReader", process.stdout)
        self.usable = True

    @classmethod
    async def start(cls, seconds: float, self_test: Callable[[], object], room: Room) -> Self:
        """Start a process.

        Raises OSError if it cannot be started, and the errors of `call`.

        Parameters
        ----------
        seconds : time limit of the start.
        self_test : function that is called in the process, and raises an error if it is unusable.
        room : context for the time in which a large result is read.
        """
        # More BLAS threads than cores slow each other down. Modules are found as in the server.
        environment = {"OPENBLAS_NUM_THREADS": "1", **os.environ}
        environment["PYTHONPATH"] = os.pathsep.join(sys.path)
        command = (sys.executable, "-P", "-c", f"from {__name__} import serve; serve()")
        pipe = subprocess.PIPE
        process = cls(
            await create_subprocess_exec(*command, env=environment, stdin=pipe, stdout=pipe), room
        )
        try:
            await process.call(seconds, self_test)
        except BaseException:
            with CancelScope(shield=True):
                await process.close()
            raise
        return process

    async def call(
        self, seconds: float, function: Callable[..., _Result], *arguments: Any
    ) -> _Result:
        """Return the result of a function of a module, computed in the process.

        Raises
        ------
        ServiceError : if the function fails with a problem document, or its result has no room.
        DefectError : if it fails otherwise.
        TimeoutError : if it takes longer than `seconds`.
        ProcessLostError : if the process ends or does not respond.
        """
        message = pickle.dumps((seconds, function, arguments))
        try:
            async with timeout(seconds + _GRACE_SECONDS):
                outcome = await self._exchange(message)
        except TimeoutError:
            self.kill()
            raise ProcessLostError from None
        except BaseException:
            self.kill()
            raise
        if isinstance(outcome, Exception):
            raise outcome
        return cast("_Result", outcome)

    async def _exchange(self, message: bytes) -> object:
        """Return the result of a call, or the exception to raise in place of it."""
        try:
            self._calls.writelines((_HEAD.pack(0, len(message)), message))
            await self._calls.drain()
            is_bytes, length = _HEAD.unpack(await self._outcomes.readexactly(_HEAD.size))
            try:
                async with self._room(length) if length > _LARGE else nullcontext():
                    outcome = await self._outcomes.readexactly(length)
            except ServiceError as error:
                for begin in range(0, length, _LARGE):
                    await self._outcomes.readexactly(min(_LARGE, length - begin))
                return error
            # The pipe's other end is the server's own code.
            return outcome if is_bytes else pickle.loads(outcome)  # noqa: S301
        except (EOFError, OSError):
            # A signal to a process that is ending would compete with its exit status.
            await self._process.wait()
            self.kill()
            by_alarm = self._process.returncode == -signal.SIGALRM
            return TimeoutError() if by_alarm else ProcessLostError()

    def kill(self) -> None:
        """Terminate the process at once."""
        self.usable = False
        self._calls.close()
        with suppress(ProcessLookupError):
            self._process.kill()

    async def close(self) -> None:
        """Terminate the process and wait for its end."""
        self.kill()
        await self._process.wait()


def serve() -> None:
    """Compute until the server closes the pipe or ends."""
    # A signal to the process group is for the server, which first completes its requests.
    for each in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)
    os.nice(_NICENESS)
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    calls, outcomes = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    # The pipe is for outcomes alone: printed text goes to standard error.
    os.dup2(2, 1)
    while head := calls.read(_HEAD.size):
        outcome = _attempt(calls.read(_HEAD.unpack(head)[1]))
        is_bytes = isinstance(outcome, bytes)
        content = outcome if is_bytes else pickle.dumps(outcome)
        signal.setitimer(signal.ITIMER_REAL, 0)
        outcomes.writelines((_HEAD.pack(is_bytes, len(content)), content))
        outcomes.flush()


def _attempt(text: bytes) -> Any:
    """Return the result of a call, or an exception that pickles."""
    try:
        # The pipe's other end is the server's own code.
        seconds, function, arguments = pickle.loads(text)  # noqa: S301
        signal.setitimer(signal.ITIMER_REAL, seconds)
        return function(*arguments)
    except problems.FAILURES as error:
        return problems.to_problem(error)
    except Exception:  # noqa: BLE001 -- the server logs it and responds
        return DefectError(f"in a compute process: {traceback.format_exc()}")


def _end_with(parent: int) -> None:
    while os.getppid() == parent:
        sleep(_PARENT_SECONDS)
    os._exit(1)
