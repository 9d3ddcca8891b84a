"""A replay of a record as one HTML file, which any browser plays without a network."""

from __future__ import annotations

import base64
import html
import json
import re
import zlib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.controls import CONTROLS, MARKS, PAUSE
from mars2d.output.pages.replay.content import content_of
from mars2d.output.raster.theme import DARK, LIGHT, Theme, Tone

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

__all__ = [
    "filled",
    "look",
    "page",
    "player",
    "replay_data",
    "save_html",
]


def save_html(record: Rows, path: str | Path) -> Path:
    """Write a replay of a record as one HTML file; return its path.

    Raises InputError where it can't be written, or for a record without rows.
    """
    target = Path(path)
    if target.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{target}: expected a name that ends in .html")
    text = page(record)
    with atomic_write(target) as file:
        file.write(text.encode())
    return target


def page(record: Rows) -> str:
    """Return a replay of a record as the text of an HTML file, less than 2 MB.

    Raises InputError for a record without rows.
    """
    return player(record.scenario.title, replay_data(record))


def replay_data(record: Rows) -> str:
    """Return all that a replay shows of a record as text that needs no escape, for `player`.

    Raises InputError for a record without rows.
    """
    content, columns = content_of(record)
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    packed = (zlib.compress(text, 6), columns.packed())
    return " ".join(base64.b64encode(part).decode() for part in packed)


def player(title: str, data: str, first: str = "") -> str:
    """Return the page that plays the data of a replay.

    first: a script that runs before that of the page.
    """
    words = {
        "title": html.escape(title),
        "style": look() + _read("replay.css"),
        "script": first + _script(),
        "data": data,
        "PAUSE": PAUSE,
    }
    for name, control in CONTROLS.items():
        parts = {"title": control.title, "tip": control.tip, "icon": control.icon}
        words |= {f"{name}.{part}": text for part, text in parts.items()}
    return filled(_read("replay.html"), words)


@cache
def _script() -> str:
    """Return the script of the page."""
    names = sorted(each.name for each in files(__package__).iterdir())
    parts = "\n".join(_read(name) for name in names if name.endswith(".js"))
    return f'(() => {{\n"use strict";\n{parts}}})();'


@cache
def _read(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def filled(template: str, words: Mapping[str, str]) -> str:
    """Return a template with each {{name}} replaced by its words, which are taken as they are."""
    return re.sub("{{(.*?)}}", lambda found: words[found[1]], template)


def look() -> str:
    """Return the style that pages share: colours, light and dark, as variables, and controls."""
    light, dark = _variables(LIGHT), _variables(DARK)
    return f":root {{ {light} }}\n:root.dark {{ {dark} }}\n{_read('shared.css')}"


def _variables(theme: Theme) -> str:
    values = {f"mark-{kind}": mark.color(theme) for kind, mark in MARKS.items()}
    for name, value in theme._asdict().items():
        if isinstance(value, Tone):
            values |= {name: value.ink, f"{name}-pale": value.pale}
        elif isinstance(value, str):
            values[name] = value
    return " ".join(f"--{name.replace('_', '-')}: {value};" for name, value in values.items())
