"""Range finder, sonars, bumper and line camera: what they read, and how they are drawn."""

from __future__ import annotations

from math import cos, inf, pi, sin

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import mars2d
from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Box
from mars2d.core.scene import Scene
from mars2d.geometry.shapes import Polygon as PolygonShape
from mars2d.sensors import Bumper, LineCamera, Proximity, RangeFinder, Sensor, SonarRing
from tests.cases import each_case
from tests.worlds import observed, reading


def drawn(sensor: Sensor, value, pose=(0.0, 0.0, 0.0)) -> list:
    scene = Scene()
    sensor.draw(scene, np.array(pose), value, "#0072b2")
    return scene.shapes


# -- how beams lie --------------------------------------------------------------------------------


@each_case(
    ("make", "count"),
    [
        (lambda n, view: RangeFinder(beams=n, field_of_view=view), 5),
        (lambda n, view: SonarRing(sonars=n, field_of_view=view), 5),
        (lambda n, view: LineCamera(pixels=n, field_of_view=view), 5),
    ],
)
def test_beams_are_spaced_evenly_over_the_field_of_view(make, count):
    assert make(count, 2.0).angles == pytest.approx([-1, -0.5, 0, 0.5, 1])
    assert make(4, 2 * pi).angles == pytest.approx([-pi, -pi / 2, 0, pi / 2])  # pi is -pi
    assert make(1, 2.0).angles.tolist() == [0.0]
    assert make(2, 2.0).angles.tolist() == [-1.0, 1.0]
    with pytest.raises(ValueError, match="read-only"):
        make(count, 2.0).angles[0] = 1.0


# -- range finder ---------------------------------------------------------------------------------


def test_a_range_finder_measures_along_each_beam_from_right_to_left():
    room = [[(-2, -1), (3, -1)], [(3, -1), (3, 4)], [(3, 4), (-2, 4)], [(-2, 4), (-2, -1)]]
    found = reading(RangeFinder(beams=4, range=10), outlines=room)
    assert found == pytest.approx([2, 1, 3, 4])  # behind, right, ahead, left
    turned = reading(RangeFinder(beams=4, range=10), outlines=room, pose=(0, 0, pi / 2))
    assert turned == pytest.approx([1, 3, 4, 2])


# -- sonars ---------------------------------------------------------------------------------------


@pytest.mark.slow
@given(seed=st.integers(0, 2**32 - 1), cone=st.floats(0.05, 6.2), sonars=st.integers(1, 6))
@settings(max_examples=20)
def test_a_sonar_hears_the_nearest_point_in_its_cone(seed, cone, sonars):
    rng = np.random.default_rng(seed)
    cells = [(-2, 0), (2, 0), (0, 2), (0, -2)]
    triangle = PolygonShape([(-0.4, -0.3), (0.5, 0), (-0.4, 0.3)])
    robots = [
        Robot(pose=(*cells[0], rng.uniform(-3, 3)), diameter=rng.uniform(0.1, 1.5)),
        Robot(pose=(*cells[1], rng.uniform(-3, 3)), shape=triangle),
    ]
    ends = rng.uniform(-0.9, 0.9, (2, 2, 2)) + np.array(cells[2:])[:, None]
    walls = [[tuple(end) for end in wall] for wall in ends.tolist()]
    sensor = SonarRing(sonars=sonars, cone=cone, range=rng.uniform(1, 3), field_of_view=2 * pi)
    world = observed(sensor, robots, walls, pose=(*rng.uniform(-0.4, 0.4, 2), rng.uniform(-3, 3)))
    x, y, theta = world.pose[:, 0].tolist()
    things = [shapely.Point(cells[0]).buffer(robots[0].radius, quad_segs=500)]
    heading = robots[1].pose[2]
    corners = np.array(triangle.outline) @ [
        [cos(heading), sin(heading)],
        [-sin(heading), cos(heading)],
    ]
    things += [shapely.Polygon(corners + cells[1]), *map(shapely.LineString, walls)]

    def nearest(axis, angle):
        """The distance in a cone, which is cut out of the things."""
        rim = axis + np.linspace(-angle / 2, angle / 2, 2000)
        far = np.column_stack([x + 9 * np.cos(rim), y + 9 * np.sin(rim)])
        seen = shapely.intersection(shapely.Polygon([(x, y), *far]), things)
        found = shapely.distance(shapely.Point(x, y), seen)
        return np.nanmin(found, initial=inf)

    found = world.robots[0].sense.sonar_ring.tolist()
    for axis, distance in zip((theta + sensor.angles).tolist(), found, strict=True):
        least, most = nearest(axis, cone + 1e-3) - 1e-3, nearest(axis, cone - 1e-3) + 1e-3
        if least > sensor.range:
            assert distance == inf
        elif most < sensor.range:
            assert least <= distance <= most


