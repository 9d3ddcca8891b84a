"""The omnidirectional drive against its matrix and in contact, and teams of several inputs."""

from __future__ import annotations

import numpy as np
import pytest

from mars2d import Drive, Holonomic, InputError, Omni, Robot, Scenario, World, load
from mars2d.addons import Map
from mars2d.core.quantity import Quantity
from tests.cases import each_case

WHEELS = [(3, 60.0), (4, 45.0)]


@each_case(("wheels", "first"), WHEELS)
def test_rims_are_those_of_the_matrix(wheels, first):
    drive = Omni(wheels=wheels, wheel_distance=0.2, max_linear_speed=50)
    angles = np.radians(first + 360 / wheels * np.arange(wheels))
    matrix = np.array([-np.sin(angles), np.cos(angles), np.full(wheels, 0.2)]).T
    command = np.random.default_rng(1).uniform(-1, 1, (3, 50))
    assert drive.actuators(command) == pytest.approx(matrix @ command, abs=1e-12)
    assert drive.command_for(matrix @ command) == pytest.approx(command, abs=1e-12)
    free = np.random.default_rng(2).uniform(-1, 1, (wheels, 50))  # no command asks for these
    assert drive.command_for(free) == pytest.approx(np.linalg.pinv(matrix) @ free, abs=1e-12)


@each_case("sampling_time", [0.5, 0.1, 0.005])
def test_it_moves_on_the_arc_of_its_twist_and_a_limited_one_keeps_it(sampling_time):
    drive = Omni(max_linear_speed=0.4)
    for vx, vy, omega in [(0.2, 0.1, 0.5), (2.0, 1.0, 5.0)]:  # the second one ten times too fast
        scenario = Scenario(robots=[Robot(drive=drive)], sampling_time=sampling_time)
        world = World(scenario)
        for _ in range(round(1.0 / sampling_time)):
            world.step([[vx], [vy], [omega]])
        x, y, w = world.command[:, 0]
        assert np.abs(drive.actuators(world.command)).max() <= 0.4 * (1 + 1e-9)
        assert (x, y, w) == pytest.approx(w / omega * np.array([vx, vy, omega]))
        c, s = np.cos(w), np.sin(w)
        end = (x * s - y * (1 - c)) / w, (x * (1 - c) + y * s) / w, w
        assert world.pose[:, 0] == pytest.approx(end, abs=1e-9)


@each_case(("grip", "angle"), [(0.6, 0.0), (0.6, 0.4), (None, 0.0), (None, -0.7)])
def test_at_a_wall_it_pushes_with_what_its_wheels_bear(grip, angle):
    drive = Omni(grip=grip, max_force=2.0, max_torque=5.0)
    robot = Robot(pose=(0, 0, angle), drive=drive, mass=0.5, friction=0.0)
    wall = Map(outlines=[[(0.2, -2), (0.4, -2), (0.4, 2), (0.2, 2)]])
    world = World(Scenario(robots=[robot], addons=[wall]))
    for _ in range(30):
        world.step([[0.3 * np.cos(angle)], [-0.3 * np.sin(angle)], [0.0]])
    most = 2.0 if grip is None else 0.6 * 0.5 * 9.81 / 2  # less than its motors' 2 N
    assert robot.push == pytest.approx(most)
    assert world.contacts["impulse"].sum() / 0.1 == pytest.approx(most, rel=2e-3)


@each_case("wheels", [3, 4])
def test_noise_of_the_wheels_turns_it_as_the_page_says(wheels):
    drive = Omni(wheels=wheels, wheel_distance=0.2, noise=0.02)
    robots = [Robot(pose=(0, y, 0), drive=drive) for y in range(400)]
    world = World(Scenario(robots=robots, workspace=None, physics="ideal"), seed=3)
    for _ in range(50):
        world.step(np.tile([[0.3], [0.0], [0.0]], 400))
    spread = 0.3 * 0.02 * np.sqrt(5.0 / (2 * wheels)) / 0.2
    assert world.pose[2].std() == pytest.approx(spread, rel=0.14)  # four deviations


class Pump(Drive):
    """Goes ahead by one input, and turns by itself."""

    inputs = (Quantity("v", "m/s"),)

    def twist(self, command):
        return command[0], 0, 0.5


def test_teams_have_the_rows_of_the_drive_with_most_inputs(tmp_path):
    robots = [
        Robot(pose=(0, 0, 0), drive=Omni(noise=0.1), controller=lambda _: (0.1, 0.2, 0.3)),
        Robot(pose=(0, 2, 0), drive=Holonomic(), controller=lambda _: [0.1, 0.2]),
        Robot(pose=(0, 4, 0), drive=Pump(max_acceleration=1.0), controller=lambda _: (0.2,)),
    ]
    world = World(Scenario(robots=robots, workspace=None), seed=1)
    for _ in range(10):
        world.step()
    fork, alone = world.fork(), World(Scenario(robots=robots[1:2], workspace=None))
    for each in (world, fork):
        each.step({"robot0": (0.0, 0.0, 1.0), 2: [0.4]})
    assert (fork.pose == world.pose).all()
    assert alone.command.shape == (2, 1)
    assert world.command == pytest.approx(np.array([[0, 0.1, 0.3], [0, 0.2, 0], [1.0, 0, 0]]))
    assert world.robots[2].command.tolist() == [pytest.approx(0.3)]  # at most 0.1 m/s more a step
    world.step([[0.1, 0.0, 0.2], [0.0, 0.1, 9.0], [0.0, 9.0, 9.0]])
    assert world.command[:, 1:] == pytest.approx(np.array([[0.0, 0.2], [0.1, 0], [0, 0]]))
    assert world.pose[2, 2] == pytest.approx(0.5 * 1.2)
    for name in ("run.npz", "run.csv", "run.mcap"):
        world.record.save(tmp_path / name)
        assert (load(tmp_path / name).command == world.record.command).all()


@each_case(
    ("make", "message"),
    [
        (lambda: Omni(wheels=2), "Omni.wheels = 2: expected"),
        (lambda: Omni(no_load_speed=1.0), "Omni.no_load_speed = 1.0: expected None"),
        (type("Bare", (Drive,), {"inputs": ()}), "Bare.inputs = .*: expected a tuple"),
    ],
)
def test_what_it_can_t_be_is_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()
