"""Write docs/fields.md: every field of the descriptions, from what the classes say of themselves.

python docs/make/fields.py
"""

from __future__ import annotations

import contextlib
import dataclasses
import re
from math import pi
from pathlib import Path
from typing import Any

from mars2d import (
    Animation,
    Delaunay,
    Drive,
    Everyone,
    Graph,
    MaterialPair,
    Nearest,
    Prediction,
    RandomStarts,
    Robot,
    Scenario,
    Within,
)
from mars2d.addons import Addon, Burst
from mars2d.bodies import Joint, Prop
from mars2d.core.description import Description, snake_case
from mars2d.core.errors import InputError
from mars2d.core.materials import MATERIALS
from mars2d.geometry import Compound, Disc, Polygon
from mars2d.scenario.controllers import Controller
from mars2d.scenario.registry import members, summary
from mars2d.sensors import Sensor


def shipped(family: str) -> list[type[Description]]:
    """Return MARS2D's own parts of a family."""
    return [kind for kind in members(family).values() if kind.__module__.startswith("mars2d.")]


KINDS: tuple[type[Description], ...] = (
    Scenario, Robot, Animation,
    Drive, *shipped("bodies"),
    Disc, Polygon, Compound,
    Prop, *shipped("props"),
    Joint, *shipped("joints"),
    Sensor, *shipped("sensors"),
    Controller, *shipped("controllers"),
    Addon, *shipped("addons"), Burst,
    Everyone, Within, Nearest, Delaunay, Graph,
    MaterialPair,
    RandomStarts,
    Prediction,
)  # fmt: skip

BASES: tuple[type[Description], ...] = (Drive, Prop, Joint, Sensor, Controller, Addon)
"""Classes derived from one of these state only the fields that it has not, or not so."""

HEAD = """\
# Fields

Every field that an experiment can set, with its unit, its default and what it accepts besides that.
All values are checked when an object is made: anything else is an error that names the field.
Numbers have an interval: (0, 10] is more than 0 and at most 10. Fields are given by name, as in
`Robot(diameter=0.2)`; those marked with * may also be given without their name, in their order, as
in `Disc(0.2)`. What must be given has no default.

Each class has its own fields and those of its family: of [Drive](#drive), [Prop](#prop),
[Joint](#joint), [Sensor](#sensor), [Controller](#controller) or [Addon](#addon).

`object.replace(field=value)` returns a copy with some fields changed; the objects themselves never
change.
"""

TABLE_HEAD = """\
| field | default | accepts | meaning |
|---|---|---|---|
"""

MATERIALS_HEAD = """
## Materials

What a surface of a material brings into a contact, which has the product of both by default. The
last two columns are those products for two things of the same material.

| material | density | friction | restitution | friction of two | restitution of two |
|---|---|---|---|---|---|
"""

MATERIALS_TAIL = """
Densities are in kg/m^3. The figures are typical ones of clean, dry, solid things; real ones scatter
by a third and more. `mars2d/core/materials.py` names the sources.
"""

TAIL = """
This page is written by `docs/make/fields.py`.
"""


def document() -> str:
    """Return the text of docs/fields.md."""
    return HEAD + "".join(section(kind) for kind in KINDS) + materials() + TAIL


def base_of(kind: type[Description]) -> type[Description] | None:
    """Return the base whose fields stand in a table of their own."""
    return next((base for base in BASES if issubclass(kind, base) and kind is not base), None)


def fields_of(kind: type[Description]) -> list[dataclasses.Field[Any]]:
    """Return the fields of a class that its base has not, or not with this default and unit."""
    base = base_of(kind)
    known = {} if base is None else {field.name: field for field in dataclasses.fields(base)}
    return [
        field
        for field in dataclasses.fields(kind)
        if field.name not in known or said(known[field.name]) != said(field)
    ]


def said(field: dataclasses.Field[Any]) -> tuple[str, str]:
    """Return a field's default and unit."""
    return default(field), field.metadata.get("unit", "")


def title(kind: type[Description]) -> str:
    """Return a class's name, with its family if another one has the same name."""
    if [each.__name__ for each in KINDS].count(kind.__name__) == 1:
        return kind.__name__
    return f"{kind.__name__}, the {'sensor' if issubclass(kind, Sensor) else 'add-on'}"


def section(kind: type[Description]) -> str:
    """Return the part about one class."""
    text = f"\n## {title(kind)}\n\n{summary(kind)}\n"
    if issubclass(kind, Sensor) and kind is not Sensor:
        page = f"sensors/{snake_case(kind.__name__)}.md#parameters"
        return text + f"\nIts fields are on [its page]({page}).\n"
    if fields := fields_of(kind):
        text += "\n" + TABLE_HEAD + "".join(row(kind, field) for field in fields)
    return text


def row(kind: type[Description], field: dataclasses.Field[Any]) -> str:
    """Return the row of one field."""
    unit, doc = field.metadata.get("unit", ""), field.metadata.get("doc", "")
    name = f"`{field.name}`{'' if field.kw_only else '*'}{f' [{unit}]' if unit else ''}"
    cells = [name, default(field), accepts(kind, field), doc]
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"


def default(field: dataclasses.Field[Any]) -> str:
    """Return a field's default as it is written in Python."""
    if field.default is not dataclasses.MISSING:
        known = {2 * pi: "2 * pi", pi / 2: "pi / 2", (-pi / 2, pi / 2): "(-pi / 2, pi / 2)"}
        return f"`{known.get(field.default, repr(field.default))}`"
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
    if field.default is None:
        expected = expected.removesuffix(", or None")
    else:
        with contextlib.suppress(InputError):
            if check(name, None) is None and "None" not in expected:
                expected += ", or None"
    expected = {"True or False": "", "text in quotes": "text"}.get(expected, expected)
    expected = expected.replace(f" [{field.metadata['unit']}]", "")
    expected = re.sub(
        r"a number (>=?) (\S+) and (<=?) ([^\s,]+(?: pi)?)",
        lambda m: f"{'[' if m[1] == '>=' else '('}{m[2]}, {m[4]}{']' if m[3] == '<=' else ')'}",
        expected,
    )
    return expected.removesuffix("None") + "`None`" if expected.endswith("None") else expected


def materials() -> str:
    """Return the table of materials."""
    rows = ""
    for name, (density, friction, restitution) in MATERIALS.items():
        alone = f"{density:g} | {friction:.2f} | {restitution:.2f}"
        rows += f"| `{name}` | {alone} | {friction**2:.2f} | {restitution**2:.2f} |\n"
    return MATERIALS_HEAD + rows + MATERIALS_TAIL


if __name__ == "__main__":
    (Path(__file__).parents[1] / "fields.md").write_text(document(), encoding="utf-8")
