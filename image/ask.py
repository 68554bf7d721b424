"""Asks the service from inside its container, with what the image has: prints a line per answer."""

import json
import math
from http.client import HTTPConnection
from xml.etree import ElementTree as ET

HOST, PORT, TIMEOUT = "127.0.0.1", 8000, 60
# The closed form below and the answer each round a few times.
RELATIVE = 1e-14


def main() -> None:
    print(f"a Hertzian contact agrees with its closed form to {hertz():.1e}")
    print(f"a picture is drawn, of {picture()} bytes")
    print(f"a compute process solves a known contact: {fetch('GET', '/health/ready').decode()}")
    print(f"the documentation page is there, of {len(fetch('GET', '/docs'))} bytes")


def hertz() -> float:
    """Return the largest relative deviation from F = 4/3 E* R^(1/2) d^(3/2), a = (R d)^(1/2)."""
    radius, modulus, depth = 0.01, 1e9, 1e-6
    answer: dict[str, list[float]] = json.loads(
        fetch(
            "POST",
            "/v1/normal",
            {
                "profile": {"kind": "paraboloid", "radius": radius},
                "material": {"e_star": modulus},
                "load": {"indentation_depth": depth},
            },
        )
    )
    expected = {
        "normal_force": 4 / 3 * modulus * math.sqrt(radius) * depth * math.sqrt(depth),
        "contact_radius": math.sqrt(radius * depth),
    }
    deviation = max(abs(answer[name][0] / value - 1) for name, value in expected.items())
    if not deviation <= RELATIVE:
        raise SystemExit(f"a Hertzian contact is off by {deviation:.1e}: {answer}")
    return deviation


def picture() -> int:
    text = fetch(
        "POST",
        "/v1/stress",
        {
            "profile": {"kind": "paraboloid", "radius": 0.01},
            "material": {"e_star": 1e9},
            "load": {"indentation_depth": 1e-6},
            "points": 100,
            "quantities": ["pressure"],
        },
        accept="image/svg+xml",
    )
    root = ET.fromstring(text)
    if root.tag != "{http://www.w3.org/2000/svg}svg" or not len(root):
        raise SystemExit(f"no picture but <{root.tag}>")
    return len(text)


def fetch(method: str, path: str, query: object = None, accept: str = "*/*") -> bytes:
    connection = HTTPConnection(HOST, PORT, timeout=TIMEOUT)
    headers = {"Content-Type": "application/json", "Accept": accept}
    connection.request(method, path, json.dumps(query) if query else None, headers)
    response = connection.getresponse()
    body = response.read()
    if response.status != 200:
        raise SystemExit(f"{method} {path}: {response.status} {body[:500]!r}")
    return body


main()
