"""The JSON Schema of scenario files, from the checks of their fields."""

from __future__ import annotations

import dataclasses
from typing import Any

from mars2d.core.description import Description, Schema, schema_of
from mars2d.scenario import serialize
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.scenario.serialize import Place
from mars2d.scenario.toml_file import FORMAT, NONE, READY_MADE, takes_none

LAW: Schema = {"type": "string", "description": "a law, such as file.py:function"}


def schema() -> Schema:
    """Return the JSON Schema (2020-12) of the data in a scenario file.

    It knows the parts that other packages have registered. It accepts every file that
    `save_scenario` writes, and refuses every number beyond the bounds of its field. Conditions
    between fields, such as robots that overlap, are beyond it.
    """
    places = [place for fields in serialize.PARTS.values() for place in fields.values()]
    bases = {place.base for place in (*places, READY_MADE)}
    kinds = {kind for base in bases for kind in serialize.kinds_of(base).values()}
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
    needed: list[str] = []
    for field in dataclasses.fields(kind):
        found = _values(kind, field, places.get(field.name))
        about = ", ".join(filter(None, [field.metadata.get("doc"), field.metadata.get("unit")]))
        properties[field.name] = found | ({"description": about} if about else {})
        given = (field.default, field.default_factory)
        if given == (dataclasses.MISSING, dataclasses.MISSING):
            needed.append(field.name)
    twins = {twin: name for twin, (name, _) in kind.twins.items()}
    properties |= {twin: {"type": "number"} for twin in twins}
    either = [[name, *(t for t in twins if twins[t] == name)] for name in needed]
    found = {"type": "object", "properties": properties, "additionalProperties": False}
    if required := [names[0] for names in either if len(names) == 1]:
        found["required"] = required
    if several := [names for names in either if len(names) > 1]:
        found["allOf"] = [{"anyOf": [{"required": [n]} for n in names]} for names in several]
    return found


def _values(kind: type[Description], field: dataclasses.Field[Any], place: Place | None) -> Schema:
    """Return the schema of a field's values."""
    if place is not None:
        found = _parts(place)
        if kind is Scenario and field.name == "robots":
            found = {"anyOf": [found, {"type": "integer", "minimum": 1}]}
    elif field.name == "controller" and issubclass(kind, Robot):
        found = {"anyOf": [LAW, *_parts(READY_MADE)["anyOf"]]}
    else:
        found = schema_of(field)
    return {"anyOf": [found, {"const": NONE}]} if found and takes_none(field) else found


def _parts(place: Place) -> Schema:
    """Return the schema of one part, or of a list."""
    kinds = serialize.kinds_of(place.base)
    tables = []
    for kind in kinds.values():
        table: Schema = {"$ref": f"#/$defs/{_key(kind)}"}
        tables.append(table if kind is place.default else table | {"required": ["type"]})
    one: Schema = {"anyOf": [{"enum": list(kinds)}, *tables]}
    return {"type": "array", "items": one} if place.many else one
