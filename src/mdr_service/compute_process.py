"""A compute process: its handle in the server, and the loop that it runs.

Calls and outcomes are pickled, and preceded by their length.
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
from contextlib import suppress
from time import sleep
from typing import Any, Final, Self, cast

from mdr_core.errors import DefectError
from mdr_service import observability, problems

# Before each message: its length.
_HEAD: Final = struct.Struct("Q")
# A beat takes 75 microseconds; a process that gets no core for this time is unusable as well.
_BEAT_SECONDS: Final = 2.0
# Interval at which a process checks that its parent exists.
_PARENT_SECONDS: Final = 0.5
# With fewer cores than processes, the event loop has priority.
_NICENESS: Final = 5


class ComputeProcess:
    """Handle of a compute process, which is killed if a call does not end as it should."""

    def __init__(self, process: subprocess.Process) -> None:
        self._process = process
        self._calls = cast("StreamWriter", process.stdin)
        self._outcomes = cast("StreamReader", process.stdout)
        self.usable = True
        self.end = "start"
        """Reason for which it will have ended if nothing else happens."""

    @classmethod
    async def start(cls) -> Self:
        """Start a process; raise OSError if the system cannot."""
        # More BLAS threads than cores slow each other down. Modules are found as in the server.
        environment = {"OPENBLAS_NUM_THREADS": "1", **os.environ}
        environment["PYTHONPATH"] = os.pathsep.join(sys.path)
        command = (sys.executable, "-P", "-c", f"from {__name__} import serve; serve()")
        pipe = subprocess.PIPE
        return cls(await create_subprocess_exec(*command, env=environment, stdin=pipe, stdout=pipe))

    async def call(self, seconds: float, function: Callable[..., object], *arguments: Any) -> Any:
        """Return the result of a function of a module, or the exception that it raised.

        Any exception raised here is about the process, which is killed: TimeoutError if the
        function takes longer than `seconds`, others if the process ends.
        """
        message = pickle.dumps((function, arguments))
        try:
            async with timeout(seconds):
                self._calls.writelines((_HEAD.pack(len(message)), message))
                await self._calls.drain()
                (length,) = _HEAD.unpack(await self._outcomes.readexactly(_HEAD.size))
                # The pipe's other end is the server's own code.
                return pickle.loads(await self._outcomes.readexactly(length))  # noqa: S301
        except BaseException:
            self.kill()
            raise

    async def beat(self) -> None:
        """Return if the process responds at once; otherwise kill it and raise an exception."""
        try:
            await self.call(_BEAT_SECONDS, int)
        except TimeoutError:
            raise ConnectionError("the compute process does not respond") from None

    def kill(self) -> None:
        """Terminate the process at once."""
        self.usable = False
        with suppress(ProcessLookupError):
            self._process.kill()

    async def wait(self) -> int:
        """Return the exit status of the process once it has ended."""
        return await self._process.wait()


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
    observability.configure_logging()
    while head := calls.read(_HEAD.size):
        content = pickle.dumps(_attempt(calls.read(*_HEAD.unpack(head))))
        outcomes.writelines((_HEAD.pack(len(content)), content))
        outcomes.flush()


def _attempt(text: bytes) -> Any:
    """Return the result of a call, or an exception that pickles."""
    try:
        # The pipe's other end is the server's own code.
        function, arguments = pickle.loads(text)  # noqa: S301
        return function(*arguments)
    except problems.FAILURES as error:
        return problems.to_problem(error)
    except Exception:  # noqa: BLE001 -- the server logs it and responds
        return DefectError(f"in a compute process: {traceback.format_exc()}")


def _end_with(parent: int) -> None:
    while os.getppid() == parent:
        sleep(_PARENT_SECONDS)
    os._exit(1)
