"""The add-on Estimate: what a robot believes of its pose, and how unsure it is."""

import numpy as np
import pytest

from mars2d import Holonomic, InputError, Robot, Scenario, Unicycle, World
from mars2d.addons import Estimate
from mars2d.addons.estimate import ellipse
from mars2d.core.scene import Scene
from mars2d.geometry.dead_reckoning import covariances
from mars2d.sensors import Odometry
from tests.cases import each_case

DRIFT, AXLE = 0.002, 0.1


def driven(robots, addon, command=(0.5, 0.0), seconds=10.0):
    """A world in which all robots have driven, with the add-on in it."""
    world = World(
        Scenario(robots=robots, addons=[addon], workspace=None, stop_time=seconds, physics="ideal")
    )
    while not world.over:
        world.step(np.outer(command, np.ones(len(robots))))
    return world


def drawn(world):
    scene = Scene()
    world.addons.estimate.on_draw(world, scene)
    return scene.shapes


def runner(name=None, drift=DRIFT, origin="world", pose=(0, 0, 0)):
    sensors = [Odometry(drift=drift, origin=origin)]
    return Robot(name=name, pose=pose, drive=Unicycle(wheel_semiaxis=AXLE), sensors=sensors)


# -- the covariance -----------------------------------------------------------------------------


def test_a_straight_way_makes_one_unsure_of_the_heading_first():
    way = np.linspace(0, 4, 401)
    path = np.column_stack([way, 0 * way, 0 * way])
    spread = covariances(path, AXLE, DRIFT)[-1]
    assert spread[0, 0] == pytest.approx(DRIFT**2 * 4 / 2, rel=1e-9)
    assert spread[2, 2] == pytest.approx(DRIFT**2 * 4 / (2 * AXLE**2), rel=1e-9)
    assert spread[1, 1] == pytest.approx(DRIFT**2 * 4**3 / (6 * AXLE**2), rel=1e-2)


@pytest.mark.slow
def test_the_covariance_is_that_of_many_robots():
    """A curve, driven 300 times: the sample's covariance is the predicted one."""
    robots = [runner(pose=(3.0 * k, 0, 0.3), drift=0.004) for k in range(300)]
    world = driven(robots, Estimate(), command=(0.4, 0.3), seconds=15.0)
    error = world.record.sensors["odometry"][-1] - world.pose.T
    expected = world.addons.estimate.covariance
    ratio = np.linalg.solve(expected, np.cov(error.T))
    assert np.linalg.eigvals(ratio).real == pytest.approx(np.ones(3), abs=0.3)


def test_the_addon_knows_what_the_function_says():
    world = driven([runner()], Estimate(), command=(0.4, 0.3))
    path = world.record.sensors["odometry"][:, 0]
    expected = covariances(path, AXLE, DRIFT)[-1]
    assert world.addons.estimate.covariance == pytest.approx(expected, rel=1e-9)


# -- the ellipse --------------------------------------------------------------------------------


@pytest.mark.parametrize("probability", [0.5, 0.95])
def test_an_ellipse_holds_its_share_of_a_normal_distribution(probability):
    covariance = np.array([[0.5, 0.3], [0.3, 0.4]])
    rim = ellipse((1.0, -2.0), covariance, probability)
    points = np.random.default_rng(1).multivariate_normal((0, 0), covariance, 20_000)
    inverse = np.linalg.inv(covariance)
    bound = [p @ inverse @ p for p in rim - (1.0, -2.0)]
    assert bound == pytest.approx(np.full(len(rim), bound[0]), rel=1e-6)
    inside = np.einsum("ni,ij,nj->n", points, inverse, points) < bound[0]
    assert inside.mean() == pytest.approx(probability, abs=0.01)


# -- what is drawn -------------------------------------------------------------------------------


def test_the_estimate_is_drawn_in_the_worlds_frame_whatever_its_origin():
    pose = (2.0, 1.0, np.pi / 2)
    ends = [
        drawn(driven([runner(drift=0.0, origin=origin, pose=pose)], Estimate()))[-1].center
        for origin in ("start", "world")
    ]
    assert ends[0] == pytest.approx(ends[1])
    assert ends[0] == pytest.approx((2.0, 6.0))


def test_readings_that_are_lost_are_left_out():
    sensors = [Odometry(drift=DRIFT, dropouts=0.5)]
    lossy = Robot(drive=Unicycle(wheel_semiaxis=AXLE), sensors=sensors)
    spread = driven([lossy], Estimate()).addons.estimate.covariance
    assert spread[0, 0] == pytest.approx(DRIFT**2 * 5 / 2, rel=0.1)


# -- whose ---------------------------------------------------------------------------------------


def test_it_takes_the_robot_that_is_named_or_the_first_with_odometry():
    robots = [Robot(name="a", pose=(0, 5, 0)), runner("b"), runner("c", pose=(0, 9, 0))]
    assert drawn(driven(robots, Estimate()))[-1].center[1] == pytest.approx(0, abs=1)
    assert drawn(driven(robots, Estimate(robot="c")))[-1].center[1] == pytest.approx(9, abs=1)


@each_case(
    ("robot", "addon", "message"),
    [
        (runner("anna"), Estimate(robot="ana"), "did you mean 'anna'"),
        (Robot(), Estimate(), "no robot has a sensor Odometry"),
        (Robot(name="a"), Estimate(robot="a"), "a has no sensor Odometry"),
        (
            Robot(drive=Holonomic(), sensors=[Odometry()]),
            Estimate(),
            "robot0 drives by Holonomic, which has no two wheels",
        ),
    ],
)
def test_one_that_cannot_be_followed_is_named(robot, addon, message):
    with pytest.raises(InputError, match=message):
        World(Scenario(robots=[robot], addons=[addon]))
