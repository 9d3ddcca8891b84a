"""The JSON Schema of scenario files, from the checks of their fields."""

from __future__ import annotations

import dataclasses
from typing import Any

from mars2d.core import checks
from mars2d.core.description import Description, Schema, schema_of
from mars2d.scenario import serialize
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import Place
from mars2d.scenario.toml_file import FORMAT, NONE, READY_MADE, takes_none

LAW: Schema = {
    "type": "string",
    "pattern": rf"\.py(:_*{checks.NAME})?$",
    "description": "a law, such as file.py:function",
}


def schema() -> Schema:
    """Return the JSON Schema (2020-12) of the data in a scenario file.

    It accepts every file that `save_scenario` writes, and refuses every number beyond the bounds of
    its field. Conditions between fields, such as robots that overlap, are beyond it.
    """
    kinds = [kind for kind in serialize.all_kinds().values() if kind is not Scenario]
    scenario = _table(Scenario)
    scenario["properties"] |= {"format": {"const": FORMAT}, "control": LAW}
    scenario["required"] = ["format", *scenario.get("required", [])]
    scenario["properties"].pop("type")
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A scenario of MARS2D",
        **scenario,
        "$defs": {_key(kind): _table(kind) for kind in sorted(kinds, key=_key)},
    }


def _key(kind: type[Description]) -> str:
    """Return the name of a part's definition; two parts, a sensor and an add-on, are a Beacon."""
    return f"{kind.__module__}.{kind.__name__}"


def _table(kind: type[Description]) -> Schema:
    """Return the schema of a part's table."""
    places = serialize.parts_of(kind)
    properties: dict[str, Schema] = {"type": {"const": kind.__name__}}
    needed = _needed(kind)
    for field in dataclasses.fields(kind):
        found = _values(kind, field, places.get(field.name))
        about = ", ".join(filter(None, [field.metadata.get("doc"), field.metadata.get("unit")]))
        properties[field.name] = found | ({"description": about} if about else {})
    found = {"type": "object", "properties": properties, "additionalProperties": False}
    return found | ({"required": needed} if needed else {})


def _needed(kind: type[Description]) -> list[str]:
    """Return the fields of a part that have no default."""
    missing = dataclasses.MISSING
    fields = dataclasses.fields(kind)
    return [each.name for each in fields if each.default is each.default_factory is missing]


def _values(kind: type[Description], field: dataclasses.Field[Any], place: Place | None) -> Schema:
    """Return the schema of a field's values."""
    if place is not None:
        found = _parts(place)
        if kind is Scenario and field.name == "robots":
            found |= {"type": ["array", "integer"], "minItems": 1, "minimum": 1, "maximum": 10_000}
    elif field.name == "controller" and issubclass(kind, Robot):
        found = _parts(READY_MADE, LAW)
    else:
        found = schema_of(field)
    return {"if": {"not": {"const": NONE}}, "then": found} if found and takes_none(field) else found


def _parts(place: Place, otherwise: Schema | None = None) -> Schema:
    """Return the schema of one part, or of a list. otherwise: of a text that names none.

    A table's type alone decides by which schema its fields are judged, so an editor marks the one
    value that is wrong, and not all the tables around it.
    """
    kinds = serialize.kinds_of(place.base)
    named: Schema = {"enum": list(kinds)}
    table: Schema = {"properties": {"type": named}}
    if place.default is None:
        table["required"] = ["type"]
    table["allOf"] = [
        {
            "if": {"properties": {"type": {"const": name}}}
            | ({} if kind is place.default else {"required": ["type"]}),
            "then": {"$ref": f"#/$defs/{_key(kind)}"},
        }
        for name, kind in kinds.items()
    ]
    alone: Schema = {"enum": [name for name, kind in kinds.items() if not _needed(kind)]}
    one: Schema = {
        "type": ["string", "object"],
        "if": {"type": "string"},
        "then": {"anyOf": [alone, otherwise]} if otherwise else alone,
        "else": {"if": {"type": "object"}, "then": table},
    }
    return {"type": "array", "items": one} if place.many else one
