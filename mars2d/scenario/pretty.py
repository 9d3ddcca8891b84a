"""Text in brackets, wrapped to a width, for TOML files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, NamedTuple

from mars2d.core.materials import Coefficient

WIDTH = 100
"""Columns of a line."""

NONE = "none"
"""The text that stands for None."""


class Brackets(NamedTuple):
    """A bracketed list: ``[1, 2]``, ``{ a = 1 }``.

    opening: the bracket and the text before it. filled: a list that does not fit on one line has as
    many items per line as fit, else one.
    """

    opening: str
    items: Sequence[Node]
    closing: str
    filled: bool = False


Node = str | Brackets


def laid_out(node: Node, indent: int = 0, width: int = WIDTH) -> str:
    """Return a node as text: on one line if it fits, else broken after its opening bracket.

    indent: of its first and last line, columns. A line is longer than `width` if a single item is.

    >>> print(laid_out(Brackets("[", ["1.0", "2.0", "3.0"], "]", filled=True), width=14))
    [
        1.0, 2.0,
        3.0,
    ]
    """
    flat = _flat(node)
    if isinstance(node, str) or indent + len(flat) < width:  # a comma may follow
        return flat
    lines: list[str] = []
    inside = indent + 4
    room = 0  # in the last line
    for item in node.items:
        text = laid_out(item, inside, width) + ","
        if node.filled and "\n" not in text and len(text) < room:
            lines[-1] += " " + text
            room -= len(text) + 1
        else:
            lines.append(" " * inside + text)
            room = 0 if "\n" in text else width - inside - len(text)
    return "\n".join([node.opening, *lines, " " * indent + node.closing])


def _flat(node: Node) -> str:
    if isinstance(node, str):
        return node
    return node.opening + ", ".join(map(_flat, node.items)) + node.closing


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
