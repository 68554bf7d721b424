"""Chart footer: processor, versions and date of the measurement."""

from __future__ import annotations

import datetime as dt
import os
import platform
from importlib import metadata
from pathlib import Path


def processor() -> str:
    """Processor model and number of cores."""
    text = Path("/proc/cpuinfo")
    lines = text.read_text("utf-8").splitlines() if text.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return f"{models[0] if models else platform.machine()}, {os.cpu_count()} cores"


def footer(*packages: str) -> str:
    """Processor, versions and date, for single-threaded measurements."""
    found = [
        f"{name}\N{NO-BREAK SPACE}{metadata.version(name)}"
        for name in ("numpy", "scipy", *packages)
    ]
    today = dt.datetime.now(dt.UTC).date().isoformat()
    python = f"Python {platform.python_version()}"
    return " · ".join([processor(), "one thread", python, *found, today])
