"""Write docs/fields.md: every field of the descriptions, from what the classes say of themselves.

python docs/make/fields.py
"""

from __future__ import annotations

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

Every field that an experiment can set: its default and unit, what it accepts, what it means. All
values are checked when an object is made: anything else is an error that names the field. (0, 10]
is more than 0 and at most 10; bounds from 1000 on are left out. What has no default must be given.
Fields are given by name, as in `Robot(diameter=0.2)`; those marked with * also without it, in their
order, as in `Disc(0.2)`. Colours are `#rrggbb` or a name. `object.replace(field=value)`
returns a copy with some fields changed.

Each class has its own fields and those of its family: of [Drive](#drive), [Prop](#prop),
[Joint](#joint), [Sensor](#sensor), [Controller](#controller) or [Addon](#addon).
"""

MATERIALS_HEAD = """
## Materials

What a surface of a material brings into a contact, which has the product of both by default.

| material | density [kg/m^3] | friction | restitution |
|---|---|---|---|
"""

SHORT = {
    "True or False": "",
    "text in quotes": "",
    "a pose (x, y, theta) in metres and radians, within +-1e+06": "",
    "a polygon's vertices, such as [(x, y), ...] in metres": "such as [(x, y), ...]",
    "an Animation, such as Animation()": "",
    "a colour, '#rrggbb' or a name": "",
    "a function of one argument, the robot": "",
    "a factor of real time (1 is real time), 0 for one step a key press, or 'max'": "",
    "a point (x, y) in metres, within +-1e+06": "",
    "a number": "",
    "the name of a file that ends in .png": "",
    "a Drive, such as Unicycle()": "",
    "one of " + ", ".join(map(repr, MATERIALS)): "",
}
"""What a field accepts, where its unit, its default and its meaning say most of it."""

TAIL = """
The figures are typical ones of clean, dry, solid things; real ones scatter by a third and more.
`mars2d/core/materials.py` names the sources. This page is written by `docs/make/fields.py`.
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
    text = f"\n## {title(kind)}\n\n{summary(kind)}"
    if issubclass(kind, Sensor) and kind is not Sensor:
        page = f"sensors/{snake_case(kind.__name__)}.md#parameters"
        return f"{text} See [its page]({page}).\n"
    if fields := fields_of(kind):
        text += "\n\n" + "\n".join(line(kind, field) for field in fields)
    return text + "\n"


def line(kind: type[Description], field: dataclasses.Field[Any]) -> str:
    """Return the line of one field."""
    unit, doc = field.metadata.get("unit", ""), field.metadata.get("doc", "")
    given = default(field)
    value = f"`{field.name} = {given}`" if given else f"`{field.name}`"
    star = "" if field.kw_only else "\\*"
    rules = accepts(kind, field)
    if rules.startswith("such as"):
        doc = f"{doc}, {rules}"
    elif rules:
        doc = f"{doc}. {rules[0].upper()}{rules[1:]}"
    return f"- {value}{star}{f' {unit}' if unit else ''}: {doc}"


def default(field: dataclasses.Field[Any]) -> str:
    """Return a field's default as it is written in Python, or nothing where it must be given."""
    if field.default is not dataclasses.MISSING:
        known = {2 * pi: "2 * pi", pi / 2: "pi / 2", (-pi / 2, pi / 2): "(-pi / 2, pi / 2)"}
        return known.get(field.default, repr(field.default))
    if field.default_factory is not dataclasses.MISSING:
        return repr(field.default_factory())
    return ""


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
    elif field.metadata["optional"] and "None" not in expected:
        expected += ", or None"
    expected = SHORT.get(expected, expected).replace(f" [{field.metadata['unit']}]", "")
    expected = expected.replace("a list, ", "").replace(" in metres", "")
    expected = re.sub(r"a whole number from 1 to \d{4,}", "a whole number", expected)
    expected = re.sub(r"^a number >=? \S+ and <= [^\s,]*(e\+|000)\d*(, )?", "", expected)
    expected = re.sub(
        r"a number (>=?) (\S+) and (<=?) ([^\s,]+(?: pi)?)",
        lambda m: f"in {'[' if m[1] == '>=' else '('}{m[2]}, {m[4]}{']' if m[3] == '<=' else ')'}",
        expected,
    )
    return expected.removesuffix("None") + "`None`" if expected.endswith("None") else expected


def materials() -> str:
    """Return the table of materials."""
    rows = ""
    for name, (density, friction, restitution) in MATERIALS.items():
        rows += f"| `{name}` | {density:g} | {friction:.2f} | {restitution:.2f} |\n"
    return MATERIALS_HEAD + rows


if __name__ == "__main__":
    (Path(__file__).parents[1] / "fields.md").write_text(document(), encoding="utf-8")
