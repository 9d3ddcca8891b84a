"""Cells of a study's table: values as text that reads back as the same values."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from mars2d.scenario.options import parse_setting

__all__ = ["cell", "cells_of", "key_of", "value_in", "word_cell", "word_in"]

FORMULA = re.compile("'*[=+@-]")
"""The beginning of words that a spreadsheet takes for a formula, or that are quoted against it."""


def cell(value: Any) -> str:
    """Return a setting's value as the text of a cell; `value_in` reads it back.

    >>> [cell(value) for value in (0.5, "a.py", "0.5", (1, 2))]
    ['0.5', 'a.py', "'0.5'", '(1, 2)']
    """
    if isinstance(value, str) and value_in(value) == value and value.isprintable():
        return value
    return repr(value)


def value_in(text: str) -> Any:
    """Return the value in a cell: a Python literal, or else a word."""
    return parse_setting(f"_={text}")[1]


def word_cell(text: str) -> str:
    """Return words as the text of a cell, with a quote before anything that looks like a formula.

    >>> [word_cell(text) for text in ("blue", "=1+1", "'=1+1", "-")]
    ['blue', "'=1+1", "''=1+1", "'-"]
    """
    return f"'{text}" if FORMULA.match(text) else text


def word_in(text: str) -> str:
    """Return the words in a cell that `word_cell` wrote."""
    return text[1:] if text[:1] == "'" and FORMULA.match(text) else text


def cells_of(options: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cells of a point, which identify it."""
    return tuple(map(cell, options.values()))


def key_of(value: Any) -> Any:
    """Return a hashable key that identifies a setting's value; a list has the key of a tuple."""
    if isinstance(value, (list, tuple)):
        return tuple(map(key_of, value))
    return repr(value) if isinstance(value, (dict, set)) else value
