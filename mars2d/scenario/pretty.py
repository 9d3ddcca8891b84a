"""Text in brackets, wrapped to a width, for TOML files."""

from __future__ import annotations

import json
from typing import Any

from mars2d.core.materials import Coefficient

WIDTH = 100
"""Columns of a line."""

NONE = "none"
"""The text that stands for None."""


Node = str | list["Node"]
"""A value as text, or a list of values."""


def laid_out(node: Node, before: str = "", indent: int = 0, width: int = WIDTH) -> str:
    """Return a node as text: on one line if it fits, else broken after its opening bracket.

    before: what stands before it. indent: of its first and last line, columns. A list of tables has
    one in a line, other lists as many items as fit. A line is longer than `width` if an item is.

    >>> print(laid_out(["1.0", "2.0", "3.0"], "x = ", width=14))
    x = [
        1.0, 2.0,
        3.0,
    ]
    """
    whole = before + flat(node)
    if isinstance(node, str) or indent + len(whole) < width:  # a comma may follow
        return whole
    lines, inside = list[str](), indent + 4
    room = 0  # in the last line
    for item in node:
        text = laid_out(item, "", inside, width) + ","
        if "\n" not in text and text[0] != "{" and len(text) < room:
            lines[-1] += " " + text
            room -= len(text) + 1
        else:
            lines.append(" " * inside + text)
            room = 0 if "\n" in text else width - inside - len(text)
    return "\n".join([f"{before}[", *lines, " " * indent + "]"])


def flat(node: Node) -> str:
    """Return a node as text in one line."""
    return node if isinstance(node, str) else f"[{', '.join(map(flat, node))}]"


def plain(value: Any) -> str:
    """Return a number, a word or a material as text; numbers are read back bit for bit."""
    if value is None:
        return quoted(NONE)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Coefficient):
        return quoted(value.material)
    return repr(float(value) if isinstance(value, float) else int(value))


def comment(text: str) -> str:
    """Return a line of comment, without characters that can't be part of a line."""
    return "# " + "".join(c for c in " ".join(text.split()) if c.isprintable())


def quoted(text: str) -> str:
    r"""Return text in double quotes.

    >>> print(quoted('a "wall"\n'))
    "a \"wall\"\n"
    """
    return json.dumps(str(text), ensure_ascii=False).replace("\x7f", r"\u007f")
