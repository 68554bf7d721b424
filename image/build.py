"""Stand-ins of the official bases, bootstrapped from Debian, and the image built on them."""

import ast
import configparser
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
NAME: Final = "mdr"

_BUNDLE: Final = "/etc/ssl/certs/ca-certificates.crt"
_PYTHON: Final = ("ca-certificates", "python3", "python3-venv")
_COMPILER: Final = ("gcc", "libc6-dev", "python3-dev")


class Builder:
    """Builds in a directory of its own, which is all that it leaves behind."""

    def __init__(self, work: Path) -> None:
        self._work = work
        self._log = work / "log"
        self._store = ("buildah", "--root", str(work / "storage"), "--runroot", str(work / "run"))

    def lint(self) -> None:
        """Install hadolint by its hash, and have it read the Dockerfile."""
        self._do(sys.executable, "-m", "venv", str(self._tools))
        python = str(self._tools / "bin" / "python")
        lock = str(ROOT / "image" / "hadolint.lock")
        self._do(python, "-m", "pip", "install", "--require-hashes", "--requirement", lock)
        self._do(str(self._tools / "bin" / "hadolint"), str(ROOT / "Dockerfile"))

    def bootstrap(self) -> list[str]:
        """Make what the Dockerfile begins with, under its official names; return these."""
        names = re.findall(r"^FROM (\S+)", (ROOT / "Dockerfile").read_text("utf-8"), re.MULTILINE)
        for name in names:
            packages = _PYTHON if "-slim-" in name else _PYTHON + _COMPILER
            tree = self._work / "base.tar"
            self._debootstrap(name.rpartition("-")[2], packages, tree)
            container = self._buildah("from", "scratch")
            self._buildah("add", "--quiet", container, str(tree), "/")
            self._buildah("commit", "--quiet", "--format", "docker", container, _official(name))
            self._buildah("rm", container)
            tree.unlink()
        return names

    def build(self) -> None:
        """Build the image with the host's own way to packages, of which nothing stays in it."""
        settings, bundle = self._pip_settings()
        self._buildah(
            *("bud", "--pull-never", "--format", "docker", "--tag", NAME),
            *("--volume", f"{settings}:/etc/pip.conf:ro", "--volume", f"{bundle}:{_BUNDLE}:ro"),
            str(ROOT),
        )

    def config(self) -> dict[str, Any]:
        """Return what the image says of itself."""
        inspected = json.loads(self._buildah("inspect", "--type", "image", NAME))
        config: dict[str, Any] = inspected["Docker"]["config"]
        return config

    def mounted(self, name: str = NAME) -> Path:
        """Return where the file system of a new container of the image is."""
        return Path(self._buildah("mount", self._buildah("from", "--pull-never", name)))

    def remove(self) -> None:
        """Remove all containers and images."""
        for words in (("umount", "--all"), ("rm", "--all"), ("rmi", "--all", "--force")):
            subprocess.run((*self._store, *words), capture_output=True, check=False)

    @property
    def _tools(self) -> Path:
        return self._work / "tools"

    def _debootstrap(self, suite: str, packages: tuple[str, ...], tree: Path) -> None:
        mirrors = _mirrors(suite)
        options = self._work / "apt.conf"
        options.write_text(_apt_settings(), "utf-8")
        self._do(
            *("mmdebstrap", "--variant=minbase", f"--include={','.join(packages)}"),
            *(f"--aptopt={options}", "--dpkgopt=force-unsafe-io"),
            '--customize-hook=ln -s /usr/bin/python3 "$1/usr/local/bin/python"',
            *(suite, str(tree), *(["-"] if mirrors else [])),
            text="\n".join(mirrors),
        )

    def _pip_settings(self) -> tuple[Path, str]:
        """Return a file of what pip is told on this host, and its authorities' certificates."""
        listing = self._do(str(self._tools / "bin" / "python"), "-m", "pip", "config", "list")
        settings = configparser.RawConfigParser()
        # As for pip itself, the environment has the last word.
        for line in sorted(listing.splitlines(), key=lambda line: line.startswith(":env:")):
            key, _, value = line.partition("=")
            section, _, option = key.rpartition(".")
            section = "global" if section == ":env:" else section
            if not settings.has_section(section):
                settings.add_section(section)
            settings.set(section, option, ast.literal_eval(value))
        if not settings.has_section("global"):
            settings.add_section("global")
        bundle = settings.get("global", "cert", fallback=_BUNDLE)
        settings.set("global", "cert", _BUNDLE)
        path = self._work / "pip.conf"
        with path.open("w", encoding="utf-8") as file:
            settings.write(file)
        return path, bundle

    def _buildah(self, *words: str) -> str:
        return self._do(*self._store, *words, environment={"BUILDAH_ISOLATION": "chroot"})

    def _do(self, *words: str, text: str = "", environment: Mapping[str, str] | None = None) -> str:
        """Run a program and return what it wrote; end with all it said if it fails."""
        with self._log.open("w+", encoding="utf-8") as log:
            done = subprocess.run(
                words,
                input=text,
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                check=False,
                env={**os.environ, **(environment or {})},
            )
            if done.returncode:
                log.seek(0)
                raise SystemExit(f"{done.stdout}{log.read()}\n{' '.join(words)} failed")
        return done.stdout.strip()


def _official(name: str) -> str:
    return f"docker.io/library/{name}"


def _mirrors(suite: str) -> list[str]:
    """Return where this host gets this Debian from; nothing if it gets none of it."""
    if not shutil.which("apt-get"):
        return []
    words = (
        *("apt-get", "indextargets", "--format", "deb $(REPO_URI) $(RELEASE) main"),
        *("Created-By: Packages", "Origin: Debian"),
    )
    lines = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()
    return sorted({line for line in lines if line.split()[2].partition("-")[0] == suite})


def _apt_settings() -> str:
    """Return how this host's apt reaches its mirrors: proxies, certificates, dates."""
    if not shutil.which("apt-config"):
        return ""
    words = ("apt-config", "dump")
    lines = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()
    return "\n".join(line for line in lines if re.match(r"Acquire::(https?|Check)\b", line))
