"""Range and bearing: of other robots, and of beacons that stand or move."""

from __future__ import annotations

from math import atan2, hypot, inf, isnan, nan, pi

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, World, addons, sensors
from mars2d.bodies.props import Box
from mars2d.core.arithmetic import angle_of, norm
from mars2d.core.plane import wrap
from mars2d.geometry.bearings import sighted
from mars2d.sensors import RangeBearing
from tests.cases import each_case
from tests.worlds import observed


def world_of(sensor, others=(), outlines=(), **more):
    """A world whose robot 0 carries the sensor, after the first measurement."""
    return observed(sensor, [Robot(pose=at, diameter=0.2) for at in others], outlines, **more)


def seen(sensor, others=(), outlines=(), **more):
    """What robot 0 finds of its sensor."""
    return getattr(world_of(sensor, others, outlines, **more).robots[0].sense, sensor.key)


def rows(sensor, others=(), outlines=(), **more):
    """What is recorded of robot 0's sensor, (k, 2)."""
    world = world_of(sensor, others, outlines, **more)
    world.step()
    return world.record.sensors[sensor.key][0, 0]


# -- geometry ----------------------------------------------------------------------------------


def all_sighted(pose, points, reach, field_of_view):
    """Range and bearing of each point by themselves, as `sighted` says: no point is left out."""
    x, y, theta = pose
    found = np.full((len(points), 2), (inf, nan))
    for row, (u, v) in zip(found, points, strict=True):
        distance = norm(u - x, v - y)
        bearing = float(wrap(angle_of(v - y, u - x) - theta)) + 0.0
        if distance <= reach and (field_of_view == 2 * pi or abs(bearing) <= field_of_view / 2):
            row[:] = distance, bearing
    return found


@each_case("field_of_view", [2 * pi, 2.0])
@each_case("reach", [0.3, 2.0, 1e6])
def test_what_is_sighted_is_the_same_to_the_last_bit_however_many_are_far_off(reach, field_of_view):
    rng = np.random.default_rng(4)
    points = np.vstack([rng.uniform(-5, 5, (200, 2)), np.round(rng.uniform(-3, 3, (100, 2)), 1)])
    poses = ((0.0, 0.0, 0.0), (0.1, -0.2, 2.5), (1e5, 0.3, -7.0), (points[3, 0], 2.0, 0.0))
    found = sighted(np.transpose(poses), points, reach, field_of_view)
    for rows, pose in zip(found, poses, strict=True):
        assert rows.tobytes() == all_sighted(pose, points, reach, field_of_view).tobytes()


# -- other robots ---------------------------------------------------------------------------


def test_range_and_bearing_are_those_of_plane_geometry():
    rng = np.random.default_rng(1)
    places = rng.uniform(-4, 4, (30, 3))
    places = places[np.hypot(places[:, 0] - 0.3, places[:, 1] + 0.2) > 0.3]
    sensor = RangeBearing(range=20, through_walls=True)
    for heading in (0.0, 2.5, -7.0):
        pose = (0.3, -0.2, heading)
        for i, place in enumerate(places):
            ((distance, bearing, robot),) = seen(sensor, [tuple(place)], pose=pose)
            x, y = place[0] - 0.3, place[1] + 0.2
            assert robot == 1, i
            assert distance == pytest.approx(hypot(x, y), abs=1e-12)
            assert bearing == pytest.approx(float(wrap(atan2(y, x) - heading)), abs=1e-12)


def test_the_nearest_comes_first_and_each_has_its_index():
    found = seen(RangeBearing(), [(3, 0, 0), (0, 1, 0), (-2, 0, 0)])
    assert [each.robot for each in found] == [2, 3, 1]
    assert [each.range for each in found] == [1, 2, 3]
    assert [each.bearing for each in found] == pytest.approx([pi / 2, pi, 0])


def test_with_identity_row_i_is_robot_i_and_its_own_is_missing():
    found = rows(RangeBearing(), [(9, 0, 0), (0, 1, 0)])
    assert np.array_equal(found, [[inf, nan], [inf, nan], [1, pi / 2]], equal_nan=True)


def test_without_identity_rows_are_nearest_first_and_nobody_has_an_index():
    sensor = RangeBearing(identity=False)
    others = [(3, 0, 0), (0, 1, 0), (9, 0, 0)]
    expected = [[1, pi / 2], [3, 0], [inf, nan]]
    assert np.array_equal(rows(sensor, others), expected, equal_nan=True)
    assert seen(sensor, others) == ((1, pi / 2, None), (3, 0, None))


