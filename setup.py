"""Compiles the one sequential loop where a C compiler is found; the rest is in pyproject.toml.

With SOURCE_DATE_EPOCH, the seconds of a time, the distributions are the same bytes wherever they
are built from the same files by the same tools.

Without a compiler, or with MDR_PLAIN=1 in the environment, the uncompiled text of the loop is
installed instead. On one processor its results are bit-identical.
"""

import gzip
import os
import tarfile
from pathlib import Path

from Cython.Build import cythonize
from setuptools import Extension, setup
from setuptools.command.sdist import sdist


def extensions() -> list[Extension]:
    """Return the compiled module, none for a wheel of Python text alone."""
    if os.environ.get("MDR_PLAIN"):
        return []
    modules = cythonize(
        Extension(
            "mdr_core.history.slip_kernel",
            ["src/mdr_core/history/slip_kernel.py"],
            # Without fused multiply-add the digits are those of the uncompiled text.
            # Debugging symbols, most of the file, hold the name of the folder it was built in.
            extra_compile_args=["-O3", "-ffp-contract=off", "-g0"],
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


class SourceDistribution(sdist):
    """Source distribution; setuptools would write the time of the build into the archive."""

    def make_archive(self, base_name: str, *given: str | None, **named: str | None) -> str:
        """Return the name of the archive, written with SOURCE_DATE_EPOCH as time of all files."""
        epoch = os.environ.get("SOURCE_DATE_EPOCH")
        if epoch is None:
            return str(super().make_archive(base_name, *given, **named))

        def dated(member: tarfile.TarInfo) -> tarfile.TarInfo:
            member.mtime, member.mode = int(epoch), 0o755 if member.mode & 0o100 else 0o644
            member.uid = member.gid = 0
            member.uname = member.gname = ""
            return member

        target = Path(f"{base_name}.tar.gz")
        with (
            target.open("wb") as stream,
            gzip.GzipFile("", "wb", fileobj=stream, mtime=int(epoch)) as packed,
            tarfile.open(fileobj=packed, mode="w") as archive,
        ):
            archive.add(str(named["base_dir"]), filter=dated)
        return str(target)


setup(ext_modules=extensions(), cmdclass={"sdist": SourceDistribution})
