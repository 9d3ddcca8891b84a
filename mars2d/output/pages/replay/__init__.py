"""A replay of a record as one HTML file, which any browser plays without a network."""

from __future__ import annotations

import base64
import html
import json
import zlib
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write
from mars2d.output.pages.replay.content import content_of
from mars2d.output.pages.replay.template import colors, filled, policy
from mars2d.output.raster.theme import DARK

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["page", "page_script", "page_style", "player", "replay_data", "save_html"]

SCRIPTS = ("data", "shades", "camera", "painter", "drawings", "picture", "clock", "panel", "replay")
"""The parts of the script, each of which may use those before it."""


def save_html(record: Record, path: str | Path) -> Path:
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


def page(record: Record) -> str:
    """Return a replay of a record as the text of an HTML file, less than 2 MB.

    Raises InputError for a record without rows.
    """
    return player(record.scenario.title, replay_data(record))


def replay_data(record: Record) -> str:
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
    script = first + page_script()
    words = {
        "policy": policy([script], [page_style()]),
        "title": html.escape(title),
        "style": page_style(),
        "script": script,
        "data": data,
    }
    return filled(_read("replay.html"), words)


@cache
def page_script() -> str:
    """Return the script of the page."""
    parts = "\n".join(_read(f"{name}.js") for name in SCRIPTS)
    return f'(() => {{\n"use strict";\nconst PAPER = "{DARK.paper}";\n{parts}}})();'


@cache
def page_style() -> str:
    """Return the style of the page."""
    return colors() + _read("replay.css")


@cache
def _read(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")
