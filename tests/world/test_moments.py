"""Moments within a control step: what they show, and that they are those of the run."""

import numpy as np
import pytest

from mars2d.scenario.experiment import open_experiment
from mars2d.world.moments import PARTS
from mars2d.world.timeline import Timeline

STRIKE = """
from mars2d import Robot, Scenario
from mars2d.bodies.props import Puck


def ahead(robot):
    return 0.5, 0.0


puck = Puck(name="puck", pose=(0.31, 0, 0), diameter=0.2, mass=0.5, ground_friction=0.0)
robot = Robot(diameter=0.3, controller=ahead)
scenario = Scenario(robots=[robot], props=[puck], sampling_time=0.1, command_delay=0.03)
"""
"""The robot meets the puck after 0.06 m."""


@pytest.fixture
def strike(tmp_path):
    path = tmp_path / "strike.py"
    path.write_text(STRIKE)
    timeline = Timeline(open_experiment(path))
    while timeline.newest < 6:
        timeline.advance()
    return timeline


def test_a_blow_is_seen_before_at_and_after_its_touch(strike):
    (met,) = strike.contacts["time"][strike.contacts["began"]]
    strike.go(int(met / 0.1))
    moments = strike.within()
    times = [each.time for each in moments]
    assert len(moments) == PARTS + 1
    assert times == sorted(times)
    assert min(abs(time - met) for time in times) < 1e-9
    assert [len(each.contacts) for each in moments if each.time < met - 1e-9] == [0] * int(
        (met % 0.1) / (0.1 / PARTS)
    )
    for each in moments:
        if each.time > met + 1e-9:
            ((force, impulse),) = [(each.contacts["impulse"], each.contact_log()["impulse"][-1:])]
            assert force == pytest.approx(impulse * 0.1 / (each.time - strike.frame.time))
            assert each.exact_velocity[0, 1] == pytest.approx(impulse[0] / 0.5)


def test_the_last_moment_has_all_bits_of_the_next_row_and_nothing_is_recorded(strike):
    digest, newest = strike.record.digest, strike.newest
    for row in range(newest + 1):
        strike.go(row)
        last = strike.within()[-1]
        if row < newest - 1:
            following = strike.recorded.frame(row + 1)
            assert np.array_equal(last.pose, following.pose)
            assert np.array_equal(last.prop_pose, following.prop_pose)
            assert np.array_equal(last.exact_velocity, following.exact_velocity)
    assert strike.newest == newest
    assert strike.record.digest == digest


def test_hands_act_within_the_step_too(strike):
    strike.go(strike.newest)
    strike.world.operator.push("puck", (0.0, 2.0), 0.05)
    strike.world.operator.pull(0, (0.0, 0.0), (0.0, 5.0), 50.0)
    last = strike.within()[-1]
    strike.advance()
    assert np.array_equal(last.pose, strike.frame.pose)
    assert np.array_equal(last.prop_pose, strike.frame.prop_pose)
