"""Clearances are the distances between surfaces: checked where one can work them out by hand."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Map
from mars2d.bodies.joints import Hinge
from mars2d.bodies.props import Box, Puck
from mars2d.geometry.shapes import rectangle
from mars2d.output.figures.distances import clearances, nearest_body
from mars2d.record.interventions import Change


def still(world):
    return 0 * world.command


def ahead(world):
    n = world.command.shape[1]
    return [[0.2] * n, [0.0] * n]


def run(law=still, **fields):
    return mars2d.run(Scenario(**({"stop_time": 1, "workspace": None} | fields)), control=law)


def test_the_clearance_of_two_discs_is_the_distance_less_both_radii():
    robots = [Robot(pose=(0, 0, 0)), Robot(pose=(3, 4, 0), diameter=1.0)]
    found = clearances(run(robots=robots))
    assert found.pairs.tolist() == [[0, 1]]
    np.testing.assert_allclose(found.pair, 5 - 0.15 - 0.5)
    assert found.obstacle is None


def test_two_that_drive_at_each_other_close_in_with_twice_their_speed():
    robots = [Robot(pose=(-1, 0, 0)), Robot(pose=(1, 0, np.pi))]
    record = run(ahead, robots=robots, stop_time=4)
    expected = 2 - 0.3 - 0.4 * record.time
    np.testing.assert_allclose(clearances(record).pair[:, 0], expected, atol=1e-9)


def test_a_disc_off_the_centre_of_rotation_is_measured_where_it_is():
    robots = [Robot(pose=(0, 0, np.pi / 2), center_offset=0.1), Robot(pose=(0, -1, 0))]
    (gap,) = clearances(run(robots=robots)).pair[0]
    assert gap == pytest.approx(1 - 0.1 - 0.3)


def test_boxes_are_measured_from_side_to_side_and_from_corner_to_disc():
    car = rectangle(0.4, 0.2)
    robots = [Robot(pose=(0, 0, 0), shape=car), Robot(pose=(1, 0, np.pi / 2), shape=car)]
    props = [
        Box(pose=(0, 1, np.pi / 4), length=0.2, width=0.2, name="b"),
        Puck(pose=(0.5, -0.5, 0)),
    ]
    found = clearances(run(robots=robots, props=props))
    gap = dict(zip(map(tuple, found.pairs.tolist()), found.pair[0].tolist(), strict=True))
    assert gap[0, 1] == pytest.approx(1 - 0.2 - 0.1)
    assert gap[0, 2] == pytest.approx(1 - 0.1 - 0.1 * np.sqrt(2)), "a corner points down"
    radius = record_radius(props[1])
    assert gap[0, 3] == pytest.approx(np.hypot(0.5 - 0.2, 0.5 - 0.1) - radius)
    assert (2, 3) not in gap, "no robot is among them"


def record_radius(prop):
    return prop.shape.bound[1]


def test_the_clearance_to_obstacles_is_that_of_the_nearest_one():
    square = [(2, -1), (4, -1), (4, 1), (2, 1)]
    robots = [Robot(pose=(0, 0, 0)), Robot(pose=(0, 2, 0))]
    found = clearances(run(robots=robots, addons=[Map([square, [(-9, 3), (9, 3)]])]))
    np.testing.assert_allclose(found.obstacle[0], [2 - 0.15, 1 - 0.15])


def test_in_an_obstacle_the_clearance_is_negative():
    fields = {"robots": [Robot(pose=(0, 0, 0))], "physics": "ideal", "stop_time": 10}
    record = run(ahead, addons=[Map([[(1, -1), (3, -1), (3, 1), (1, 1)]])], **fields)
    obstacle = clearances(record).obstacle[:, 0]
    assert obstacle[0] == pytest.approx(1 - 0.15)
    assert obstacle[-1] == pytest.approx(-0.15), "its centre is within"


def test_the_clearance_is_zero_while_there_are_contacts_and_more_otherwise():
    record = mars2d.run("head_on", stop_time=3)
    found = clearances(record)
    pair = found.pairs.tolist().index([0, 1])
    rows = record.contacts[(record.contacts["a"] == 0) & (record.contacts["b"] == 1)]
    end = np.round((rows["time"] + rows["duration"]) / record.scenario.sampling_time).astype(int)
    touching = np.zeros(len(record), dtype=bool)
    touching[end[~rows["ended"]]] = True
    assert touching.sum() > 20
    assert np.abs(found.pair[touching, pair]).max() <= record.scenario.max_overlap
    assert found.pair[~touching, pair].min() > 1e-3


def test_what_a_hinge_joins_has_no_clearance():
    robots = [Robot(pose=(0, 0, 0), name="a"), Robot(pose=(0.4, 0, 0), name="b")]
    joints = [Hinge(a="a", b="b", anchor_a=(0.2, 0), anchor_b=(-0.2, 0))]
    assert clearances(run(robots=robots, joints=joints)).pairs.tolist() == []


def test_obstacles_that_were_changed_count_from_then_on():
    record = run(robots=[Robot(pose=(0, 0, 0))], addons=[Map([[(1, -1), (1, 1)]])])
    later = record.scenario.replace(addons=[Map([[(2, -1), (2, 1)]])])
    changed = dataclasses.replace(record, interventions=(Change(5, later),))
    obstacle = clearances(changed).obstacle[:, 0]
    np.testing.assert_allclose(obstacle[:5], 1 - 0.15)
    np.testing.assert_allclose(obstacle[5:], 2 - 0.15)


def test_few_pairs_have_a_curve_each_and_the_nearest_obstacle_one():
    robots = [Robot(pose=(x, 0, 0), name=name) for x, name in enumerate("abc")]
    record = run(robots=robots, addons=[Map([[(-1, -1), (3, -1)]])])
    ax = record.plot_distances()
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    dash = "\N{EN DASH}"
    assert legend == [f"a {dash} b", f"a {dash} c", f"b {dash} c", "nearest robot to an obstacle"]
    curves = [line for line in ax.lines if len(line.get_xdata()) == len(record)]
    np.testing.assert_allclose([line.get_ydata()[0] for line in curves], [0.7, 1.7, 0.7, 0.85])


def test_of_many_the_least_the_mean_and_the_most_have_a_curve():
    robots = [Robot(pose=(x * x, 0, 0)) for x in range(1, 6)]  # gaps 3, 5, 7, 9 less 0.3
    record = run(robots=robots)
    nearest = nearest_body(clearances(record), 5)
    np.testing.assert_allclose(nearest[0], np.array([3, 3, 5, 7, 9]) - 0.3)
    first = [line.get_ydata()[0] for line in record.plot_distances().lines[:3]]
    np.testing.assert_allclose(first, [2.7, 5.1, 8.7])
