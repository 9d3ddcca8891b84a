"""Many small robots are seen and named, and what is drawn of them has legends."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, Robot, Scenario
from mars2d.addons import Communication, Theory
from mars2d.core.scene import Circle, Text
from mars2d.output.figures.contacts import plot_contacts
from mars2d.output.figures.figure import plot_paths, save_drawing
from mars2d.output.figures.signals import plot_signals
from mars2d.output.layers import bodies
from mars2d.output.layers.legend import legends
from mars2d.output.layers.placement import placed_names
from mars2d.output.layers.rings import RING, place_ring
from mars2d.output.layers.table import of_bodies
from mars2d.sensors import Beacon, Imu, Proximity, RangeBearing, RangeFinder, SonarRing
from tests.cases import each_case


def frame_of(scenario):
    from mars2d import World

    return World(scenario).frame


# -- rings -----------------------------------------------------------------------------------------


@each_case("side, count", [(10, 0), (24, 0), (26, 3), (200, 3)])
def test_robots_of_less_than_a_hundredth_of_the_arena_have_rings(side, count):
    half = side / 2
    area = [(-half, -half), (half, -half), (half, half), (-half, half)]
    robots = [Robot(pose=(k, 0, 0), diameter=0.3) for k in range(3)]
    found = of_bodies(place_ring)(frame_of(Scenario(robots=robots, workspace=area))).shapes
    assert len(found) == count
    for ring in found:
        assert isinstance(ring, Circle)
        assert (ring.radius, ring.pixels) == (0.0, RING)  # under a robot that is seen large


# -- names -----------------------------------------------------------------------------------------


def boxes(scene, point):
    """Return the boxes of the names of a scene, metres."""
    for label in scene.shapes:
        if isinstance(label, Text):
            half = np.array([0.3 * len(label.text), 0.6]) * label.size * point
            up = half[1] if label.anchor == "above" else 0.0
            yield label.position + np.array([0.0, up]), half


@each_case("first", [None, 0, 7])
@each_case("count", [2, 9, 30, 80])
def test_names_share_nothing_with_each_other_whoever_is_selected(count, first):
    rng = np.random.default_rng(count)
    side = int(np.ceil(np.sqrt(count)))
    robots = [
        Robot(pose=(0.5 * (k % side), 0.5 * (k // side), rng.uniform(0, 6))) for k in range(count)
    ]
    frame = frame_of(Scenario(robots=robots, workspace=None))
    first = None if first is None else min(first, count - 1)
    scene = placed_names(
        of_bodies(bodies.draw_name)(frame), frame, 0.012, (-7, 11, -7, 11), (), first
    )
    found = list(boxes(scene, 0.012))
    assert len(found) == count
    for (one, half), (other, its) in combinations(found, 2):
        assert (np.abs(one - other) >= half + its - 1e-9).any()


def test_a_name_stays_at_its_place_as_long_as_that_is_as_good():
    last: dict[int, int] = {}
    places = []
    for shift in np.linspace(0, 0.02, 5):  # two robots that pass each other slowly
        robots = [Robot(pose=(0, 0, 0)), Robot(pose=(0.31 + shift, 0, 0))]
        frame = frame_of(Scenario(robots=robots, workspace=None))
        placed_names(of_bodies(bodies.draw_name)(frame), frame, 0.02, (-9, 9, -9, 9), last=last)
        places.append(dict(last))
    assert places[0]
    assert all(place == places[0] for place in places)


# -- legends ---------------------------------------------------------------------------------------


def meanings(scenario):
    return {each.layer: [sign.name for sign in each.signs] for each in legends(scenario)}


def test_messages_theory_and_sensors_have_legends_where_they_are_drawn():
    assert meanings(Scenario(robots=2)).keys() == {"forces", "impulses", "velocities"}
    sensors = [SonarRing(), RangeFinder(), Proximity(range=1), RangeBearing(), Beacon(), Imu()]
    addons = [Communication(), Theory(lambda scene, frame: None)]
    found = meanings(Scenario(robots=[Robot(sensors=sensors)], addons=addons))
    assert found["messages"] == ["message", "message lost"]
    assert found["theory"] == ["theory"]
    assert found["sensors"] == [
        "a sonar's echo", "a laser's hit", "something is near", "range and bearing",
    ]  # fmt: skip


# -- figures ---------------------------------------------------------------------------------------


@pytest.mark.slow
def test_figures_of_a_hundred_robots_are_files_of_less_than_two_megabytes(tmp_path):
    robots = [Robot(pose=(k % 10, k // 10, 0), drive=Holonomic()) for k in range(98)]
    scenario = Scenario(robots=robots, workspace=None, physics="ideal", stop_time=60)
    noise = np.random.default_rng(1)
    record = mars2d.run(scenario, control=lambda world: noise.normal(size=(2, 98)))
    figures = {
        "paths": lambda: plot_paths(record).figure,
        "signals": lambda: plot_signals(record, ["x", "speed", "command"])[0].figure,
        "contacts": lambda: plot_contacts(record)[0].figure,
    }
    for name, draw in figures.items():
        file = save_drawing(draw, tmp_path / f"{name}.svg")
        assert file.stat().st_size < 2e6, name
    assert len(record._repr_svg_()) < 2e6
    assert len(record._repr_html_()) < 2e6
