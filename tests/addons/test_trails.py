"""Trails: the last seconds of the robots' ways, the same in windows, figures and replays."""

from itertools import pairwise

import numpy as np
import pytest

import mars2d
from mars2d import InputError, Robot, Scenario
from mars2d.addons import Trails
from mars2d.core.scene import Line, rgb
from mars2d.output.layers import addons as drawn
from tests.cases import each_case

PACE = 0.5  # m/s


def ahead(robot):
    return PACE, 0.0


def record_of(*addons, robots=2, sampling_time=0.1, stop_time=6.0):
    starts = [Robot(pose=(0, k, 0), controller=ahead) for k in range(robots)]
    return mars2d.run(
        Scenario(
            robots=starts,
            addons=addons,
            workspace=None,
            physics="ideal",
            sampling_time=sampling_time,
            stop_time=stop_time,
        )
    )


def lines(seen):
    return [shape for shape in drawn.addons(seen).shapes if isinstance(shape, Line)]


def strength(line):
    """How much there is of the robot's blue, over white."""
    return (1 - rgb(line.stroke)[0]) / (1 - rgb("#0072b2")[0])


def test_a_trail_goes_back_for_its_duration_and_ends_at_the_robot():
    record = record_of(Trails(duration=2.0), robots=1)
    points = np.concatenate([line.points for line in lines(record.frame(50))])  # at 5 s
    assert points[:, 0].min() == pytest.approx(PACE * 3.0)
    assert points[:, 0].max() == pytest.approx(PACE * 5.0)
    assert np.all(points[:, 1] == 0.0)


def test_a_trail_fades_out_without_gaps():
    record = record_of(Trails(duration=2.0), robots=1)
    drawn = lines(record.frame(50))
    colors = [strength(line) for line in drawn]
    assert colors == sorted(colors)
    assert colors[0] < 0.15
    assert colors[-1] == pytest.approx(0.85, abs=0.01)
    for before, after in pairwise(drawn):
        assert before.points[-1].tolist() == after.points[0].tolist()


@each_case(
    ("fields", "message"),
    [
        ({"duration": 0}, r"Trails.duration = 0: expected a number > 0"),
        ({"width": -1}, r"Trails.width = -1: expected a number > 0"),
    ],
)
def test_trails_that_can_not_be_are_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        Trails(**fields)
