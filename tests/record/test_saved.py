"""What was saved earlier opens: records of each format, a scenario file."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d import Scenario
from mars2d.bodies.drives import Dubins, Omni
from mars2d.scenario import load_scenario, save_scenario
from mars2d.scenario.registry import FAMILIES, members
from tests.cases import each_case

HERE = Path(__file__).parent
FORMATS = ("npz", "csv", "mcap")
EXPECTED = json.loads((HERE / "saved" / "expected.json").read_text(encoding="utf-8"))
SCENARIO = HERE.parent / "scenario" / "saved" / "everything_0_1.toml"
LOST = ("sensor Eyes", "prop Egg", "add-on Fence")


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario(SCENARIO)


@each_case("ending", FORMATS)
def test_a_record_saved_earlier_opens_with_the_same_digest_and_scenario(ending, scenario):
    record = mars2d.load(HERE / "saved" / f"run.{ending}")
    assert record.digest == EXPECTED["digest"]
    assert record.versions["mars2d"] == EXPECTED["version"]
    assert len(record) == EXPECTED["rows"]
    assert sorted(record.sensors) == EXPECTED["sensors"]
    for name in ("messages", "contacts", "interventions"):
        assert len(getattr(record, name)) == EXPECTED[name] > 0, name
    assert record.scenario == scenario
    assert record.missing == LOST  # code of the user's own


def test_a_scenario_saved_before_the_rooms_has_parts_of_all_families(scenario):
    parts = {
        "bodies": [robot.drive for robot in scenario.robots],
        "props": scenario.props,
        "joints": [joint.joint for joint in scenario.ties],
        "sensors": [sensor for robot in scenario.robots for sensor in robot.sensors],
        "addons": scenario.addons,
    }
    assert set(parts) == set(FAMILIES) - {"controllers"}  # which came later
    parts["bodies"] += [Dubins(), Omni()]
    for family in ("bodies", "props", "joints"):
        assert {type(part).__name__ for part in parts[family]} == {*members(family)}
    assert {type(part).__name__ for part in parts["sensors"]} == {*members("sensors")}
    assert len(parts["addons"]) > 8
    assert np.isfinite([joint.length for joint in scenario.ties]).all()


def test_a_scenario_saved_before_the_rooms_is_saved_the_same_now(scenario, tmp_path):
    assert save_scenario(scenario, tmp_path / "scenario.toml") == ()
    now = (tmp_path / "scenario.toml").read_text(encoding="utf-8").splitlines()
    before = SCENARIO.read_text(encoding="utf-8").splitlines()
    said = [line for line in before if not line.startswith("#")]
    assert [line for line in now if not line.startswith("#")] == said