def test_the_mount_is_where_it_looks_from():
    sensor = RangeBearing(mount=(0.5, 0.1, pi / 2))
    ((distance, bearing, _),) = seen(sensor, [(1, 3, 0)], pose=(1, 1, pi / 2))
    # The mount lies at (0.9, 1.5), turned to pi.
    assert distance == pytest.approx(hypot(0.1, 1.5))
    assert bearing == pytest.approx(atan2(1.5, 0.1) - pi)


@each_case(
    ("what", "hides"),
    [
        ({"outlines": [[(1, -1), (1, 1)]]}, True),
        ({"outlines": [[(1, 0.2), (1, 1)]]}, False),
        ({"outlines": [[(0.8, -0.3), (1.2, -0.3), (1.2, 0.3), (0.8, 0.3)]]}, True),
        ({"others": [(1, 0.09, 0)]}, True),
        ({"others": [(1, 0.11, 0)]}, False),
        ({"props": [Box(pose=(1, 0, 0.3))]}, True),
    ],
)
def test_what_stands_before_a_robot_hides_it(what, hides):
    others = [(2, 0, 0), *what.pop("others", [])]
    for through in (False, True):
        found = seen(RangeBearing(through_walls=through), others, **what)
        assert (1 in [each.robot for each in found]) is (through or not hides)


def test_outliers_strike_only_what_is_seen_and_both_values_are_there_or_none():
    sensor = RangeBearing(range=3, outliers=0.5, dropouts=0.2, noise=(0.3, 0.1))
    robots = [Robot(sensors=[sensor]), Robot(pose=(2.9, 0, 0)), Robot(pose=(0, 4, 0))]
    found = mars2d.run(Scenario(robots=robots, stop_time=50)).sensors["range_bearing"][:, 0]
    there = np.isfinite(found)
    assert (there[..., 0] == there[..., 1]).all()
    assert not there[:, [0, 2]].any()
    assert 0.2 < there[:, 1, 0].mean() < 0.8
    assert (found[there[:, 1, 0], 1, 0] <= 3).all()


# -- beacons ---------------------------------------------------------------------------------


LAMPS = (addons.Beacon(at=(2, 0), name="lamp"), addons.Beacon(at=(0, -1), name="door"))


def test_a_law_finds_beacons_by_name():
    found = seen(sensors.Beacon(), extra=LAMPS)
    assert found["lamp"][:2] == (2, 0)
    assert found["door"][:2] == pytest.approx((1, -pi / 2))
    assert list(found) == ["door", "lamp"]
    assert ("lamp" in found, "lampe" in found, len(found)) == (True, False, 2)
    assert found.get("lamp") == found["lamp"]


def test_a_beacon_that_is_not_seen_is_infinitely_far_and_has_no_bearing():
    found = seen(sensors.Beacon(range=1.5), extra=LAMPS)
    assert found["lamp"].range == inf
    assert isnan(found["lamp"].bearing)
    assert found["door"].range == 1


def test_rows_are_in_the_order_of_the_names_or_of_the_alphabet():
    assert rows(sensors.Beacon(), extra=LAMPS)[:, 0].tolist() == [1, 2]
    both = sensors.Beacon(names=["lamp", "door"])
    assert rows(both, extra=LAMPS)[:, 0].tolist() == [2, 1]
    assert rows(sensors.Beacon(names=["lamp"]), extra=LAMPS).tolist() == [[2, 0]]


def test_a_name_that_no_beacon_has_is_an_error_that_knows_the_nearest():
    def law(robot):
        robot.sense.beacon["lapm"]
        return 0, 0

    robot = Robot(sensors=[sensors.Beacon()], controller=law)
    with pytest.raises(LawError, match=r"no beacon 'lapm'; did you mean 'lamp'\?") as raised:
        mars2d.run(Scenario(robots=[robot], addons=LAMPS))
    assert "test_sensors_bearing.py, line" in str(raised.value)
    with pytest.raises(LawError, match="no beacon 'x'; known: door, lamp"):
        seen(sensors.Beacon(), extra=LAMPS)["x"]


def test_a_world_without_beacons_is_an_error_at_the_start():
    with pytest.raises(InputError, match="carrier looks for beacons and there are none: add") as no:
        world_of(sensors.Beacon())
    with pytest.raises(
        InputError, match=r"Beacon.names of carrier.*'lam'; did you mean 'lamp'"
    ) as a:
        world_of(sensors.Beacon(names=["lam"]), extra=LAMPS)
    assert not isinstance(no.value, LawError)  # it is no law's fault
    assert not isinstance(a.value, LawError)


@each_case("place", [3, (1, 2, 3), ("a", "b"), None, "12", (nan, 0), (0, inf)])
def test_beacons_of_an_own_addon_must_be_points(place):
    class Stars(mars2d.Addon):
        def beacons(self):
            return {"sun": place}

    with pytest.raises(LawError, match=r"add-on 'stars' .* beacon 'sun' = .*: expected a point"):
        seen(sensors.Beacon(), extra=[Stars()])


