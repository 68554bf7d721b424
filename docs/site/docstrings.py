"""Docstrings as Markdown: sections of the numpydoc form, doctests and plain formulas."""

import re
from typing import Any, Final

import griffe

_SECTION: Final = re.compile(r"^(\w+)\n-+\n", re.MULTILINE)
_ITEM: Final = re.compile(r"^(\S[^\n]*?) : (.*)$")


class ProjectDocstrings(griffe.Extension):
    """Rewrites each docstring: the text after a colon is a description, types are in signatures."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Rewrite the docstring of an object."""
        if obj.docstring and not obj.is_alias:
            obj.docstring.value = markdown(obj.docstring.value)


def markdown(text: str) -> str:
    """Return a docstring as Markdown."""
    body, *sections = _SECTION.split(text)
    parts = [_prose(body)]
    for title, content in zip(sections[::2], sections[1::2], strict=True):
        parts += [f"**{title}**", _items(content) if title != "Examples" else _prose(content)]
    return "\n\n".join(parts)


def _items(content: str) -> str:
    """Return the list of parameters; lines that continue a description are indented."""
    lines = []
    for line in content.strip("\n").split("\n"):
        if found := _ITEM.match(line):
            names = ", ".join(f"`{name.strip()}`" for name in found[1].split(","))
            lines.append(f"- {names}: {_escaped(found[2])}")
        elif line.startswith(" ") or not line:
            lines.append(f"    {_escaped(line.strip())}")
        else:
            lines.append(f"- {_escaped(line)}")
    return "\n".join(lines)


def _prose(text: str) -> str:
    """Return paragraphs; doctests become blocks of code."""
    paragraphs = []
    for paragraph in re.split(r"\n\s*\n", text.strip("\n")):
        if paragraph.lstrip().startswith(">>>"):
            paragraphs.append(f"```pycon\n{paragraph}\n```")
        elif paragraph.startswith("    "):
            paragraphs.append(paragraph)
        else:
            paragraphs.append(_escaped(paragraph))
    return "\n\n".join(paragraphs)


def _escaped(text: str) -> str:
    """Escape the marks of Markdown in formulas, outside of code."""
    parts = re.split(r"(``?[^`]+``?)", text)
    parts[::2] = [
        re.sub(r"[][*_<|$]", lambda mark: f"&#{ord(mark[0])};", part) for part in parts[::2]
    ]
    return "".join(parts)
