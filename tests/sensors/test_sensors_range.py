"""What is exactly at a sensor's range, or at the edge of its view: one rule for all."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, isfinite, sin

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.addons import Beacon, Map
from mars2d.scenario.neighbours import Within
from mars2d.sensors import Beacon as Lookout
from mars2d.sensors import LineCamera, Proximity, RangeBearing, RangeFinder, SonarRing
from tests.cases import each_case

BEYOND = 1 + 1e-6
TURNS = (0.0, 1.1, -2.7)


def place(distance: float, angle: float) -> tuple[float, float]:
    return 0.7 + distance * cos(angle), -0.4 + distance * sin(angle)


def readings(turn: float, sensors: list, addon, others=()) -> Iterator[tuple[str, float]]:
    """What each sensor reads at (0.7, -0.4): the first number, or the range of what it sights."""
    carrier = Robot(pose=(*place(0, 0), turn), diameter=0.01, sensors=sensors)
    small = [Robot(diameter=0.01).at(*point) for point in others]
    world = World(Scenario(robots=[carrier, *small], addons=[addon], workspace=None))
    world.step()
    for name, values in world.record.sensors.items():
        yield name, float(values.ravel()[-2 if name == "range_bearing" else 0])


@each_case("reach", [0.3, 1.0, 3.0])
@each_case("turn", TURNS)
def test_all_sensors_see_what_is_exactly_at_their_range_and_nothing_beyond(reach, turn):
    rays = RangeFinder(beams=1, range=reach), LineCamera(pixels=1, range=reach)
    whole, part = Proximity(range=reach, name="whole"), Proximity(range=reach, field_of_view=1.0)
    flat = [*rays, SonarRing(sonars=1, range=reach), whole, part]
    for distance, far in ((reach, False), (reach / 10 * 3 / 0.3, False), (reach * BEYOND, True)):
        point, (c, s) = place(distance, turn), (cos(turn), sin(turn))
        wall = [(point[0] - k * s, point[1] + k * c) for k in (-2, 2)]
        seen = [
            *readings(turn, flat, Map(walls=[wall])),
            *readings(turn, [Lookout(range=reach)], Beacon(point)),
            *readings(turn, [RangeBearing(range=reach)], Beacon(point), [point]),
        ]
        for name, value in seen:
            assert (isfinite(value) and value > 0) is not far, name
            assert far or value <= max(reach, 1), name  # colours and flags are up to 1
        pairs = Within(reach).of(np.transpose([place(0, 0), point]))
        assert len(pairs[0]) == (not far)


@each_case("view", [0.2, 2.5])
@each_case("turn", TURNS)
@each_case("side", [-1, 1])
def test_all_sensors_see_what_is_exactly_at_the_edge_of_their_view_and_nothing_beyond(
    view, turn, side
):
    for factor in (1, BEYOND):
        edge = turn + side * factor * view / 2
        point = place(1.0, edge)
        wall = [point, place(1.5, edge + side * 0.5)]  # its end is the nearest
        flat = [SonarRing(sonars=1, cone=view), Proximity(range=2, field_of_view=view)]
        seen = [
            *readings(turn, flat, Map(walls=[wall])),
            *readings(turn, [Lookout(field_of_view=view)], Beacon(point)),
            *readings(turn, [RangeBearing(field_of_view=view)], Beacon(point), [point]),
        ]
        for name, value in seen:
            assert (isfinite(value) and value > 0) is (factor == 1), name
