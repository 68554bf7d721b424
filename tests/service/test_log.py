"""Log: lines of JSON on standard error, which are lost where nobody reads them."""

import json
import os
import pickle
import subprocess
import sys
import warnings

import pytest

from mdr_service import observability
from mdr_service.compute_process import _HEAD
from mdr_service.observability import LogStream
from tests.faults.server import PATIENCE


def test_oldest_lines_are_lost_and_counted_while_nobody_reads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reader, writer = os.pipe()
    monkeypatch.setattr(observability, "_STANDARD_ERROR", writer)
    # Nothing is written before the end.
    monkeypatch.setattr(observability, "_WRITE_INTERVAL", PATIENCE)
    lost = observability.LOST_LINES._value.get()
    stream = LogStream(max_lines=3)
    for number in range(5):
        stream.write(f"{number}\n")
    assert observability.LOST_LINES._value.get() == lost + 2
    stream._end()
    os.close(writer)
    with os.fdopen(reader) as written:
        assert written.read() == "2\n3\n4\n"


def test_lines_are_written_whole_and_a_closed_stream_is_ignored(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    blocks: list[bytes] = []

    def write(_descriptor: int, block: bytes) -> int:
        blocks.append(block)
        if len(blocks) == 2:
            raise OSError("closed")
        return len(block)

    monkeypatch.setattr(os, "write", write)
    stream = LogStream()
    stream._lines.extend([b"a" * 3_000, b"b" * 1_000, b"c" * 5_000, b"d" * 90, b"e" * 7])
    stream._write_lines()
    # A line longer than a pipe takes at once is a block of its own.
    assert [len(block) for block in blocks] == [4_000, 5_000, 97]


def test_warning_in_a_compute_process_is_a_line_of_json() -> None:
    call = pickle.dumps((warnings.warn, ("a picture is too small",)))
    process = subprocess.run(
        [sys.executable, "-c", "from mdr_service.compute_process import serve; serve()"],
        input=_HEAD.pack(0, len(call)) + call,
        capture_output=True,
        check=True,
        timeout=PATIENCE,
    )
    (line,) = map(json.loads, process.stderr.splitlines())
    assert line["level"] == "warning"
    assert "a picture is too small" in line["message"]
