"""The column of the selected body: what it says, where it lies, that the past is as it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Beacon as Lamp
from mars2d.addons import Communication, Map
from mars2d.bodies import Car, Differential, Holonomic, Unicycle
from mars2d.bodies.props import Ball, Box
from mars2d.core.materials import GRAVITY
from mars2d.output.raster.brushes import rgba
from mars2d.output.raster.layout import Layout
from mars2d.output.raster.painter import Painter
from mars2d.output.raster.theme import DARK, LIGHT
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Within
from mars2d.sensors import (
    Beacon,
    Bumper,
    Ground,
    Imu,
    LineCamera,
    Odometry,
    Pose,
    Proximity,
    RangeBearing,
    RangeFinder,
    Sensor,
    SonarRing,
)
from mars2d.window.panels.inspector import Inspector, readings_of
from mars2d.window.panels.readout import (
    contacts_of,
    dynamics_of,
    force_of,
    inbox,
    kind_of,
    state_of,
)
from mars2d.window.screen.picking import Selection
from tests.cases import each_case
from tests.window.written import Written, painter

SENSORS = [
    Pose(), Odometry(), Imu(), Proximity(range=1.0), Bumper(), Ground(), RangeFinder(beams=40),
    SonarRing(), LineCamera(), RangeBearing(), Beacon(),
]  # fmt: skip


class Strange(Sensor):
    """Reads an array of a shape that no plot is made for."""

    def read(self, robot, world, rng):
        return np.full((3, 4), np.nan if world.time > 0.5 else world.time)


def team(steps=30):
    """Return a world of two robots that talk and see, and a crate that one of them pushes."""

    def law(robot):
        for k in range(1000):
            robot.send({"step": k})
            yield 0.2, 0.1

    robots = [
        Robot(name="red", sensors=[*SENSORS, Strange()], controller=law),
        Robot(pose=(0, 1, 2), name="blue", drive=Differential(), controller=law),
        Robot(pose=(0, -1, 1), name="green", drive=Holonomic(), controller=lambda r: (0.1, -0.2)),
        Robot(pose=(-1, -1, 1), name="car", drive=Car(), controller=lambda r: (0.3, 0.2)),
    ]
    addons = [Communication(delay=0.2), Map([[(2, 2), (3, 2), (3, 3)]]), Lamp(at=(3, 0))]
    crate = Box(pose=(0.45, 0, 0), name="crate", ground_friction=0.3)
    every = {"robots": robots, "props": [crate], "addons": addons, "neighbours": Within(1.5)}
    world = World(Scenario(**every, stop_time=100))
    for _ in range(steps):
        world.step()
    world.observe()
    return world


@pytest.fixture(scope="module")
def world():
    return team()


def seen_of(frame, body):
    surface = pygame.Surface((344, 580), 0, 32)
    surface.fill("#ff00ff")
    Inspector(Painter(), Selection(body)).draw(surface, surface.get_rect(), frame)
    return pygame.surfarray.array3d(surface).swapaxes(0, 1).astype(int)


# -- what it says ---------------------------------------------------------------------------------


def words(frame, body):
    return {what: [f"{name} {value}" for name, value in row] for what, row in state_of(frame, body)}


def test_a_robots_numbers_are_those_of_its_drive(world):
    frame = world.frame
    kinds = ["unicycle", "differential", "holonomic", "car", "box"]
    assert [kind_of(frame, body) for body in range(5)] == kinds
    red, blue, green, car = (words(frame, body) for body in range(4))
    x, y, _ = frame.pose[:, 0]
    assert red["pose"][:2] == [f"x {x:.2f} m", f"y {y:.2f} m".replace("-", "\N{MINUS SIGN}")]
    theta = (frame.pose[2, 0] + np.pi) % (2 * np.pi) - np.pi
    assert red["heading"] == [f"θ {round(np.degrees(theta))}°", f" {theta:.2f} rad"]
    assert red["command"] == ["v 0.20 m/s", "ω 0.10 rad/s"]
    assert red["wheels"] == ["left 0.19", "right 0.21 m/s"]
    assert blue["command"] == ["left 0.20", "right 0.10 rad/s"]
    assert blue["wheels"] == ["left 0.01", "right 0.01 m/s"]  # the rims of wheels of 5 cm
    assert green["command"] == ["vx 0.10", "vy \N{MINUS SIGN}0.20 m/s"]
    assert "wheels" not in green
    assert car["command"] == ["v 0.30 m/s", "δ 11°"]
    assert car["turns"] == ["least radius 0.29 m"]
    assert "turns" not in red, "it turns on the spot"
    assert list(words(frame, 4)) == ["pose", "heading", "moves"], "a prop has no command"


def test_energy_and_momentum_stand_beside_those_of_all_bodies(world):
    frame = world.frame
    energy, momentum = dict(dynamics_of(frame, 4)).values()
    masses = [body.inertia.mass for body in frame.scenario.bodies]
    speeds = np.hypot(*np.hstack([world.velocity, world.prop_velocity])[:2])
    p = masses[4] * speeds[4]
    assert p > 0.01, "the crate is pushed"
    assert momentum[0] == ("p", f"{p:.3g} N s")
    spin = frame.scenario.bodies[4].inertia.moment * world.prop_velocity[2, 0] ** 2 / 2
    assert energy[0] == ("E", f"{p**2 / 2 / masses[4] + spin:.3g} J")
    assert float(energy[1][1].split()[0]) > float(energy[0][1].split()[0])
    old = replace(frame, work=np.empty(0))
    assert dynamics_of(old, 4) == [], "those of old records are unknown"


def test_what_moves_is_measured_over_the_control_step(world):
    np.testing.assert_allclose(world.frame.velocity[:2, 2], (0.1, -0.2), rtol=1e-6)
    assert words(world.frame, 2)["moves"] == ["v 0.22 m/s", "ω 0.00 rad/s"]
    start = Frame(world.scenario, 0.0, 0, world.pose, np.empty((0, 3, 4)))
    assert not start.velocity.any()


def test_contacts_are_named_with_their_force(world):
    (line,) = contacts_of(world.frame, 0)
    [(_, [(_, net), _])] = force_of(world.frame, 0)
    assert line == f"crate  {net}"
    assert contacts_of(world.frame, 4)[0].startswith("red")
    assert contacts_of(world.frame, 1) == []


def test_the_inbox_has_the_last_messages_that_have_arrived(world):
    heard = inbox(world.frame, 0)
    assert [(name, text) for name, _, text in heard] == [
        ("blue", f'{{"step":{world.iteration - 2 - k}}}') for k in range(3)
    ]
    assert heard[0][1] == pytest.approx(world.time - 0.2)
    early = world.record.frame(3)
    assert [text for _, _, text in inbox(early, 0)] == ['{"step":1}', '{"step":0}']
    assert inbox(world.record.frame(1), 0) == []


def test_scrubbing_back_shows_what_was_seen_then(world):
    record, played = world.record, team(steps=12)
    for body in (0, 1, 4):
        live, past = seen_of(played.frame, body), seen_of(record.frame(12), body)
        np.testing.assert_array_equal(live, past)


def test_every_sensor_has_a_plot(world):
    keys = [sensor.key for sensor, _ in readings_of(world.frame, 0)]
    assert keys == [sensor.key for sensor in world.scenario.robots[0].sensors]
    panel = Inspector(Painter(), Selection(0))
    for row in (0, 3, 29):
        frame = world.record.frame(row)
        for sensor, reading in readings_of(frame, 0):
            for part in panel.reading(frame, 0, sensor, reading):
                surface = pygame.Surface((300, round(part.height)), 0, 32)
                before = pygame.surfarray.array3d(surface)
                part.draw(surface, surface.get_rect())
                assert (pygame.surfarray.array3d(surface) != before).any(), sensor.key


def test_a_scan_is_seen_from_left_to_right():
    wall = Map([[(0.5, 0.3), (1.0, 0.3), (1.0, 1.0)]])  # ahead and to the left
    robot = Robot(sensors=[RangeFinder(beams=90, range=2.0)])
    world = World(Scenario(robots=[robot], addons=[wall], workspace=None))
    world.observe()
    ((sensor, reading),) = readings_of(world.frame, 0)
    (plot,) = Inspector(Painter(), Selection(0)).reading(world.frame, 0, sensor, reading)
    surface = pygame.Surface((300, round(plot.height)), 0, 32)
    plot.draw(surface, surface.get_rect())
    ink = rgba(LIGHT.shade(world.scenario.colors[0]))[:3]
    tall = (pygame.surfarray.array3d(surface) == ink).all(axis=2).sum(axis=1)
    low = np.flatnonzero((tall > 0) & (tall < tall.max() - 4))
    assert len(low) > 5
    assert (low < 155).all(), "the wall is left of the middle"


# -- the force ------------------------------------------------------------------------------------


def test_the_force_on_a_robot_that_stalls_is_what_its_drive_can_push_with():
    box = Box(pose=(0.5, 0, 0), length=0.3, width=0.3, ground_friction=0.6, mass=1, name="box")
    robot = Robot(drive=Unicycle(max_force=5), name="red")
    scenario = Scenario(robots=[robot], props=[box], workspace=None, stop_time=1000)
    world = World(scenario, lambda world: [[0.2], [0.0]])
    assert force_of(world.frame, 0) == [("force", [("net", "0.00 N"), ("drive", "5.0 N")])]
    while world.time < 4:
        world.step()
    assert force_of(world.frame, 0) == [("force", [("net", "5.0 N"), ("drive", "5.0 N")])]
    floor = f"{0.6 * GRAVITY:.1f} N"
    assert force_of(world.frame, 1) == [("force", [("net", "5.0 N"), ("floor", floor)])]
    record = world.record
    assert force_of(record.frame(len(record) - 1), 0) == force_of(world.frame, 0)
    ball = World(Scenario(robots=[Robot()], props=[Ball(pose=(1, 0, 0))]))
    assert force_of(ball.frame, 1) == [("force", [("net", "0.00 N")])], "nothing holds a ball"


# -- the column -----------------------------------------------------------------------------------


@each_case(
    "size, theme",
    [((316, 580), DARK), ((260, 176), LIGHT), ((316, 250), DARK), ((800, 1300), LIGHT)],
)
def test_it_fits_into_what_there_is(world, size, theme):
    for body in range(5):
        inspector, surface = (
            Inspector(painter(Layout.of((1280, 720)), theme), Selection(body)),
            Written(size),
        )
        inspector.draw(surface, surface.get_rect(), world.frame)
        assert not surface.crowded()
        assert all(0 <= place.left <= place.right <= size[0] for _, place in surface.words)


def test_all_sensors_can_be_reached_by_the_wheel(world):
    surface = Written((316, 300))
    inspector = Inspector(painter(Layout.of((1280, 720)), LIGHT), Selection(0))
    seen = set()
    for _ in range(60):
        inspector.draw(surface, surface.get_rect(), world.frame)
        seen |= set(surface.texts)
        inspector.handle(pygame.Event(pygame.MOUSEWHEEL, y=-1, precise_y=-1.0))
    assert {sensor.key for sensor in world.scenario.robots[0].sensors} <= seen
