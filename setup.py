"""Compiles the one sequential loop; everything else is said in pyproject.toml."""

from Cython.Build import cythonize
from setuptools import Extension, setup

GROW = [
    part
    for limit in ("large-function-growth", "inline-unit-growth", "large-stack-frame-growth")
    for part in ("--param", f"{limit}=100000")
]

setup(
    ext_modules=cythonize(
        Extension(
            "mdr_core.history.walk",
            ["src/mdr_core/history/walk.py"],
            # Without fused multiply-add the digits are those of the uncompiled text; inlined, the
            # arrays' descriptions are not copied from function to function.
            extra_compile_args=["-O3", "-ffp-contract=off", "-finline-limit=20000", *GROW],
        ),
        build_dir="build",
        compiler_directives={
            "language_level": 3,
            "boundscheck": False,
            "wraparound": False,
            "cdivision": True,
            "infer_types": True,
            # The types are those of walk.pxd.
            "annotation_typing": False,
        },
    )
)
