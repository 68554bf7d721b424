"""Time of a request by stage, against the number of radii: `make chart-wire`.

`/v1/stress` computes pressure and shear stress of a paraboloid in partial slip at n requested
radii. Its stages are timed one after the other in this process, with the functions of the service:
parsing and validation, computation, serialisation. The total is measured by a client on one open
loopback connection; the remainder is HTTP, framework and sockets.
"""

from __future__ import annotations

import json
import socket
import sys
from contextlib import contextmanager
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np
import stress_wire_ratio
import wire_ratio
from drawing import panels, save, table
from machine import footer
from measure import medians

from mdr_service.queries import QUERIES
from mdr_service.schemas.fields import StressQuery
from mdr_service.serializers import FORMATS, WRITE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

LENGTHS = (1, 10, 100, 1000, 10_000, 100_000)
MEDIA_TYPES = {"JSON": FORMATS["json"], "CSV": FORMATS["csv"], "NumPy": FORMATS["npz"]}
SECONDS, SAMPLES = 2.0, 400
STAGES = ("validation", "compute", "serialisation", "HTTP")
HEADER = ("form", "radii", "bytes in", "bytes out", *(f"{name} [us]" for name in STAGES), "all")
COLORS = ("#1f5fa8", "#c1272d", "#2b8a3e", "0.7")


def body(length: int) -> bytes:
    """Request text with all digits of every radius."""
    radius = (np.linspace(0.0, 1.0, length + 1)[:-1] ** 0.5 * 1e-4).tolist()
    return json.dumps(stress_wire_ratio.QUERY | {"radius": radius}).encode()


def stages(text: bytes, format_name: str) -> tuple[dict[str, Callable[[], object]], int]:
    """Duration of each stage, and the response."""
    question, write = QUERIES["stress"], WRITE[MEDIA_TYPES[format_name]]
    query = StressQuery.model_validate_json(text)

    def compute() -> Any:
        return question.result(query, question.solve(query))

    document = compute()
    runs = {
        "validation": lambda: StressQuery.model_validate_json(text),
        "compute": compute,
        "serialisation": lambda: write(document),
    }
    return runs, len(write(document))


@contextmanager
def connection(port: int) -> Iterator[socket.socket]:
    """A persistent connection."""
    with socket.create_connection((wire_ratio.HOST, port)) as made:
        made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        yield made


def ask(link: socket.socket, text: bytes, accept: str, path: str = "stress") -> float:
    """Seconds from the first byte sent to the last one received."""
    head = (
        f"POST /v1/{path} HTTP/1.1\r\nHost: {wire_ratio.HOST}\r\nAccept: {accept}\r\n"
        f"Content-Type: application/json\r\nContent-Length: {len(text)}\r\n\r\n"
    ).encode()
    start = perf_counter()
    link.sendall(head + text)
    received = bytearray()
    while b"\r\n\r\n" not in received:
        received += link.recv(1 << 20)
    if not received.startswith(b"HTTP/1.1 200"):
        raise RuntimeError(received[:200].decode())
    top, rest = received.split(b"\r\n\r\n", 1)
    left = int(top.lower().split(b"content-length:", 1)[1].split(b"\r\n", 1)[0]) - len(rest)
    while left > 0:
        left -= len(link.recv(1 << 20))
    return perf_counter() - start


def main() -> None:
    rows = []
    command = [sys.executable, "-m", "mdr_command", "serve", "--port"]
    with wire_ratio.server(command) as port, connection(port) as link:
        for format_name, media_type in MEDIA_TYPES.items():
            for length in LENGTHS:
                text = body(length)
                runs, size = stages(text, format_name)
                seconds = medians(runs, SECONDS)
                once = ask(link, text, media_type)
                count = max(9, min(SAMPLES, round(SECONDS / 2 / once)))
                whole = median(ask(link, text, media_type) for _ in range(count))
                times = [seconds[name] for name in STAGES[:-1]]
                times.append(max(whole - sum(times), 0.0))
                micro = [one * 1e6 for one in (*times, whole)]
                rows.append((format_name, length, len(text), size, *micro))
    table(HEADER, rows, "wire")
    figure, axes = panels(1, len(MEDIA_TYPES), 3.0)
    for ax, format_name in zip(axes, MEDIA_TYPES, strict=True):
        own_rows = [row for row in rows if row[0] == format_name]
        parts = np.array([row[4 : 4 + len(STAGES)] for row in own_rows])
        share = 100 * parts / parts.sum(axis=1, keepdims=True)
        start = np.zeros(len(own_rows))
        for column, name, color in zip(share.T, STAGES, COLORS, strict=True):
            ax.barh(range(len(own_rows)), column, left=start, color=color, label=name)
            start += column
        labels = [f"{row[1]:,}\n{_readable(row[-1])}" for row in own_rows]
        ax.set_yticks(range(len(own_rows)), labels)
        ax.set(title=f"{format_name} response", xlabel="share of request time [%]")
        ax.invert_yaxis()
        ax.grid(visible=False)
    axes[0].set_ylabel("number of radii, request time")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    save(figure, "wire", footer("fastapi", "pydantic", "uvicorn", "orjson"))


def _readable(micro: float) -> str:
    return f"{micro:.0f} µs" if micro < 1000 else f"{micro / 1000:.3g} ms"


if __name__ == "__main__":
    main()