def test_walls_robots_and_props_hide_a_beacon_but_not_its_own_robot():
    def sees(**what):
        return seen(sensors.Beacon(), extra=LAMPS, **what)["lamp"].range < inf

    assert sees()
    assert not sees(outlines=[[(1, -1), (1, 1)]])
    assert not sees(others=[(1, 0, 0)])
    assert not sees(props=[Box(pose=(1, 0, 0))])
    assert sees(pose=(1.95, 0, 0))  # the robot stands over the lamp
    through = seen(sensors.Beacon(through_walls=True), outlines=[[(1, -1), (1, 1)]], extra=LAMPS)
    assert through["lamp"][:2] == (2, 0)


def test_a_beacon_on_a_wall_is_seen_from_its_side_and_one_within_an_obstacle_is_not():
    block = [[(2, -1), (3, -1), (3, 1), (2, 1)]]
    lamps = [
        addons.Beacon(at=(2, 0), name="front"),
        addons.Beacon(at=(3, 0), name="back"),
        addons.Beacon(at=(2.5, 0), name="within"),
    ]
    found = seen(sensors.Beacon(), outlines=block, extra=lamps)
    assert found["front"].range == 2
    assert found["back"].range == found["within"].range == inf
    assert seen(sensors.Beacon(), outlines=block, extra=lamps, pose=(5, 0, 0))["back"].range == 2
    wall = [[(2, -1), (2, 1)]]
    for x in (0, 4):
        assert (
            seen(sensors.Beacon(), outlines=wall, extra=lamps[:1], pose=(x, 0, 0))["front"][0] == 2
        )


# -- the beacons themselves -----------------------------------------------------------------


def test_a_beacon_moves_along_its_path_by_arc_length():
    beacon = addons.Beacon(path=[(0, 0), (3, 0), (3, 4)], speed=2.0)  # 3 + 4 + 5 = 12 m
    assert beacon.where(0) == (0, 0)
    assert beacon.where(1.5) == (3, 0)
    assert beacon.where(2.5) == (3, 2)
    assert beacon.where(4.75) == pytest.approx((1.5, 2))
    assert beacon.where(6) == (0, 0)
    assert beacon.where(6000 + 2.5) == pytest.approx((3, 2))
    there_and_back = addons.Beacon(path=[(0, 0), (2, 0)], speed=1.0)
    assert [there_and_back.where(t)[0] for t in (0, 1, 2, 3, 4)] == [0, 1, 2, 1, 0]


def test_a_beacon_on_an_open_path_goes_along_it_once_and_stays_at_its_end():
    beacon = addons.Beacon(path=[(0, 0), (3, 0), (3, 4)], speed=2.0, closed=False)  # 3.5 s
    assert beacon.where(1.5) == (3, 0)
    assert beacon.where(2.5) == (3, 2)
    assert beacon.where(3.5) == beacon.where(3.75) == beacon.where(7.0) == (3, 4)
    lap = addons.Beacon(path=[(0, 0), (1, 0), (1, 1), (0, 0)], speed=1.0, closed=False)
    assert lap.where(2.0) == (1, 1)
    assert lap.where(100.0) == (0, 0)


def test_the_world_knows_where_a_moving_beacon_is_now():
    beacon = addons.Beacon(path=[(1, 0), (2, 0)], speed=0.5)
    robot = Robot(sensors=[sensors.Beacon()])
    world = World(Scenario(robots=[robot], addons=[beacon]))
    assert world.surroundings.beacons == {"beacon": (1, 0)}
    for _ in range(10):
        world.step()
    assert world.surroundings.beacons["beacon"] == pytest.approx((1.5, 0))
    assert world.addons.beacon.position == pytest.approx((1.5, 0))
    expected = 1 + 0.5 * world.record.time
    assert world.record.sensors["beacon"][:, 0, 0, 0] == pytest.approx(expected)
    assert beacon.position == (1, 0)


@each_case(
    ("fields", "message"),
    [
        ({}, "expected where it stands"),
        ({"at": (0, 0), "speed": 1}, "a `path` needs a `speed`"),
        (
            {"path": [(0, 0)], "speed": 1},
            r"Beacon.path = .*: expected .*, at least 2 different ones",
        ),
        ({"at": (0, nan)}, r"Beacon.at = .*: expected a point"),
        ({"path": [(0, 0), (1, 0)], "speed": 0}, r"Beacon.speed = 0: expected a number > 0"),
    ],
)
def test_a_beacon_that_can_not_be_is_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        addons.Beacon(**fields)
