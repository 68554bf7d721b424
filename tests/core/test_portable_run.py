"""`make test-portable` computes without AVX2 and without the compiled module."""

import os
import platform
import subprocess
import sys
from importlib.machinery import SOURCE_SUFFIXES
from pathlib import Path

import numpy as np
import pytest

from mdr_core.history import slip_kernel

pytestmark = pytest.mark.skipif(
    "PORTABLE_RUN" not in os.environ, reason="the run uses the whole processor"
)

SWITCHES = ("NPY_DISABLE_CPU_FEATURES", "GLIBC_TUNABLES", "OPENBLAS_CORETYPE")
# Digits of the math module, which is that of glibc, of NumPy and of BLAS.
DIGITS = """
import math, numpy, zlib
x = numpy.linspace(0.1, 3.0, 1024).reshape(32, 32)
for result in (numpy.array([math.exp(each) for each in x.flat]), numpy.tanh(x), x @ x):
    print(zlib.crc32(result.tobytes()))
"""


def digits(environment: dict[str, str]) -> list[str]:
    command = [sys.executable, "-c", DIGITS]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return run.stdout.split()


def test_loop_is_not_compiled() -> None:
    assert Path(slip_kernel.__file__).suffix in SOURCE_SUFFIXES


def test_numpy_dispatches_to_no_vector_unit() -> None:
    units = np.show_config("dicts").get("SIMD Extensions", {})
    assert "found" not in units


@pytest.mark.skipif(
    platform.libc_ver()[0] != "glibc" or "fma" not in Path("/proc/cpuinfo").read_text().split(),
    reason="the switches of glibc and OpenBLAS need an x86 processor with AVX2",
)
def test_digits_are_those_of_another_processor() -> None:
    whole = {name: value for name, value in os.environ.items() if name not in SWITCHES}
    for reduced, full in zip(digits(dict(os.environ)), digits(whole), strict=True):
        assert reduced != full
