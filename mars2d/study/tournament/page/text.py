"""Words on a page, which may come from anybody: names of files, messages, what a law printed."""

from __future__ import annotations

import html
import re
from math import isfinite

__all__ = ["DASH", "clean", "escaped", "named", "time_cell"]

DASH = "\N{EN DASH}"
"""Stands where there is nothing to tell."""

UNFIT = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""What no page can hold or show: control characters, halves of characters."""


def clean(text: object) -> str:
    r"""Return text with a question mark in place of each character that no page can show.

    >>> clean("a\x00b\r\n")
    'a\ufffdb\n'
    """
    return UNFIT.sub("\ufffd", str(text).replace("\r\n", "\n"))


def escaped(text: object) -> str:
    """Return text so that a page shows it as it is, also within quotes.

    >>> escaped("<script>")
    '&lt;script&gt;'
    """
    return html.escape(clean(text))


def named(name: object) -> str:
    """Return a name as an element, whose direction of writing stays its own."""
    return f"<bdi>{escaped(name)}</bdi>"


def time_cell(value: float | None, digits: int) -> str:
    """Return the cell of a table that tells a time, seconds: a dash where there is none.

    >>> time_cell(2.5, 1)
    '<td data-value="2.5">2.5 s</td>'
    """
    if value is None or not isfinite(value):
        return f"<td>{DASH}</td>"
    return f'<td data-value="{value:.9g}">{value:.{digits}f} s</td>'
