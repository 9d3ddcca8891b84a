"""What Python lets a law do behind the simulator's back: refused by one error, or it works."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario, World
from mars2d.bodies import Ball
from mars2d.sensors import RangeFinder
from tests.cases import each_case

ROBOTS = [
    Robot(pose=(x, 0, 0), sensors=[RangeFinder(beams=3, name="r0")]) for x in (-0.31, 0, 0.31)
]
SCENARIO = Scenario(robots=ROBOTS, props=[Ball(pose=(0.5, 0.2))], stop_time=0.5)


def go(world):
    return np.full((2, len(world.robots)), 0.3)


# -- copies ----------------------------------------------------------------------------------------


@each_case("act", [copy.copy, copy.deepcopy, pickle.dumps])
@each_case("of", [lambda w: w, lambda w: w.simulation, lambda w: w.robots[0].world])
def test_a_world_is_not_copied(act, of) -> None:
    world = World(SCENARIO, go)
    world.step()
    with pytest.raises(InputError, match=r"a world can't be copied.*World\(world\.scenario, cont"):
        act(of(world))
    assert len(world.record) == 1


EXPERIMENT = """
from mars2d import Robot, Scenario

def control(robot):
    return 0.1, 0.2

scenario = Scenario(robots=[Robot(pose=(0, 0, 0), controller=control)], stop_time=1)
"""


def test_a_record_of_a_file_can_be_pickled(tmp_path) -> None:
    (tmp_path / "walk.py").write_text(EXPERIMENT)
    record = mars2d.run(tmp_path / "walk.py")
    again = pickle.loads(pickle.dumps(record))
    assert again.digest == record.digest
    assert again.filename == record.filename
    assert again.drawn.shapes == record.drawn.shapes
    assert again.scenario == mars2d.load(record.save(tmp_path / "run.npz")).scenario
    assert copy.copy(record) is copy.deepcopy(record) is record
