"""Comparisons of small numbers are relative."""

import ast
from collections.abc import Iterator
from pathlib import Path

TESTS = Path(__file__).parent
ABSOLUTE = {"approx": "abs", "isclose": "atol", "allclose": "atol"}
"""Functions with a nonzero default absolute tolerance, and the argument that sets it."""


def silently_absolute(source: str) -> Iterator[int]:
    """Yield the lines of comparisons that leave their absolute tolerance to a default."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            needed = ABSOLUTE.get(name)
            if needed and needed not in {keyword.arg for keyword in node.keywords}:
                yield node.lineno


def test_every_comparison_states_its_absolute_tolerance() -> None:
    result = [
        f"{path.relative_to(TESTS)}:{line}"
        for path in sorted(TESTS.rglob("*.py"))
        for line in silently_absolute(path.read_text("utf-8"))
    ]
    assert result == []


def test_default_absolute_tolerance_is_detected() -> None:
    assert set(silently_absolute("a == approx(b, rel=1)\nnp.isclose(a, b)")) == {1, 2}
    assert list(silently_absolute("a == pytest.approx(b, rel=1, abs=0)")) == []
