"""What Python lets a law do behind the simulator's back: refused by one error, or it works."""

from __future__ import annotations

import copy
import itertools
import pickle

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies import Ball
from mars2d.sensors import RangeFinder
from mars2d.study.plan import seeds_of, settings_of
from tests.cases import each_case

ROBOTS = [
    Robot(pose=(x, 0, 0), sensors=[RangeFinder(beams=3, name="r0")]) for x in (-0.31, 0, 0.31)
]
SCENARIO = Scenario(robots=ROBOTS, props=[Ball(pose=(0.5, 0.2))], stop_time=0.5)


def go(world):
    return np.full((2, len(world.robots)), 0.3)


# -- arrays that are written all the same ----------------------------------------------------------

ARRAYS = [
    "pose", "velocity", "position", "prop_pose", "prop_velocity", "command", "effort", "contacts",
    "history.pose", "history.time", "history.command", "record.pose", "record.contacts",
    "record.messages", "props[0].pose", "record.sensors.get('r0')", "robots[0].sense.r0",
]  # fmt: skip


def test_an_array_of_the_world_stays_as_it_is() -> None:
    def control(world):
        for name in ARRAYS:
            array = eval(f"world.{name}", {"world": world})
            if isinstance(array, np.ndarray) and array.size:
                with pytest.raises(ValueError, match="read-only"):
                    array[...] = 0
        return go(world)

    record = mars2d.run(SCENARIO, control=control)
    assert record.digest == mars2d.run(SCENARIO, control=go).digest


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


# -- lists without an end -----------------------------------------------------------------------


@each_case(
    ("make", "name"),
    [
        (lambda: Scenario(robots=itertools.repeat(Robot())), "Scenario.robots"),
        (lambda: Robot(pose=itertools.count()), "Robot.pose"),
        (lambda: Map(itertools.repeat([(0, 0), (1, 0)])), "Map.outlines"),
        (lambda: Map([itertools.cycle([(0, 0), (1, 0)])]), r"Map.outlines\[0\]"),
        (lambda: Map(walls=[zip(itertools.count(), itertools.count())]), r"Map.walls\[0\]"),
        (lambda: seeds_of(itertools.count()), "seeds"),
        (lambda: settings_of({"mass": range(10**15)}), r"settings\['mass'\]"),
        (lambda: mars2d.sweep(SCENARIO, measures=itertools.repeat("end time")), "measures"),
    ],
)
def test_a_list_without_an_end_is_refused(make, name) -> None:
    with pytest.raises(InputError, match=rf"^{name} = .*at most 1,000,000: it has more, or no end"):
        make()
