"""The allocator of the C library."""

import ctypes
from typing import Final

# Parameters of mallopt in glibc's malloc.h.
_TRIM_THRESHOLD: Final = -1
_MMAP_THRESHOLD: Final = -3
# The largest threshold that glibc adapts itself to, and the trim threshold that it then sets
# [bytes]. Source: man 3 mallopt.
_LARGEST: Final = 32 * 2**20
_TRIM: Final = 2 * _LARGEST


def keep_freed_memory() -> None:
    """Let the process keep up to 64 MiB of freed memory for its next arrays.

    By default glibc returns the top of the heap to the system as soon as 128 KiB of it are free,
    until a larger array happens to have been freed. A query then spends up to 40 % of its time on
    fresh memory pages. Other C libraries are left as they are.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt:
        mallopt(_MMAP_THRESHOLD, _LARGEST)
        mallopt(_TRIM_THRESHOLD, _TRIM)
