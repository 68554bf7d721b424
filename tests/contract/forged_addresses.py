"""Addresses of the explorer as an attacker or a broken link may hold them."""

import json
import random
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

TEXTS = {
    name: texts.split() if isinstance(texts, str) else texts
    for name, texts in json.loads(Path(__file__).with_suffix(".json").read_text("utf-8")).items()
}
OFFERED = {text for name in ("tabs", "kinds", "words") for text in TEXTS[name]}


def forged(count: int, seed: int) -> Iterator[str]:
    """Yield addresses: offered words and numbers, names of JavaScript, markup and garbage."""
    source = random.Random(seed)

    def text() -> str:
        pool = source.choice(["words", "numbers", "numbers", "names", "paths", "markup", "other"])
        return source.choice(TEXTS[pool])

    def member(key: str, value: str) -> str:
        raw = source.random() < 0.1 and "#" not in value
        return f"{key}={value if raw else quote(value, safe='')}"

    def column() -> str:
        length = source.randint(0, 4)
        return ",".join(source.choice([*TEXTS["numbers"], text()]) for _ in range(length))

    for _ in range(count):
        members = [
            member("tab", source.choice(TEXTS["tabs"])),
            member("kind", source.choice(TEXTS["kinds"])),
            member("path", source.choice(TEXTS["paths"])),
            *(
                member(source.choice(TEXTS[source.choice(["keys", "keys", "names"])]), text())
                for _ in range(source.randint(1, 6))
            ),
        ]
        source.shuffle(members)
        names = source.choice([("r", "f", "ur"), ("d", "F", "uF")])
        columns = "&".join(f"{name}={column()}" for name in names)
        table = source.choice(["", f"#{columns}", f"#{text()}", "#r=0,1&f=0"])
        yield f"?{'&'.join(members)}{table}"
