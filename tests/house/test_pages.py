"""Every page of the documents, rendered as the site renders it, reads as it was meant."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

markdown = pytest.importorskip("markdown")
pytest.importorskip("pymdownx", reason="the site's extensions of markdown are not installed")

ROOT = Path(__file__).parents[2]
PAGES = [
    *sorted((ROOT / "docs").rglob("*.md")),
    *sorted((ROOT / "mars2d").rglob("README.md")),
    *(ROOT / f"{name}.md" for name in ("README", "CHANGELOG", "CONTRIBUTING")),
]
EXTENSIONS = [
    "admonition", "attr_list", "md_in_html", "pymdownx.highlight", "pymdownx.superfences", "tables",
    "toc",
]  # fmt: skip
LONGEST_HEADING = 60


def cells(line: str) -> int:
    """Return how many cells a row of a table has."""
    return len(re.findall(r"(?<!\\)\|", re.sub("`.*?`", "", line))) - 1


def long_rows(text: str) -> list[str]:
    """Return rows of more cells than their table's head, of which a reader sees only a part."""
    tables = re.findall(
        r"(?:^\|.*\n)+", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S) + "\n", re.M
    )
    rows = [table.splitlines() for table in tables]
    return [line for first, *rest in rows for line in rest if cells(line) > cells(first)]


def faults(page: Path, text: str) -> list[str]:
    """Return what a reader of a page would stumble over."""
    name = page.relative_to(ROOT)
    html = markdown.markdown(text, extensions=EXTENSIONS)
    pictures = re.findall(r'<img[^>]* src="([^"]+)"', html)
    headings = [re.sub("<.*?>", "", each) for each in re.findall(r"<h\d.*?>(.*?)</h\d>", html)]
    html = re.sub(r"<!--.*?-->|<pre.*?</pre>|<code.*?</code>", "", html, flags=re.S)
    loose = re.sub(r"<table>.*?</table>", "", html, flags=re.S)
    return [
        *(f"{name}: the row of a table: {line}" for line in re.findall(r".*\|\s*-.*", html)),
        *(
            f"{name}: a pipe outside a table: {line}"
            for line in re.findall(r".*(?<![^\s>])\|(?![^\s<]).*", loose)
        ),
        *(f"{name}: two rows in one: {line}" for line in long_rows(text)),
        *(f"{name}: a heading of {len(h)}: {h}" for h in headings if len(h) > LONGEST_HEADING),
        *(
            f"{name}: no picture {address}"
            for address in pictures
            if ":" not in address and not (page.parent / address).is_file()
        ),
    ]


@pytest.mark.slow
def test_every_page_is_rendered_as_it_was_meant():
    assert [fault for page in PAGES for fault in faults(page, page.read_text("utf-8"))] == []
