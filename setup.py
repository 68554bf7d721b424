"""Compiles the one sequential loop; everything else is said in pyproject.toml."""

from Cython.Build import cythonize
from setuptools import Extension, setup

setup(
    ext_modules=cythonize(
        Extension(
            "mdr_core.history.slip_memory_kernel",
            ["src/mdr_core/history/slip_memory_kernel.py"],
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
            # The types are those of slip_memory_kernel.pxd.
            "annotation_typing": False,
        },
    )
)
