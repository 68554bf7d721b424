"""Every log line is JSON, and a lost reader of the log does not stop the service."""

import json
import os
import pickle
import subprocess
import sys
import warnings

import pytest

from mdr_service import observability
from mdr_service.compute_processes import _HEAD
from mdr_service.observability import LogStream
from tests.faults.server import PATIENCE


def test_lines_are_lost_and_counted_while_nobody_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    monkeypatch.setattr(observability, "_STANDARD_ERROR", writer)
    lost = observability.LOST_LINES._value.get()
    lines = [f"{number:0999d}\n" for number in range(100)]
    for line in lines:
        LogStream().write(line)
    os.close(writer)
    with os.fdopen(reader) as stream:
        written = stream.readlines()
    assert 1 < len(written) < 100
    assert written == lines[: len(written)]
    assert observability.LOST_LINES._value.get() == lost + 100 - len(written)


def test_warning_in_a_compute_process_is_a_line_of_json() -> None:
    call = pickle.dumps((warnings.warn, ("a picture is too small",)))
    command = [sys.executable, "-c", "from mdr_service.compute_processes import serve; serve()"]
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    with subprocess.Popen(command, **pipes) as process:
        assert process.stdin
        assert process.stdout
        process.stdin.write(_HEAD.pack(len(call)) + call)
        process.stdin.flush()
        process.stdout.read(_HEAD.size)
        _, lines = process.communicate(timeout=PATIENCE)
    (line,) = map(json.loads, lines.splitlines())
    assert process.returncode == 0
    assert line["level"] == "warning"
    assert "a picture is too small" in line["message"]
