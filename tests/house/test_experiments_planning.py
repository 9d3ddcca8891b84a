"""The experiments path_planning and leader_following, and the floor that the first is played on."""

import dataclasses
import json
from math import hypot, pi

import numpy as np
import pytest
import shapely
from scipy.optimize import brentq, minimize

import mars2d
from mars2d import Robot, Scenario
from mars2d.addons import Map, PotentialField, Waypoints
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment, open_module
from tests.worlds import predicted, solution

pytestmark = [pytest.mark.slow, pytest.mark.nightly]

FLOOR = examples()["path_planning"].with_name("maps") / "department.dxf"


@pytest.fixture(scope="module")
def planned():
    return predicted("path_planning")


@pytest.fixture(scope="module")
def followed():
    return predicted("leader_following")


# -- the floor ------------------------------------------------------------------------------------


def test_the_outlines_are_those_of_the_drawing():
    script = open_module(FLOOR.with_name("make_department.py"))
    outlines = FLOOR.with_suffix(".geojson")
    shipped, made = (
        json.loads(text)["features"]
        for text in (outlines.read_text(encoding="utf-8"), script.outlines(FLOOR))
    )
    for one, other in zip(shipped, made, strict=True):
        assert one["properties"] == other["properties"]
        lines = [shapely.geometry.shape(feature["geometry"]) for feature in (one, other)]
        assert shapely.hausdorff_distance(*lines, densify=0.01) < 2e-3


def test_the_floor_is_30_by_20_metres_and_its_doors_are_open():
    walls = Map.from_file(FLOOR, layers=["WALLS", "FURNITURE"])
    points = np.array([p for outline in walls.obstacles() for p in outline])
    assert points.min(axis=0).tolist() == [0, 0]
    assert points.max(axis=0).tolist() == [30, 20]
    lines = [shapely.LineString([*o, o[0]] if len(o) > 2 else o) for o in walls.obstacles()]
    for door in [(3.7, 6.075), (16.5, 8.625), (26.5, 8.625), (10.2, 8.625), (22.075, 9.8)]:
        room = min(line.distance(shapely.Point(door)) for line in lines)
        assert room >= 0.499, door


# -- path_planning --------------------------------------------------------------------------------


def test_the_predicted_minimum_is_one_of_the_potential_found_without_forces(planned):
    """Of the potential alone, by a simplex that knows neither the force nor the run."""
    record, predictions = planned
    _, ways, addon = record.scenario.addons
    field, goal = addon.of(record.scenario), ways.routes[2][-1]
    options = {"xatol": 1e-9, "fatol": 1e-14}
    start = [21.2, 13.4]  # in the store
    found = minimize(lambda at: field.potential(at, goal), start, method="Nelder-Mead",
                     options=options)  # fmt: skip
    stuck = [predictions[f"robot2 is stuck at {axis}"].predicted for axis in "xy"]
    assert found.x == pytest.approx(stuck, abs=1e-6)
    around = [(stuck[0] + 0.01 * np.cos(a), stuck[1] + 0.01 * np.sin(a)) for a in range(7)]
    assert all(field.potential(at, goal) > field.potential(stuck, goal) for at in around)


def test_the_numbers_of_the_model_answer_on_walls_and_doors(planned):
    record, _ = planned
    field = record.scenario.addons[2].of(record.scenario)

    def push(rho):
        return 0.01 * (1 / rho - 1 / 0.6) / rho**2 if rho < 0.6 else 0.0

    rho = brentq(lambda r: push(r) + push(r + 0.15) - 0.5, 0.05, 0.5)
    assert rho == pytest.approx(0.239, abs=5e-4)
    assert record.pose[-1, 0, 2] == pytest.approx(22 - 0.2 - rho, abs=0.003)
    door = [0.5 + field.force((26.5, y), (26.5, -100))[1] for y in np.linspace(8.7, 9.5, 400)]
    assert max(door) == pytest.approx(0.2263, abs=1e-3)


def test_two_robots_head_on_in_a_corridor_repel_each_other_and_pass_if_there_is_room():
    law = open_module("path_planning").control
    for width, reached in ((1.2, (0, 0)), (1.6, (1, 1))):
        walls = [[(-5, side * width / 2), (5, side * width / 2)] for side in (-1, 1)]
        robots = [Robot(pose=(-4, 0, 0), diameter=0.4), Robot(pose=(4, 0, pi), diameter=0.4)]
        ways = Waypoints([[(4, 0)], [(-4, 0)]])
        addons = [Map(walls), ways, PotentialField()]
        scenario = Scenario(robots=robots, workspace=None, stop_time=60, addons=addons)
        record = mars2d.run(scenario, control=law)
        assert record.collisions == 0
        assert ways.of(record.frame(-1)) == reached
        if reached == (0, 0):
            rho = brentq(lambda r: 0.01 * (1 / r - 1 / 0.6) / r**2 - 0.5, 0.05, 0.6)
            assert np.diff(record.pose[-1, 0]) == pytest.approx(rho + 0.4, abs=5e-4)


def test_the_model_answer_brings_the_third_by_a_plan_that_is_hardly_longer():
    record, predictions = predicted(solution("path_planning"))
    assert [p for p in predictions.values() if not p.ok] == []
    ways = record.scenario.addons[1]
    assert ways.of(record.frame(-1)) == tuple(map(len, ways.routes))
    rise = predictions["rise of the potential"]
    backwards = dataclasses.replace(record, pose=record.pose[::-1].copy())
    seen = open_experiment(solution("path_planning")).predictions(backwards)
    assert next(p for p in seen if p.name == rise.name).ok is False


# -- leader_following -----------------------------------------------------------------------------


def test_the_followers_keep_their_places(followed):
    """Distance and bearing of the points ahead of the axles, in the frame of the leader."""
    record, _ = followed
    base = open_module("leader_following")
    x, y, theta = record.pose[-1]
    px, py = x + base.D * np.cos(theta) - x[0], y + base.D * np.sin(theta) - y[0]
    for i, (distance, bearing) in enumerate(base.PLACES, start=1):
        assert hypot(px[i], py[i]) == pytest.approx(distance, abs=1e-3)
        seen = np.arctan2(py[i], px[i]) - theta[0]
        assert (seen - bearing + pi) % (2 * pi) - pi == pytest.approx(0, abs=1e-3)


def test_errors_of_distance_fade_by_the_gain(followed):
    record, _ = followed
    base = open_module("leader_following")
    x, y, theta = record.pose.swapaxes(0, 1)
    far = np.hypot(x[:, 2] + base.D * np.cos(theta[:, 2]) - x[:, 0],
                   y[:, 2] + base.D * np.sin(theta[:, 2]) - y[:, 0])  # fmt: skip
    a, b = np.searchsorted(record.time, [2, 6])
    left = np.abs(far[[a, b]] - base.PLACES[1][0])
    assert left[1] / left[0] == pytest.approx(np.exp(-4 * base.GAIN), abs=0.01)


def test_the_examples_followers_need_each_message_and_those_of_the_model_answer_do_not():
    _, example = predicted("leader_following", **{"addons.0.loss": 0.5})
    assert not any(p.ok for p in example.values())
    _, answer = predicted(solution("leader_following"), loss=0.8)
    assert all(p.ok for p in answer.values())


def test_who_takes_the_leader_to_stand_still_lags_behind():
    _, answer = predicted(solution("leader_following"))
    lag = answer["robot3: distance"]
    assert lag.ok
    assert lag.predicted == pytest.approx(1.646, abs=1e-3)
    assert open_module("leader_following").PLACES[2][0] == 1.4
