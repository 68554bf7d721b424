"""Draw the figures of docs/gallery.md from its requests: `make figures`."""

import re
from pathlib import Path
from textwrap import dedent

from mdr_service.content_negotiation import appearance
from mdr_service.dispatch import respond
from mdr_service.queries import QUERIES

DOCS = Path(__file__).parents[1]
SVG = "image/svg+xml"


def main() -> None:
    """Write the response to every request to the folder of the gallery."""
    page = (DOCS / "gallery.md").read_text("utf-8")
    requests = dict(re.findall(r'```json title="(\w+)\.json"\n(.*?)```', page, re.DOTALL))
    paths = re.findall(r"(/v1/[\w/]+)\?format=svg(?:&units=(\S+))?' .*? -d @(\w+)\.json", page)
    queries = {kind.path: name for name, kind in QUERIES.items()}
    for path, units, name in paths:
        look = appearance(SVG, None, units or None)
        picture = respond(queries[path], dedent(requests[name]).encode(), SVG, appearance=look)
        (DOCS / "gallery" / f"{name}.svg").write_bytes(picture)


if __name__ == "__main__":
    main()
