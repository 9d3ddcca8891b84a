"""Words on a page that may come from anybody.

Names of files, messages and everything that a law prints must not break the page, so they are
cleaned and escaped here.
"""

from __future__ import annotations

import html
import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

UNFIT = re.compile("[\0-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""Characters that a page can't hold or show: control characters and lone surrogates."""


@cache
def read(name: str) -> str:
    """Return a template, script or style of this folder."""
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def clean(text: object) -> str:
    r"""Return text with a replacement character for each one that a page can't show.

    >>> clean("a\x00b\r\n")
    'a\ufffdb\n'
    """
    return UNFIT.sub("\ufffd", str(text).replace("\r\n", "\n"))


def escaped(text: object) -> str:
    """Return text that a page shows as it is, also inside quoted attributes.

    >>> escaped("<script>")
    '&lt;script&gt;'
    """
    return html.escape(clean(text))


def named(name: object) -> str:
    """Return a name as an element with a writing direction of its own."""
    return f"<bdi>{escaped(name)}</bdi>"


def dots(colors: tuple[str, ...]) -> str:
    """Return a dot in each of some colours."""
    circle = '<svg class="dot" viewBox="0 0 10 10" aria-hidden="true"><circle cx="5" cy="5" r="4"'
    return "".join(f'{circle} fill="{color}"/></svg>' for color in colors)


def terms(found: Mapping[str, str]) -> str:
    """Return terms and their descriptions, without those that are empty, for a list <dl>."""
    found = {term: escaped(what) for term, what in found.items() if what}
    return "\n".join(f"<div><dt>{term}</dt><dd>{what}</dd></div>" for term, what in found.items())
