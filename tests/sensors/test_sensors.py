"""Sensors: proximity against plain geometry, and what a sensor of one's own may do."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.sensors import Proximity, Sensor
from tests.cases import each_case
from tests.worlds import reading

# -- proximity ------------------------------------------------------------------------------


def sector(pose, radius: float, angle: float) -> shapely.Polygon:
    """The field of view as a polygon of many corners, a hair smaller than the true one."""
    x, y, theta = pose
    angles = theta + np.linspace(-angle / 2, angle / 2, 4000)
    rim = np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])
    if angle >= 2 * np.pi:
        return shapely.Polygon(rim[:-1])
    return shapely.Polygon([(x, y), *rim])


places = st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))


@settings(max_examples=15)
@given(
    discs=st.lists(st.tuples(places, st.floats(0.02, 0.8)), max_size=3),
    walls=st.lists(st.tuples(places, places), max_size=3),
    heading=st.floats(-4, 4),
    radius=st.floats(0.1, 2),
    angle=st.one_of(st.just(2 * np.pi), st.floats(0.1, 6.2)),
)
def test_proximity_says_whether_a_surface_lies_in_the_sector(discs, walls, heading, radius, angle):
    pose = (0.1, -0.2, heading)
    here = shapely.Point(pose[:2])
    robots = [Robot(pose=(*place, 0), diameter=size) for place, size in discs]
    things = [shapely.Point(place).buffer(size / 2, quad_segs=500) for place, size in discs]
    assume(all(np.hypot(a[0] - b[0], a[1] - b[1]) > 1e-2 for a, b in walls))
    things += [shapely.LineString(ends) for ends in walls]
    assume(all(thing.distance(here) > 0.01 for thing in things))
    try:
        found = reading(Proximity(range=radius, field_of_view=angle), robots, walls, pose=pose)
    except InputError:
        assume(False)  # the others start inside each other
    view = sector(pose, radius, angle)
    expected = any(view.intersects(thing) for thing in things)
    surely_not = all(view.distance(thing) > 1e-3 for thing in things)
    surely = any(view.buffer(-1e-3).intersects(thing) for thing in things)
    assume(surely or surely_not)  # leave out what lies within a millimetre of the edge
    assert found is expected


@each_case("angle", [2 * np.pi, np.pi, 0.5])
def test_proximity_never_sees_its_own_robot(angle):
    for offset in (0.0, 0.4):
        sensor = Proximity(range=5, field_of_view=angle)
        robot = Robot(diameter=1.0, center_offset=offset, sensors=[sensor])
        world = World(Scenario(robots=[robot]))
        world.observe()
        assert world.robots[0].sense.proximity is False


def test_the_walls_of_the_workspace_are_seen_where_they_are_walls():
    found = {}
    for on_exit in ("wall", "stop"):
        robot = Robot(pose=(4.5, 0, 0), sensors=[Proximity(range=0.6)])
        world = World(Scenario(robots=[robot], on_exit=on_exit))
        world.observe()
        found[on_exit] = world.robots[0].sense.proximity
    assert found == {"wall": True, "stop": False}


def test_robots_that_have_moved_are_seen_where_they_are_now():
    robots = [Robot(sensors=[Proximity(range=0.5)]), Robot(pose=(1, 0, np.pi))]
    world = World(Scenario(robots=robots, stop_time=2))
    for _ in range(15):
        world.step([[0, 0.3], [0, 0]])
    seen = world.record.sensors["proximity"][:, 0]
    gap = world.record.pose[:, 0, 1] - 0.15
    assert seen.tolist() == (gap < 0.5).tolist()
    assert seen.any()
    assert not seen.all()


# -- sensors of one's own -------------------------------------------------------------------


class Compass(Sensor):
    """The sensor of the documentation."""

    error: float = 0.1

    def read(self, robot, world, rng):
        return robot.pose[2] + rng.normal(0, self.error)


def test_an_own_sensor_is_a_short_class_and_is_found_under_its_name():
    robots = [Robot(pose=(0, 0, 1), sensors=[Compass(error=0), Compass(error=0, name="spare")])]
    record = mars2d.run(Scenario(robots=robots, stop_time=0.2))
    assert record.sensors["compass"].tolist() == [[1], [1], [1]]
    assert record.sensors["spare"].tolist() == [[1], [1], [1]]


@each_case(
    ("value", "shape"),
    [(1.5, (3, 1)), (True, (3, 1)), (np.float32(2), (3, 1)), ([1, 2], (3, 1, 2)),
     (np.zeros((4, 2)), (3, 1, 4, 2)), (np.bool_(True), (3, 1)), (float("nan"), (3, 1))],
)  # fmt: skip
def test_a_reading_is_a_number_a_truth_value_or_an_array(value, shape):
    class Probe(Sensor):
        def read(self, robot, world, rng):
            return value

    record = mars2d.run(Scenario(robots=[Robot(sensors=[Probe()])], stop_time=0.2))
    column = record.sensors["probe"]
    assert column.shape == shape
    assert column.dtype == (bool if isinstance(value, (bool, np.bool_)) else float)
    assert np.array_equal(column[-1, 0], np.asarray(value), equal_nan=True)


@each_case(
    ("first", "second"),
    [
        (np.zeros(3), np.zeros(4)),
        (np.zeros(3), np.zeros(1)),
        (False, 0.7),
        (1.0, "2"),
        (np.zeros((2, 2)), np.zeros((2, 1))),
    ],
)
def test_the_shape_and_kind_of_a_reading_cannot_change(first, second):
    class Changing(Sensor):
        def read(self, robot, world, rng):
            return first if world.time < 0.15 else second

    scenario = Scenario(robots=[Robot(sensors=[Changing()])])
    with pytest.raises(LawError, match="sensor 'changing' read") as raised:
        mars2d.run(scenario)
    assert raised.value.where == f"test_sensors.py, line {Changing.read.__code__.co_firstlineno}"
    assert len(raised.value.record) == 2


def test_readings_of_one_name_have_one_shape_on_all_robots():
    class Beams(Sensor):
        count: int = 2

        def read(self, robot, world, rng):
            return np.zeros(self.count)

    robots = [Robot(sensors=[Beams()]), Robot(pose=(1, 0, 0), sensors=[Beams(count=3)])]
    with pytest.raises(LawError, match="of the same shape on each robot"):
        mars2d.run(Scenario(robots=robots))
    named = [robots[0], robots[1].replace(sensors=[Beams(count=3, name="wide")])]
    record = mars2d.run(Scenario(robots=named, stop_time=0))
    assert record.sensors["beams"].shape == (1, 1, 2)
    assert record.sensors["wide"].shape == (1, 1, 3)
    assert record.sensor_robots == {"beams": (0,), "wide": (1,)}


def test_rays_and_distances_of_the_world_are_those_of_geometry():
    world = World(
        Scenario(
            robots=[Robot(), Robot(pose=(2, 0, 0), diameter=0.5)], addons=[Map([[(0, 3), (4, 3)]])]
        )
    )
    around = world.surroundings
    assert around.ray((0, 0), 0.0, 5.0, 0) == pytest.approx(1.75)
    assert around.ray((0, 0), 0.0, 1.0, 0) == np.inf
    assert around.ray((1, 0), np.pi / 2, 5.0, 0) == pytest.approx(3)
    assert around.ray((0, 0), 0.0, 5.0, 1) == 0  # seen by robot 1, it starts inside robot 0
    assert around.distance((0, 0), 5.0, 0) == pytest.approx(1.75)
    assert around.distance((0, 0), 1.0, 0) == np.inf
    assert around.distance((0.05, 0), 5.0, 1) == pytest.approx(-0.1)
    points = sorted(around.nearby((0, 0), 9.0, 0))
    assert points == [pytest.approx((0, 3)), pytest.approx((1.75, 0))]
