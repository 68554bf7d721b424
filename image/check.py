"""Replays the image without a Docker engine: lints, builds, runs, asks and stops it.

Needs root, and mmdebstrap, buildah and runc, which it installs where apt is at hand. What it makes
is in one temporary directory, of some four gigabytes, and is removed in the end.
"""

import os
import re
import shutil
import subprocess
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any, Final

from build import ROOT, Builder
from container import Container

TOOLS: Final = ("mmdebstrap", "buildah", "runc")
# What the Dockerfile gives the health check, and what `MDR_SHUTDOWN_SECONDS` gives the end.
START_SECONDS: Final = 20
STOP_SECONDS: Final = 15 + 1
SEARCH_SECONDS: Final = 60
# Directories that are everybody's; with a read-only root they are not written to either.
EVERYBODYS: Final = {"/tmp", "/var/tmp", "/run/lock"}

failures: list[str] = []


def main() -> None:
    need_root()
    need_tools()
    work = Path(tempfile.mkdtemp(prefix="mdr-image-", dir=os.environ.get("TMPDIR", "/var/tmp")))
    builder = Builder(work)
    try:
        base = build(builder)
        root, config = builder.mounted(), builder.config()
        measure(root, base)
        inspect(work, root, config)
        run(work, root, config)
    finally:
        builder.remove()
        shutil.rmtree(work)
    if failures:
        raise SystemExit(f"failed: {'; '.join(failures)}")


def need_root() -> None:
    if os.geteuid() != 0:
        raise SystemExit("must run as root, for example: sudo --preserve-env make image-check")


def need_tools() -> None:
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing and shutil.which("apt-get"):
        install = ("apt-get", "install", "--yes", "--quiet", "--no-install-recommends", *missing)
        environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
        for words in (("apt-get", "update", "--quiet"), install):
            subprocess.run(words, check=True, stdout=subprocess.DEVNULL, env=environment)
        missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        raise SystemExit(f"missing: {', '.join(missing)}; install the packages of these names")


def build(builder: Builder) -> Path:
    """Build the image; return the file system of what its last stage begins with."""
    start = time.monotonic()
    builder.lint()
    say("hadolint has nothing to say", since=start)
    start = time.monotonic()
    names = builder.bootstrap()
    say(f"bootstrapped stand-ins for {', '.join(names)}", since=start)
    start = time.monotonic()
    builder.build()
    say("built", since=start)
    return builder.mounted(names[-1])


def measure(root: Path, base: Path) -> None:
    """Say how large the image is, and what of it is how large."""
    whole, bare = size(root), size(base)
    parts = Counter[str]()
    for path in site_packages(root).iterdir():
        parts[path.name.removesuffix(".libs")] += size(path)
    largest = ", ".join(f"{name} {megabytes(part)}" for name, part in parts.most_common(9))
    say(f"{megabytes(whole)} MB: the base's stand-in {megabytes(bare)}, and upon it")
    say(f"{megabytes(whole - bare)} MB, of which {largest}")


def inspect(work: Path, root: Path, config: dict[str, Any]) -> None:
    """Look at what the image holds, and at what its user may do with it."""
    user = config["User"]
    check(re.fullmatch(r"[1-9]\d*:[1-9]\d*", user), f"the user is a number, not root: {user}")
    packages = {path.name.lower() for path in site_packages(root).iterdir()}
    left = sorted(packages & {"cython", "setuptools", "pip"})
    left += [path.name for path in root.glob("usr/bin/*gcc*")]
    check(not left, f"no compiler or build tool has stayed in it: {left}")
    compiled = list(site_packages(root).glob("mdr_core/history/walk.*.so"))
    check(compiled, "what is to be compiled is compiled")
    check(not (root / "etc/pip.conf").exists(), "no setting of this host has stayed in it")
    # With a root that can be written, the files' own permissions decide.
    script = "find / -xdev -writable ! -type l 2>/dev/null"
    search = Container(work, root, config, "sh", "-c", script, read_only=False)
    search.status(SEARCH_SECONDS)
    writable = {path for path in search.log().splitlines() if path.startswith("/")}
    search.remove()
    others = sorted(writable - EVERYBODYS)
    check(not others and "/tmp" in writable, f"its user may write nowhere but in /tmp: {others}")
    alone = Container(work, root, config, *health_check(config))
    check(alone.status(START_SECONDS) == 1, "its health check says no where nothing is served")
    alone.remove()


def run(work: Path, root: Path, config: dict[str, Any]) -> None:
    """Start the image as it is meant to be run, ask it, and stop it."""
    start = time.monotonic()
    service = Container(work, root, config)
    try:
        health = health_check(config)
        while service.do(*health).returncode and not service.ended():
            if time.monotonic() > start + START_SECONDS:
                break
            time.sleep(0.1)
        healthy = service.do(*health)
        check(not healthy.returncode, f"its health check says yes {healthy.stderr}", since=start)
        if service.ended():
            raise SystemExit(f"it has ended by itself:\n{service.log()}")
        ask(service, config["User"])
        stop(service)
    finally:
        service.remove()


def health_check(config: dict[str, Any]) -> list[str]:
    """Return the health check's command, which is in the exec form."""
    test: list[str] = config["Healthcheck"]["Test"]
    return test[test.index("CMD") + 1 :]


def ask(service: Container, user: str) -> None:
    """Ask for what should be answered, and try what should not be possible."""
    status = service.do("cat", "/proc/1/status", "/proc/self/mounts").stdout
    uid = user.partition(":")[0]
    check(re.search(rf"^Uid:\s+{uid}\s+{uid}\s", status, re.MULTILINE), f"it runs as {uid}")
    check(re.search(r"^CapBnd:\s+0+$", status, re.MULTILINE), "it has no capability")
    check(re.search(r"^\S+ / \S+ ro,", status, re.MULTILINE), "its root is read-only")
    check(service.do("touch", "/tmp/x").returncode, "it cannot even write to /tmp")
    text = (ROOT / "image" / "ask.py").read_text("utf-8")
    answers = service.do("python", "-I", "-", text=text)
    for line in answers.stdout.splitlines():
        say(line)
    check(not answers.returncode, f"it answers without a network {answers.stderr}")


def stop(service: Container) -> None:
    """Ask it to stop, and look at how it does."""
    start = time.monotonic()
    service.terminate()
    status = service.status(STOP_SECONDS)
    check(status == 0, f"SIGTERM ends it with exit status {status}", since=start)
    log = service.log()
    noise = [line for line in log.splitlines() if re.search("Traceback|Error|atplotlib", line)]
    check(not noise, f"its log holds no failure and no complaint of a library {noise}")


def site_packages(root: Path) -> Path:
    (path,) = root.glob("app/lib/python*/site-packages")
    return path


def size(path: Path) -> int:
    """Return the bytes of all files, those of several names once."""
    files = [path] if path.is_file() else path.rglob("*")
    stats = {(stat.st_dev, stat.st_ino): stat for stat in (file.lstat() for file in files)}
    return sum(stat.st_size for stat in stats.values() if not (stat.st_mode & 0o040000))


def megabytes(count: int) -> str:
    return f"{count / 1e6:.0f}"


def check(holds: object, what: str, *, since: float | None = None) -> None:
    if not holds:
        failures.append(what)
    say(what, mark="ok    " if holds else "FAILED", since=since)


def say(what: str, *, mark: str = "ok    ", since: float | None = None) -> None:
    took = "" if since is None else f" ({time.monotonic() - since:.1f} s)"
    print(f"{mark} {what.removesuffix(': []').removesuffix(' []').strip()}{took}", flush=True)


main()
