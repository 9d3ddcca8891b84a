"""The JSON Schema of scenario files accepts all that is saved, and refuses values beyond bounds."""

from __future__ import annotations

import dataclasses
import json
import math
import re
import tomllib
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from hypothesis import given

from mars2d import Scenario
from mars2d.cli.command_line import main
from mars2d.core.description import Description, schema_of
from mars2d.core.errors import InputError, Mars2dError
from mars2d.scenario import save_scenario, serialize
from mars2d.scenario.schema import schema
from mars2d.scenario.toml_file import read
from tests.cases import each_case
from tests.house.test_any_scenario import scenarios
from tests.worlds import without_laws

SCHEMA = schema()
CHECKER = jsonschema.Draft202012Validator(SCHEMA)
EVERYTHING = Path(__file__).parent / "everything.toml"


def faults(text: str) -> list[str]:
    """Return what the schema refuses in the text of a file."""
    return [error.message[:200] for error in CHECKER.iter_errors(tomllib.loads(text))]


def test_it_is_a_schema():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_it_accepts_a_file_with_everything():
    assert faults(EVERYTHING.read_text(encoding="utf-8")) == []


NO_NUMBERS = (math.nan, math.inf, -math.inf, True, "1", [1.0], 10**400)


def numeric():
    """Yield the parts and fields that are one number, with numbers just beyond their bounds."""
    for kind in serialize.kinds_of(Description).values():
        for field in dataclasses.fields(kind):
            found = schema_of(field)
            types = {*np.atleast_1d(found.get("type", ""))} & {"number", "integer"}
            beyond = [found[name] for name in ("exclusiveMinimum",) if name in found]
            for name, way in (("minimum", -1), ("maximum", 1)):
                if (end := found.get(name)) is not None:
                    whole = types == {"integer"}
                    beyond.append(end + way if whole else math.nextafter(end, way * math.inf))
            if types:
                yield kind, field, beyond


def test_gate_and_schema_refuse_the_same_numbers():
    taken = []
    for kind, field, beyond in numeric():
        name = f"{kind.__name__}.{field.name}"
        for value in (*beyond, *NO_NUMBERS):
            with pytest.raises(InputError, match=rf"{re.escape(name)} = "):
                field.metadata["check"](name, value)
        where = (
            SCHEMA if kind is Scenario else SCHEMA["$defs"][f"{kind.__module__}.{kind.__name__}"]
        )
        checker = CHECKER.evolve(schema=where["properties"][field.name])
        taken += [(name, value) for value in beyond if checker.is_valid(value)]
        assert len(beyond) == 2, f"{name} has a least and a largest value"
    assert taken == []


@pytest.mark.slow
@given(data=scenarios())
def test_the_schema_refuses_nothing_that_the_gate_takes(data, tmp_path_factory):
    """A file with something odd in it: what a Scenario is made of, the schema accepts as saved."""
    try:
        scenario, _ = serialize.to_scenario(data)
    except Mars2dError:
        return
    path = tmp_path_factory.mktemp("schema") / "scene.toml"
    save_scenario(without_laws(scenario), path)
    assert faults(path.read_text(encoding="utf-8")) == []


def test_every_field_says_what_it_accepts_but_for_code():
    silent = {
        f"{name.rpartition('.')[2]}.{field}"
        for name, part in SCHEMA["$defs"].items()
        for field, found in part["properties"].items()
        if not found.keys() - {"description"}
    }
    assert silent == {"Density.function", "Graph.graph", "Theory.draws"}


@each_case(
    ("text", "place"),
    [
        ("[[robots]]\n[[robots]]\nmass = 'heavy'", "robots[1].mass"),
        ("[[robots]]\n[robots.drive]\nmax_linear_speed = -1", "robots[0].drive.max_linear_speed"),
        ("[[robots]]\ncolor = 'rde'", "robots[0].color"),
        ("[[robots]]\ncontroller = 'walk'", "robots[0].controller"),
        ("[[robots]]\ncontroller = { type = 'Wander', speed = 'a' }", "robots[0].controller.speed"),
        ("[[robots]]\nsensors = [{ type = 'Imu', name = 'my imu' }]", "robots[0].sensors[0].name"),
        ("[[props]]\ntype = 'Bal'", "props[0].type"),
        ("[[props]]\ntype = 'Ball'\ndiameter = 1e9", "props[0].diameter"),
        ('title = "two\\nlines"', "title"),
        ("control = 'team'", "control"),
        ("robots = 0", "robots"),
        ("[[robots]]\ndrive = 3", "robots[0].drive"),
        ("[[robots]]\nshape = 'Disc'", "robots[0].shape"),
        ("[[props]]\ntype = 'Ball'\nfriction = 'ruber'", "props[0].friction"),
        ("workspace = [[0, 0], [1, 1]]", "workspace"),
        ("stop_on = ['robot0']", "stop_on"),
    ],
)
def test_gate_and_schema_refuse_the_same_and_an_editor_marks_the_one_value(text, place, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(f"format = 1\n{text}")
    with pytest.raises(InputError):
        read(path)
    found = CHECKER.iter_errors(tomllib.loads(path.read_text()))
    assert [error.json_path for error in found] == [f"$.{place}"]


def test_one_pair_of_bodies_stands_alone_in_a_file(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("format = 1\nrobots = 2\nstop_on = ['robot0', 'robot1']\n")
    assert read(path)[0].stop_on == (("robot0", "robot1"),)
    assert faults(path.read_text()) == []


def test_the_command_prints_it_or_writes_it(tmp_path, capsys):
    assert main(["doctor", "--schema"]) == 0
    printed = capsys.readouterr().out
    assert json.loads(printed) == SCHEMA
    assert main(["doctor", "--schema", str(tmp_path / "a.json")]) == 0
    assert capsys.readouterr().out == ""
    assert (tmp_path / "a.json").read_text() == printed
