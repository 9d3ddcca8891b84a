"""Write docs/fields.md: every field of the descriptions, from what the classes say of themselves.

python docs/make_fields.py
"""

from __future__ import annotations

import contextlib
import dataclasses
from math import pi
from pathlib import Path
from typing import Any

from mars2d import Animation, Holonomic, Robot, Scenario, Unicycle
from mars2d.addons import Map
from mars2d.description import Description
from mars2d.errors import InputError
from mars2d.registry import summary
from mars2d.sensors import Proximity

KINDS: tuple[type[Description], ...] = (
    Scenario, Robot, Animation, Unicycle, Holonomic, Proximity, Map,
)  # fmt: skip

HEAD = """\
# Fields

Every field that an experiment can set, with its unit, its default and what it accepts. All values
are checked when an object is made: anything else is an error that names the field. Fields are given
by name, as in `Robot(diameter=0.2)`; `Map` also takes its outlines as its only unnamed argument.

`object.replace(field=value)` returns a copy with some fields changed; the objects themselves never
change.
"""

TAIL = """
This page is written by `docs/make_fields.py`.
"""


def document() -> str:
    """Return the text of docs/fields.md."""
    return HEAD + "".join(section(kind) for kind in KINDS) + TAIL


def section(kind: type[Description]) -> str:
    """Return the part about one class."""
    lines = [
        f"\n## {kind.__name__}\n",
        f"{summary(kind)}\n",
        "| field | unit | default | accepts | meaning |",
        "|---|---|---|---|---|",
    ]
    for field in dataclasses.fields(kind):
        unit, doc = field.metadata.get("unit", ""), field.metadata.get("doc", "")
        cells = [f"`{field.name}`", unit, default(field), accepts(kind, field), doc]
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def default(field: dataclasses.Field[Any]) -> str:
    """Return a field's default as it is written in Python."""
    if field.default is not dataclasses.MISSING:
        return "`2 * pi`" if field.default == 2 * pi else f"`{field.default!r}`"
    if field.default_factory is not dataclasses.MISSING:
        return f"`{field.default_factory()!r}`"
    return "none: must be given"


def accepts(kind: type[Description], field: dataclasses.Field[Any]) -> str:
    """Return what a field accepts, in the words of the error for something that fits nowhere."""
    check, name = field.metadata["check"], f"{kind.__name__}.{field.name}"
    try:
        check(name, object())
    except InputError as error:
        expected = str(error).partition(": expected ")[2]
    else:
        raise AssertionError(f"{name} accepts anything")
    with contextlib.suppress(InputError):
        if check(name, None) is None:
            expected += ", or `None`"
    return expected.replace(f" [{field.metadata['unit']}]", "")


if __name__ == "__main__":
    Path(__file__).with_name("fields.md").write_text(document(), encoding="utf-8")
