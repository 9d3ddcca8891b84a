"""What Python lets one do behind the simulator's back: refused by one error, or it works."""

from __future__ import annotations

import copy
import pickle

import pytest

import mars2d
from mars2d import InputError, Robot, Scenario, World
from tests.cases import each_case


@each_case("act", [copy.copy, copy.deepcopy, pickle.dumps])
@each_case("of", [lambda w: w, lambda w: w.simulation, lambda w: w.robots[0].world])
def test_a_world_is_not_copied(act, of) -> None:
    world = World(Scenario(robots=[Robot(controller=lambda _robot: (0.3, 0.3))]))
    world.step()
    with pytest.raises(InputError, match=r"a world can't be copied.*World\(world\.scenario, cont"):
        act(of(world))
    assert len(world.record) == 1


def test_a_record_of_a_file_can_be_pickled(tmp_path) -> None:
    record = mars2d.run("own_sensor_and_addon", stop_time=1)
    again = pickle.loads(pickle.dumps(record))
    assert again.digest == record.digest
    assert again.filename == record.filename
    assert again.drawn.shapes == record.drawn.shapes
    assert again.scenario == mars2d.load(record.save(tmp_path / "run.npz")).scenario
    assert copy.copy(record) is copy.deepcopy(record) is record
