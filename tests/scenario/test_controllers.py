"""Ready-made laws: what each does, with every drive, and how files name them."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import Car, Differential, Holonomic, InputError, Robot, Scenario, Unicycle
from mars2d.addons import Map, Waypoints
from mars2d.scenario import load_scenario, save_scenario
from mars2d.scenario.controllers import (
    ByHand,
    Controller,
    FollowRobot,
    FollowWall,
    FollowWaypoints,
    Wander,
)
from mars2d.scenario.registry import members
from mars2d.sensors import Proximity, RangeFinder, SonarRing
from tests.cases import each_case

DRIVES = {
    "unicycle": Unicycle(), "wheels": Differential(), "twist": Differential(command="twist"),
    "car": Car(), "holonomic": Holonomic(),
}  # fmt: skip
ROOM = [(0, 0), (8, 0), (8, 6), (0, 6)]


def fitted(law, **fields):
    """Return a robot with a law, and the sensors that it needs."""
    return Robot(controller=law, sensors=law.needs, **fields)


def alone(robot, **fields):
    fields = {"workspace": ROOM, "on_exit": "wall"} | fields
    return mars2d.run(Scenario(robots=[robot], **fields))


# -- along the waypoints -----------------------------------------------------------------------


@each_case("drive", DRIVES.values())
def test_the_waypoint_follower_reaches_all_its_points_in_order_and_stops(drive):
    route = [(3, 1), (6, 4), (1.5, 4), (1, 1)]  # the third lies behind
    robot = Robot(pose=(1, 2, 0), drive=drive, controller=FollowWaypoints(speed=0.4))
    ways = Waypoints([route], tolerance=0.2)
    record = alone(robot, stop_time=80, addons=[ways])
    assert ways.passed(record.pose[:, :2].swapaxes(1, 2)) == (4,)
    assert np.hypot(*(record.pose[-1, :2, 0] - route[-1])) <= 0.2
    assert (record.command[-10:] == 0).all()
    assert record.collisions == 0


def test_before_the_last_waypoint_it_slows_down_by_its_gain():
    law = FollowWaypoints(speed=0.4, gain=0.5)
    record = alone(
        Robot(pose=(1, 3, 0), controller=law), stop_time=20,
        addons=[Waypoints([[(5, 3)]], tolerance=0.01)],
    )  # fmt: skip
    gap, (v, omega) = 5 - record.pose[:, 0, 0], record.command[:, :, 0].T
    np.testing.assert_allclose(v[gap > 0.01], np.minimum(0.5 * gap, 0.4)[gap > 0.01], atol=1e-9)
    assert (omega == 0).all()


def test_without_waypoints_it_stands_still():
    record = alone(Robot(controller=FollowWaypoints(), pose=(1, 1, 0)), stop_time=1)
    assert record.pose[-1].T.tolist() == [[1, 1, 0]]


# -- along walls ---------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("drive", DRIVES.values(), ids=DRIVES)
def test_the_wall_follower_keeps_its_distance_all_round_a_room(drive, side):
    law = FollowWall(distance=0.6, side=side, speed=0.4)
    start = (4, 5.2, np.pi) if side == "right" else (4, 5.2, 0)
    record = alone(fitted(law, pose=start, drive=drive), stop_time=90)
    assert record.collisions == 0
    x, y = record.pose[100:, :2, 0].T
    gap = np.min([x, 8 - x, y, 6 - y], axis=0)
    corner = (np.minimum(x, 8 - x) < 1.5) & (np.minimum(y, 6 - y) < 1.5)
    np.testing.assert_allclose(gap[~corner], 0.6, atol=0.05)
    turned = np.unwrap(np.arctan2(y - 3, x - 4))
    way = turned[-1] - turned[0]
    assert way < -2 * np.pi if side == "left" else way > 2 * np.pi  # all round, the wall beside it


@pytest.mark.slow
def test_along_a_straight_wall_the_error_follows_its_differential_equation():
    law = FollowWall(distance=0.5, speed=0.3, gain=2.0)
    robot = fitted(law, pose=(0, -0.9, 0), drive=Holonomic()).replace(
        sensors=[RangeFinder(beams=720, range=2)]
    )
    record = alone(
        robot, stop_time=20, sampling_time=0.02, workspace=None,
        addons=[Map([[(-5, 0), (20, 0)]])],
    )  # fmt: skip
    error = -record.pose[:, 1, 0] - 0.5
    # e' = -v sin(atan(g e)): with u = g e, the integral of sqrt(1 + u^2) / u is -v g t
    u = 2.0 * error
    whole = np.sqrt(1 + u**2) + np.log(u / (1 + np.sqrt(1 + u**2)))
    straight = error > 0.01
    expected = whole[0] - 0.3 * 2.0 * record.time
    np.testing.assert_allclose(whole[straight], expected[straight], atol=0.05)
    assert error[-1] == pytest.approx(0, abs=0.005)


def test_a_wall_follower_with_sonars_goes_round_an_obstacle():
    law = FollowWall(distance=0.6, side="right", sensor="sonar_ring")
    robot = Robot(pose=(0, -1.5, 0), controller=law, sensors=[SonarRing(sonars=24)])
    block = [(-1, -0.5), (1, -0.5), (1, 0.5), (-1, 0.5)]
    record = alone(robot, stop_time=60, workspace=None, addons=[Map([block])])
    x, y = record.pose[100:, :2, 0].T
    gap = np.hypot(np.maximum(np.abs(x) - 1, 0), np.maximum(np.abs(y) - 0.5, 0))
    np.testing.assert_allclose(gap, 0.6, atol=0.1)
    assert abs(np.unwrap(np.arctan2(y, x))[-1] - np.arctan2(y, x)[0]) > np.pi
    assert record.collisions == 0


# -- after another robot -------------------------------------------------------------------------


@each_case("drive", DRIVES.values())
def test_a_follower_stays_behind_a_straight_leader_as_far_as_its_gain_says(drive):
    lead = Robot(name="lead", pose=(1, 0, 0), controller=lambda robot: (0.2, 0.0))
    law = FollowRobot(leader="lead", distance=0.5, gain=2.0, speed=0.4)
    robots = [lead, Robot(pose=(-1, 0.5, 1), drive=drive, controller=law)]
    record = mars2d.run(Scenario(robots=robots, stop_time=60))
    gap = np.hypot(*(record.pose[-1, :2, 0] - record.pose[-1, :2, 1]))
    assert gap == pytest.approx(0.5 + 0.2 / 2.0, abs=0.01)


def test_without_a_name_it_follows_its_nearest_neighbour_and_waits_when_it_is_there():
    near, far = Robot(pose=(2, 0, 0)), Robot(pose=(0, 5, 0))
    law = FollowRobot(distance=0.8)
    robots = [near, far, Robot(pose=(0, 0, np.pi), controller=law)]
    record = mars2d.run(Scenario(robots=robots, stop_time=30))
    assert np.hypot(*(record.pose[-1, :2, 2] - (2, 0))) == pytest.approx(0.8, abs=0.01)


# -- at random -----------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("drive", DRIVES.values(), ids=DRIVES)
def test_a_wanderer_sees_much_of_a_room_and_never_stays_at_a_wall(drive):
    law = Wander(speed=0.4)
    record = alone(fitted(law, pose=(4, 3, 0.3), drive=drive), stop_time=300)
    x, y, _ = record.pose[:, :, 0].T
    seen = {(int(a), int(b)) for a, b in zip(x, y, strict=True)}
    assert len(seen) > 12  # of 48 square metres
    still = np.hypot(np.ptp(x.reshape(-1)[-300:]), np.ptp(y.reshape(-1)[-300:]))
    assert still > 0.5


def test_wanderers_differ_by_their_random_streams_and_repeat_with_the_seed():
    robots = [fitted(Wander()).at(2, 3), fitted(Wander()).at(6, 3, np.pi)]
    scenario = Scenario(robots=robots, workspace=ROOM, on_exit="wall", stop_time=20)
    one, same, other = (mars2d.run(scenario, seed=seed) for seed in (1, 1, 2))
    assert one.digest == same.digest != other.digest


# -- what they want ------------------------------------------------------------------------------


@each_case(
    ("law", "sensors", "want"),
    [
        (Wander(), [], "a sensor called proximity"),
        (Wander(), [Proximity(range=1)], ""),
        (FollowWall(), [], "a sensor called range_finder"),
        (FollowWall(), [RangeFinder(field_of_view=2)],
         "a scanner with the field of view of its law"),
        (FollowWall(), [RangeFinder()], ""),
        (FollowWall(sensor="proximity"), [Proximity(range=1)],
         "a scanner with the field of view of its law"),
        (FollowWaypoints(), [], "a waypoint"),
        (FollowRobot(), [], ""),
        (FollowRobot(leader="ghost"), [], "a robot called ghost"),
        (FollowRobot(leader="robot0"), [], "a robot called robot0"),
        (ByHand(), [], ""),
    ],
)  # fmt: skip
def test_a_law_says_what_its_robot_lacks(law, sensors, want):
    scenario = Scenario(robots=[Robot(controller=law, sensors=sensors), Robot(pose=(1, 0, 0))])
    assert law.want(scenario, 0) == want


# -- in files ------------------------------------------------------------------------------------


def _all_laws():
    laws = [FollowWaypoints(speed=0.2), FollowRobot(leader="robot0"), FollowWall(side="right")]
    laws += [Wander(turn=2.0), ByHand()]
    assert {type(law).__name__ for law in laws} == {*members("controllers")}
    robots = [fitted(law, pose=(i + 1, 1, 0)) for i, law in enumerate(laws)]
    return Scenario(
        robots=robots, workspace=ROOM, on_exit="wall", stop_time=5,
        addons=[Waypoints([[(2, 4)]])],
    )  # fmt: skip


def test_scenario_files_and_records_keep_all_ready_made_laws(tmp_path):
    scenario = _all_laws()
    assert save_scenario(scenario, tmp_path / "laws.toml") == ()
    assert load_scenario(tmp_path / "laws.toml") == scenario
    runs = [mars2d.run(source) for source in (scenario, tmp_path / "laws.toml")]
    assert len({run.digest for run in runs}) == 1
    runs[0].save(tmp_path / "run.npz")
    assert mars2d.load(tmp_path / "run.npz").scenario == scenario


@each_case(
    ("written", "said"),
    [
        ('"Wonder"', r"laws.toml, line 3, robots\[0\]: .*did you mean 'Wander'"),
        ('{ type = "Wonder" }', "did you mean 'Wander'"),
        ('{ type = "Wander", speed = -1 }', "Wander.speed = -1: expected a number > 0"),
    ],
)
def test_a_wrong_law_in_a_file_is_said_with_its_place(written, said, tmp_path):
    path = tmp_path / "laws.toml"
    path.write_text(f"format = 1\n[[robots]]\ncontroller = {written}\n")
    with pytest.raises(InputError, match=said):
        load_scenario(path)


def test_a_law_of_ones_own_may_derive_from_controller_and_is_named_as_code(tmp_path):
    class Ahead(Controller):
        share: float = 0.5

        def __call__(self, robot):
            return robot.drive.steered(0.0, self.share)

    scenario = Scenario(robots=[Robot(controller=Ahead())], stop_time=1)
    record = mars2d.run(scenario)
    assert record.pose[-1, 0, 0] == pytest.approx(0.25)
    assert save_scenario(scenario, tmp_path / "own.toml") == ("law Ahead",)
    kept = (tmp_path / "own.toml").read_text()
    assert "which is not written down: law Ahead" in kept
    record.save(tmp_path / "own.npz")
    assert mars2d.load(tmp_path / "own.npz").scenario.robots[0].controller is None
