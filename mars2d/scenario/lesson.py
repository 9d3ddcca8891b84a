"""The lesson of an experiment: the parts of the docstring of its file, such as its question."""

from __future__ import annotations

import ast
import re
from pathlib import Path

HEADINGS = re.compile(
    r"(?m)(?:^|(?<=[.?!)] ))"
    r"(Question|Setting|Law(?: \([^)]*\))?|Prediction|Measured|Try|Play|Source): ",
)
"""The words with which parts of a docstring begin."""


def lesson_of(path: Path | None) -> list[tuple[str, str]]:
    """Return the parts of the docstring of a Python file: headings and texts, tables in lines.

    >>> HEADINGS.split("Question: how far? Source: a book.")
    ['', 'Question', 'how far? ', 'Source', 'a book.']
    """
    if path is None or path.suffix != ".py":
        return []
    first, *rest = HEADINGS.split(ast.get_docstring(ast.parse(path.read_text("utf-8"))) or "")
    named = (("", first), *zip(rest[::2], rest[1::2], strict=True))
    parts = [(heading, re.sub(r"\n(?!.*\S  )", " ", text.strip())) for heading, text in named]
    return [(heading, text[:1].upper() + text[1:]) for heading, text in parts]
