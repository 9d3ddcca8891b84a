"""What was done to a world from outside, as data: kept in files, done again."""

import json

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.record import interventions
from mars2d.record.interventions import Change, Place, Pull, Push, Steer
from mars2d.scenario.experiment import open_experiment
from mars2d.world.verify import rerun
from tests.cases import each_case

SCENARIO = Scenario(robots=[Robot(), Robot(pose=(2, 0, 0))])
BLOCK = Map([[(1.0, 1.0), (1.5, 1.0), (1.5, 1.5)]], name="block")

EACH = [
    Place(3, 1, (0.1, 0.2, 1 / 3)),
    Pull(4, 0, (0.0, 0.1), (1.0, 2.0), 20.0, 2.0),
    Pull(9, 0, (0.0, 0.1), None, 20.0, 2.0),
    Push(9, 0, (0.0, 0.1), (-3.0, 1 / 3), 0.5),
    Change(5, SCENARIO.replace(addons=[BLOCK])),
    Change(6, SCENARIO, ((0, (1.0, 1.0, 0.5)),)),
]


@each_case("intervention", EACH)
def test_each_is_the_same_after_a_way_through_json(intervention):
    text = json.dumps(interventions.to_plain(intervention), allow_nan=False)
    assert interventions.of_plain(json.loads(text)) == intervention


def test_what_is_none_is_refused():
    with pytest.raises((KeyError, TypeError)):
        interventions.of_plain({"type": "Shove", "row": 1})
    with pytest.raises(TypeError):
        interventions.of_plain({"type": "Place", "row": 1})


def ahead(world):
    return np.array([[0.3, 0.2], [0.0, 0.1]])


def changed():
    """A world in which walls were drawn, a robot was put elsewhere, and the law was replaced."""
    world = World(SCENARIO, ahead)
    for k in range(60):
        if k == 10:
            world.change(SCENARIO.replace(addons=[BLOCK]), ahead)
        if k == 20:
            wall = BLOCK.replace(name="wall", outlines=[[(2.0, -2.0), (2.0, -1.5)]])
            world.change(SCENARIO.replace(addons=[BLOCK, wall]), ahead, {0: (0.5, 1.2, 0.0)})
        if k == 40:
            world.change(world.scenario, lambda world: -ahead(world))
        world.step()
    world.break_off("enough")
    return world


def test_a_run_in_which_walls_were_drawn_is_the_same_again_to_the_bit_also_from_a_file(tmp_path):
    record = changed().record
    assert [type(i).__name__ for i in record.interventions] == ["Change"] * 3
    assert len(record.contacts)  # the robot has met the block
    loaded = mars2d.load(record.save(tmp_path / "changed.npz"))
    assert loaded.interventions == record.interventions
    assert loaded.digest == record.digest
    assert rerun(record) is rerun(loaded) is None
    assert [len(record.scenario_at(row).obstacles) for row in (9, 10, 20, 59)] == [0, 1, 2, 2]


def test_driving_by_hand_is_told_of_by_the_record_and_its_checks_are_not_made(tmp_path):
    experiment = open_experiment("pursuit_corners", {"stop_time": 5})
    world = World(experiment.scenario, seed=1)
    for k in range(3):
        world.operator.steer("blue", (0.0, 0.01 * k))
        world.step()
    world.operator.steer("blue", None)
    while not world.over:
        world.step()
    record = world.record
    assert record.interventions == (Steer(0, 1, driven=True), Steer(3, 1, driven=False))
    assert experiment.predictions(record) == ()
    read = mars2d.load(record.save(tmp_path / "driven.npz"))
    assert read.interventions == record.interventions
    assert rerun(read) is None


def test_another_law_is_told_of_and_changes_nothing_else():
    def stand(world):
        return np.zeros((2, 1))

    scenario = Scenario(robots=[Robot()], stop_time=2.0)
    first, second = World(scenario), World(scenario)
    for world in (first, second):
        world.step([[0.3], [0.2]])
    second.change(scenario, stand)
    second.step()
    first.step([[0.0], [0.0]])
    assert np.array_equal(first.pose, second.pose)
    assert [type(each) for each in second.operator.log] == [Change]
