"""The allocator of the C library."""

import ctypes
from typing import Final

# Numbers of M_TRIM_THRESHOLD and M_MMAP_THRESHOLD. Source: glibc's malloc.h.
_TRIM, _MMAP = -1, -3
# The largest size from which arrays are mapped that glibc adapts itself to [bytes]; it then trims
# the heap at twice that. Source: man 3 mallopt.
_LARGEST: Final = 32 * 2**20


def keep_freed_memory() -> None:
    """Let the process keep up to 64 MiB of freed memory for its next arrays.

    By default glibc returns the top of the heap to the system as soon as 128 KiB of it are free,
    until a larger array happens to have been freed. A query then spends up to 40 % of its time on
    fresh memory pages. Other C libraries are left as they are.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt:
        mallopt(_MMAP, _LARGEST)
        mallopt(_TRIM, 2 * _LARGEST)