def test_a_sonar_measures_obliquely_to_a_wall_at_the_edge_of_its_cone():
    wall = [[(-5, 1), (5, 1)]]
    sensor = SonarRing(sonars=4, cone=0.4, range=10)
    found = reading(sensor, outlines=wall, pose=(0, 0, 0.5))
    left, ahead = pi / 2 - (0.5 + pi / 2 - 0.2), pi / 2 - (0.5 + 0.2)
    assert found[3] == pytest.approx(1 / cos(left), abs=1e-9)
    assert found[2] == pytest.approx(1 / cos(ahead), abs=1e-9)
    assert found[1] == inf


@each_case("where", [(1.0, 0.0), (1.1, 0.05), (0.85, 0.0)])
def test_a_sonar_inside_or_at_the_edge_of_another_body_reads_zero(where):
    box = PolygonShape([(-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15)])
    sensor = SonarRing(sonars=3, mount=(*where, 0))
    found = reading(sensor, [Robot(pose=(1, 0, 0), shape=box)])
    assert found == pytest.approx([0, 0, 0], abs=1e-9)


# -- bumper ---------------------------------------------------------------------------------------


def bumps(direction: float, heading: float = 0.0, steps: int = 30, **fields):
    """Readings of a robot that drives at a heading, against a wall in some direction."""
    ahead = np.array([cos(direction), sin(direction)])
    left = np.array([-ahead[1], ahead[0]])
    wall = [tuple((0.4 * ahead + side * left).tolist()) for side in (-2, 2)]
    robot = Robot(pose=(0, 0, heading), drive=mars2d.Holonomic(), sensors=[Bumper(**fields)])
    scenario = Scenario(robots=[robot], addons=[Map([wall])], workspace=None, stop_time=99)
    world = World(scenario)
    for _ in range(steps):
        world.step(0.2 * ahead[:, None])
    world.observe()
    return world


@each_case("heading", [0.0, 0.7, -2.0, 40.0])
@each_case(
    ("bearing", "sector"), [(pi, 0), (-2.5, 0), (2.5, 0), (-1.5, 1), (0.0, 2), (0.7, 2), (1.2, 3)]
)
def test_a_bumper_tells_on_which_side_the_robot_is_touched(heading, bearing, sector):
    world = bumps(heading + bearing, heading)
    column = world.record.sensors["bumper"][:, 0]
    touched = column.any(axis=1)
    assert not touched[:10].any()
    assert touched[20:].all()
    assert np.array_equal(column[touched], np.tile(np.arange(4) == sector, (touched.sum(), 1)))


def test_a_bumper_over_the_front_does_not_feel_the_back():
    front = {"sectors": 2, "field_of_view": pi}
    assert bumps(0.3, **front).record.sensors["bumper"][-1, 0].tolist() == [False, True]
    assert bumps(-0.3, **front).record.sensors["bumper"][-1, 0].tolist() == [True, False]
    assert not bumps(pi, **front).record.sensors["bumper"].any()


