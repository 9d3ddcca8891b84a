"""Formulas of plain text as HTML: Greek letters, subscripts and superscripts."""

from __future__ import annotations

import html
import re

__all__ = ["typeset"]

GREEK = "alpha|beta|gamma|eta|theta|mu|pi|rho|phi|psi|omega"
SIGNS = re.compile(rf"(?<![A-Za-z])({GREEK}|sum|int|nabla|le)(?![A-Za-z])")
"""Words that HTML has a letter or sign for, by the same name."""

MINUS = re.compile(r"(?<![^\s(={])-(?=[\s\w(&])")
"""A minus, which no letter precedes, as it does a hyphen."""

DOT = re.compile(r"(?<= )\.(?= )")
"""A product of vectors: a full stop between spaces."""

SHIFTED = re.compile(r"([_^])(?:\{([^{}]*)\}|([^\W_]))")
"""``_i``, ``^2``, ``_{ij}``."""


def typeset(text: str) -> str:
    """Return a formula as HTML, everything else in it escaped.

    >>> typeset("v = -k rho_{ij}^2 < 1")
    'v = &minus;k &rho;<sub>ij</sub><sup>2</sup> &lt; 1'
    """

    def shifted(match: re.Match[str]) -> str:
        tag = "sub" if match[1] == "_" else "sup"
        return f"<{tag}>{match[3] if match[2] is None else match[2]}</{tag}>"

    text = SIGNS.sub(r"&\1;", html.escape(text, quote=False))
    text = DOT.sub("&middot;", MINUS.sub("&minus;", text))
    return SHIFTED.sub(shifted, text)
