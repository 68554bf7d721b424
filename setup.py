"""Compiles the one sequential loop where a C compiler is found; the rest is in pyproject.toml.

Without a compiler, or with MDR_PLAIN=1 in the environment, the uncompiled text of the loop is
installed instead. On one processor its results are bit-identical.
"""

import os

from Cython.Build import cythonize
from setuptools import Extension, setup


def extensions() -> list[Extension]:
    """Return the compiled module, none for a wheel of Python text alone."""
    if os.environ.get("MDR_PLAIN"):
        return []
    modules = cythonize(
        Extension(
            "mdr_core.history.slip_kernel",
            ["src/mdr_core/history/slip_kernel.py"],
            # Without fused multiply-add the digits are those of the uncompiled text.
            extra_compile_args=["-O3", "-ffp-contract=off"],
        ),
        build_dir="build",
        compiler_directives={
            "language_level": 3,
            "boundscheck": False,
            "wraparound": False,
            "cdivision": True,
            "initializedcheck": False,
            "infer_types": True,
            # The types are those of slip_kernel.pxd.
            "annotation_typing": False,
        },
    )
    for module in modules:
        # A failure to compile is a warning. Cython drops this argument of an extension.
        module.optional = True
    return modules


setup(ext_modules=extensions())
