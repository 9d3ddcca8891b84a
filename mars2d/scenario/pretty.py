"""Tables, lists and numbers as text for TOML files."""

from __future__ import annotations

import json
from typing import Any

from mars2d.core.materials import Coefficient

WIDTH = 100
"""Columns of a line with a table or a list; a longer one takes several."""

NONE = "none"
"""The text that stands for None."""


Node = str | list[Any] | dict[str, Any]
"""A value as text, a list of values, or a table."""


def tables(table: dict[str, Any], path: str = "") -> list[str]:
    """Return the lines of a table, and of those in it that fit in no line, below their headers.

    path: its name and a full stop; empty for that of the whole file.
    """
    lines, below = list[str](), list[str]()
    for name, value in table.items():
        line, inner = f"{name} = {flat(value)}", list[Any]()
        if isinstance(value, list) and any(isinstance(item, dict) for item in value):
            inner, header = value, f"[[{path}{name}]]"
        elif isinstance(value, dict) and (len(line) > WIDTH or ("{" in line and not path)):
            inner, header = [value], f"[{path}{name}]"
        elif isinstance(value, list) and len(line) > WIDTH:
            lines += [f"{name} = [", *(f"    {flat(item)}," for item in value), "]"]
        else:
            lines.append(line)
        for item in inner:
            below += ["", header, *tables(item, f"{path}{name}.")]
    return lines + below


def flat(node: Node) -> str:
    """Return a node as text in one line; a table of a type alone is its type."""
    if isinstance(node, dict):
        items = ", ".join(f"{name} = {flat(value)}" for name, value in node.items())
        return flat(node["type"]) if [*node] == ["type"] else f"{{ {items} }}"
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
