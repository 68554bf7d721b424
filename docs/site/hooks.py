"""Hooks of the manual: pages from files of the root folder, formulas, no scripts in pages."""

import re
import shutil
from hashlib import sha256
from html import unescape
from importlib import resources
from pathlib import Path
from typing import Any, Final

from fontTools.ttLib import TTFont
from latex2mathml.converter import convert
from mkdocs.structure.files import File, Files

# Pages of the manual that are files of the root folder.
ROOT_FILES: Final = {
    "index.md": "README.md",
    "contributing.md": "CONTRIBUTING.md",
    "changelog.md": "CHANGELOG.md",
}
_FORMULA: Final = re.compile(
    r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</(?:span|div)>', re.DOTALL
)
_BAR: Final = '<mo stretchy="false" lspace="0" rspace="0">|</mo>'
_SCRIPT: Final = re.compile(r"<script>(.*?)</script>", re.DOTALL)
_scripts: dict[str, str] = {}


def on_files(files: Files, config: Any) -> Files:
    """Add the pages that are files of the root folder, with links from the folder of the pages."""
    for page, name in ROOT_FILES.items():
        text = Path(name).read_text("utf-8").replace("](docs/", "](")
        for other, source in ROOT_FILES.items():
            text = text.replace(f"]({source})", f"]({other})")
        files.append(File.generated(config, page, content=text))
    return files


def on_page_markdown(markdown: str, **_: object) -> str:
    """Lead links to files of the root folder to their pages."""
    for target, name in ROOT_FILES.items():
        markdown = markdown.replace(f"](../{name}", f"]({target}")
    return markdown


def on_page_content(html: str, **_: object) -> str:
    """Write formulas as MathML, which needs no script."""
    return _FORMULA.sub(_mathml, html)


def _mathml(found: "re.Match[str]") -> str:
    text = convert(unescape(found[3]), display="block" if found[2] == "[" else "inline")
    # A bar that stretches would be taller at the beginning of a row than elsewhere.
    return text.replace("<mo>&#x0007C;</mo>", _BAR)


def on_post_page(output: str, page: Any, **_: object) -> str:
    """Move scripts of the theme into files, so that the policy can forbid scripts in pages.

    The dialog of the search gets the name that screen readers announce.
    """

    def moved(found: "re.Match[str]") -> str:
        name = f"assets/javascripts/{sha256(found[1].encode()).hexdigest()[:16]}.js"
        _scripts[name] = found[1]
        root = "../" * page.url.count("/")
        return f'<script src="{root}{name}"></script>'

    search = 'data-md-component="search" role="dialog"'
    named = output.replace(search, f'{search} aria-label="Search"')
    return _SCRIPT.sub(moved, named)


def on_post_build(config: Any) -> None:
    """Write the scripts that were moved; delete files that only developers of the theme need."""
    site = Path(config["site_dir"])
    for name, text in _scripts.items():
        (site / name).write_text(text, "utf-8")
    font = TTFont(str(resources.files("ziamath").joinpath("fonts/STIXTwoMath-Regular.ttf")))
    font.flavor = "woff"
    font.save(site / "assets/formulas.woff")
    (site / "404.html").unlink()
    shutil.rmtree(site / "assets/javascripts/lunr")
    for source_map in site.rglob("*.map"):
        source_map.unlink()