class Touched:
    """A robot that turns by half a radian in a control step, and is touched within it."""

    def __init__(self, point, time=1.0):
        self.pose = np.zeros(3)
        kind = [("time", float), ("point", float, 2)]
        self.contacts = np.array([(time, point)], dtype=kind)

    def felt(self, **fields):
        class Now:
            time, sampling_time = 1.0, 0.1

        bumper = Bumper(**fields).live()
        bumper.on_start(self, Now, None)
        self.pose = np.array([0.0, 0.0, 0.5])
        bumper.on_step(self, Now, None)
        return bumper.read(self, Now, None).tolist()


@each_case(("bearing", "sector"), [(1.0, 1), (-1.0, 0)])
def test_a_bumper_feels_a_touch_at_the_very_end_of_its_field_of_view(bearing, sector):
    for factor, felt in ((1, True), (1 + 5e-10, True), (1 + 1e-6, False)):  # the second: rounding
        touched = Touched([cos(factor * bearing + 0.5), sin(factor * bearing + 0.5)])
        expected = [felt and k == sector for k in range(2)]
        assert touched.felt(sectors=2, field_of_view=2.0) == expected


@each_case("share", [0.1, 0.5, 0.9])
def test_a_bumper_feels_a_touch_where_the_robot_was_then(share):
    for bearing, sector in ((0.01, 1), (-0.01, 0)):
        angle = 0.5 * share + bearing
        touched = Touched([cos(angle), sin(angle)], time=0.9 + 0.1 * share)
        assert touched.felt(sectors=2, field_of_view=1.0) == [k == sector for k in range(2)]


def test_a_slow_bumper_keeps_what_it_felt_until_it_is_read():
    def law(robot):
        return (0.5, 0.0) if robot.time < 0.55 else (-0.5, 0.0)

    robots = [Robot(sensors=[Bumper(), Bumper(rate=1, name="slow")], controller=law)]
    wall = Map([[(0.4, -1), (0.4, 1)]])
    record = mars2d.run(Scenario(robots=robots, addons=[wall], workspace=None, stop_time=3))
    felt = record.sensors["bumper"].any(axis=(1, 2))
    slow = record.sensors["slow"].any(axis=(1, 2))
    assert felt[:10].any()
    assert not felt[10]
    assert slow.tolist() == [False] * 10 + [True] * 10 + [False] * 11


# -- line camera ----------------------------------------------------------------------------------


def test_a_line_camera_sees_the_colours_of_robots_props_and_obstacles():
    robots = [Robot(pose=(2, -1, 0), color="#ff0000", diameter=0.5)]
    camera = LineCamera(pixels=3, field_of_view=2 * np.arctan(0.5))
    seen = reading(
        camera, robots, [[(2, 0.5), (2, 1.5)]],
        props=[Box(pose=(2, 0, 0), length=0.3, width=0.3, color="#0000ff")],
    )  # fmt: skip
    assert seen[0].tolist() == [1, 0, 0]
    assert seen[1].tolist() == [0, 0, 1]
    grey = int("b8", 16) / 255, int("c0", 16) / 255, int("c8", 16) / 255
    assert seen[2].tolist() == pytest.approx(grey)


# -- all of them ----------------------------------------------------------------------------------


EVERY = [Proximity(range=1), RangeFinder(), SonarRing(), Bumper(), LineCamera()]


@each_case("sensor", EVERY)
def test_drawing_is_light_and_follows_the_mount(sensor):
    value = reading(sensor, [Robot(pose=(0.8, 0, 0))])
    assert len(drawn(sensor, value)) < 20
    here = drawn(sensor.replace(mount=(1, 2, 0.3)), value)
    there = drawn(sensor, value, (1, 2, 0.3))
    for a, b in zip(here, there, strict=True):
        points = [shape.points if hasattr(shape, "points") else shape.center for shape in (a, b)]
        assert np.allclose(*points)


@each_case("sensor", EVERY)
def test_what_was_lost_can_be_drawn(sensor):
    value = reading(sensor.replace(dropouts=1.0))
    assert len(drawn(sensor, value)) < 20
