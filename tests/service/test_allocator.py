"""Freed memory that a process keeps for its next arrays."""

import ctypes
import subprocess
import sys

import pytest

PROGRAM = """
import resource

import numpy as np

from mdr_service.allocator import keep_freed_memory


def page_faults():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(50):
        arrays = [np.ones(12_000) for _ in range(40)]
        del arrays
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before


by_default = page_faults()
keep_freed_memory()
page_faults()
print(by_default, page_faults())
"""


@pytest.mark.skipif(
    not hasattr(ctypes.CDLL(None), "mallopt"), reason="the C library is not the GNU one"
)
def test_freed_arrays_leave_no_page_faults_to_the_next_ones() -> None:
    command = [sys.executable, "-c", PROGRAM]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)
    by_default, kept = map(int, answer.stdout.split())
    # 2000 arrays of 24 pages.
    assert by_default > 10_000
    assert kept < 500
