"""The same scene mirrored, turned, moved, or cut into other control steps goes the same way.

Free of contact these hold to 1e-9. In contact the engine rounds differently and cuts substeps at
other times: what is not chaotic agrees within the tolerances given with the scenes. A box that is
pushed touches, or does not, by the last digit, and then goes a hundredth of its way elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
import pytest

from mars2d import Car, Differential, Holonomic, Robot, Scenario, Unicycle, World, sensors
from mars2d.addons import Beacon, Floor, Map
from mars2d.bodies.joints import Hinge, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Prop, Puck, Solid
from mars2d.geometry.shapes import Polygon
from mars2d.scenario.registry import members
from tests.cases import each_case

Point = tuple[float, float]

WEDGE = Polygon([(-0.15, -0.12), (0.2, 0), (-0.15, 0.12)])
ROOM = [(-1, -0.8), (0.9, -0.8), (1, 1), (-1, 0.9)]


class Scene(NamedTuple):
    """What is simulated, and how well its images agree with it, in metres and radians."""

    robots: list[Robot]
    commands: list[Point]
    props: list[Prop] = []
    joints: list = []
    walls: list[list[Point]] = []
    room: list[Point] | None = None
    on_exit: str = "ignore"
    physics: str = "contact"
    addons: list = []
    duration: float = 4.0
    tolerance: float = 1e-6  # of images
    split: float = 1e-3  # of other sampling times


SCENES = {
    "free": Scene(
        [Robot(pose=(0, 0, 0.3)), Robot(pose=(2, 1, -1), drive=Holonomic(), center_offset=0.1)],
        [(0.3, 0.4), (0.1, -0.2)],
        [Puck(pose=(0, -2, 0), velocity=(1, 0.3, 5)), Bar(pose=(3, 3, 1), velocity=(0, 0, 3))],
        tolerance=1e-9, split=1e-9,
    ),
    "push a box beside its centre": Scene(
        [Robot(pose=(-0.5, 0.07, 0))], [(0.2, 0.0)], [Box()], tolerance=2e-2, split=2e-2
    ),
    "slide along a wall": Scene(
        [Robot(pose=(0, 0.3, -0.7), drive=Unicycle(max_torque=5), friction=0.3)],
        [(0.3, 0.0)], walls=[[(-2, 0), (5, 0)]], tolerance=1e-5, split=2e-3,
    ),
    "two robots meet obliquely": Scene(
        [Robot(pose=(-0.6, 0, 0)), Robot(pose=(0.6, 0.12, pi), mass=2)],
        [(0.3, 0.0), (0.2, 0.0)], tolerance=1e-4, split=2e-2,
    ),
    "a ball bounces": Scene(
        [Robot(pose=(-3, -3, 0))], [(0.1, 0.1)],
        [Ball(pose=(0, 0.5, 0), velocity=(0.7, -0.9, 1), friction=0.3, restitution=0.8)],
        walls=[[(-3, 0), (5, 0)], [(1.5, -1), (1.5, 3)]], duration=2.5, tolerance=1e-2,
        split=1e-2,
    ),
    "tow": Scene(
        [Robot(pose=(0, 0, 0))], [(0.3, 0.2)], [Box(pose=(-1, 0.1, 0.2), ground_friction=0.2)],
        joints=[Rope(a="robot0", b="box0", length=1.2, anchor_b=(0.2, 0))], tolerance=1e-4,
        split=2e-2,
    ),
    "trailer and spring": Scene(
        [Robot(pose=(0, 0, 0))], [(0.25, -0.3)],
        [
            Box(pose=(-0.5, 0, 0), length=0.3, width=0.2, ground_friction=0.1),
            Ball(pose=(-1.2, 0, 0)),
        ],
        joints=[
            Hinge(a="robot0", b="box0", anchor_a=(-0.25, 0), anchor_b=(0.25, 0)),
            Spring(a="box0", b="ball1", stiffness=10, damping=1),
        ],
        tolerance=1e-4, split=1e-2,
    ),
    "a wedge robot pushes a concave solid": Scene(
        [Robot(pose=(-0.6, 0.02, 0), shape=WEDGE, drive=Unicycle(max_force=8))], [(0.2, 0.0)],
        [Solid(Polygon([(0, 0), (0.1, 0.3), (0.3, 0.3), (0.3, -0.3), (0.1, -0.3)]))],
        tolerance=1e-2, split=4e-2,
    ),
    "all drives": Scene(
        [
            Robot(pose=(0, 0, 0.3), drive=Car()),
            Robot(pose=(2, 0, 1), drive=Differential()),
            Robot(pose=(4, 0, 2), drive=Differential(command="twist", dead_time=0.5)),
            Robot(pose=(0, 2, 3), drive=Holonomic(), shape=WEDGE),
            Robot(pose=(2, 2, 4), drive=Unicycle(), center_offset=0.1),
        ],
        [(0.3, 0.4), (3.0, 5.0), (0.2, 0.5), (0.1, -0.2), (0.3, -0.4)],
        tolerance=1e-9, split=1e-9,
    ),
    "drives that take time": Scene(
        [
            Robot(pose=(0, 0, 0.3), drive=Car(max_steering_rate=0.5)),
            Robot(pose=(2, 0, 1), drive=Unicycle(max_acceleration=0.2)),
        ],
        [(0.3, 0.4), (0.3, 0.4)],
        tolerance=1e-9, split=0.2,  # they gain speed once a control step
    ),
    "out of the workspace": Scene(
        [Robot(pose=(0, 0, 0.3)), Robot(pose=(-0.5, 0.5, 2))], [(0.4, 0.3), (0.1, 0.2)],
        room=ROOM, on_exit="stop", tolerance=1e-9, split=0.3,
    ),
    "in a room": Scene(
        [Robot(pose=(0, 0, 0.3)), Robot(pose=(-0.5, 0.5, 2), drive=Holonomic())],
        [(0.4, 0.3), (-0.2, 0.2)],
        room=ROOM, on_exit="wall", tolerance=1e-3, split=2e-2,
    ),
    "without physics": Scene(
        [Robot(pose=(-0.6, 0, 0)), Robot(pose=(0.6, 0.12, pi))], [(0.3, 0.1), (0.2, 0.0)],
        physics="ideal", tolerance=1e-9, split=1e-9,
    ),
    "robots stop where they meet": Scene(
        [Robot(pose=(-0.6, 0, 0)), Robot(pose=(0.6, 0.12, pi))], [(0.3, 0.1), (0.2, 0.0)],
        physics="stop", tolerance=1e-6, split=0.1,
    ),
}  # fmt: skip


class Image(NamedTuple):
    """A rigid motion of the plane, perhaps with a reflection: x -> turn x + shift."""

    angle: float = 0.0
    shift: Point = (0.0, 0.0)
    mirror: bool = False

    def point(self, p: Point) -> Point:
        x, y = p[0], -p[1] if self.mirror else p[1]
        c, s = cos(self.angle), sin(self.angle)
        return c * x - s * y + self.shift[0], s * x + c * y + self.shift[1]

    def local(self, p: Point) -> Point:
        """A point in a body's frame: bodies are mirrored along their headings."""
        return p[0], -p[1] if self.mirror else p[1]

    def heading(self, theta: float) -> float:
        return (-theta if self.mirror else theta) + self.angle

    def pose(self, pose) -> tuple[float, float, float]:
        return (*self.point(pose[:2]), self.heading(pose[2]))

    def vector(self, v: Point) -> Point:
        x, y = self.point(v)
        return x - self.shift[0], y - self.shift[1]

    def velocity(self, v) -> tuple[float, float, float]:
        return (*self.vector(v[:2]), -v[2] if self.mirror else v[2])

    def command(self, robot: Robot, command: Point) -> Point:
        if isinstance(robot.drive, Holonomic):
            return self.vector(command)
        if isinstance(robot.drive, Differential) and robot.drive.command == "wheels":
            return command[::-1] if self.mirror else command
        return command[0], -command[1] if self.mirror else command[1]

    def shape(self, part):
        """A chassis or a solid of which a polygon is given."""
        if isinstance(getattr(part, "shape", None), Polygon) and not isinstance(part, (Box, Bar)):
            outline = [self.local(p) for p in part.shape.outline]
            return part.replace(shape=Polygon(outline))
        return part

    def sensor(self, sensor):
        ahead, left, turned = sensor.mount
        return sensor.replace(mount=(ahead, -left, -turned)) if self.mirror else sensor

    def addon(self, addon):
        """A beacon or a floor with patches."""
        if isinstance(addon, Beacon):
            return addon.replace(at=self.point(addon.at))
        patches = [([self.point(p) for p in patch], color) for patch, color in addon.patches]
        return addon.replace(patches=patches)

    def reading(self, name: str, values: np.ndarray) -> np.ndarray:
        """The readings (T, m, ...) of a sensor: those on the left are on the right in a mirror."""
        if name == "pose":
            return np.array([[self.pose(pose) for pose in row] for row in values.tolist()])
        if not self.mirror or name in ("proximity", "ground"):
            return values
        if name == "line_camera":
            return values[..., ::-1, :]
        if name in ("bumper", "range_finder", "sonar_ring"):
            return values[..., ::-1]
        return values * (1, -1, -1)[: values.shape[-1]]

    def joint(self, joint):
        anchor_b = self.local(joint.anchor_b) if joint.b else self.point(joint.anchor_b)
        return joint.replace(anchor_a=self.local(joint.anchor_a), anchor_b=anchor_b)


def world_of(scene: Scene, image: Image, sampling_time: float = 0.1) -> World:
    """The image of a scene."""
    walls = [[image.point(p) for p in wall] for wall in scene.walls]
    return World(
        Scenario(
            robots=[
                image.shape(robot).replace(
                    pose=image.pose(robot.pose),
                    sensors=[image.sensor(sensor) for sensor in robot.sensors],
                )
                for robot in scene.robots
            ],
            props=[
                image.shape(prop).replace(
                    pose=image.pose(prop.pose), velocity=image.velocity(prop.velocity)
                )
                for prop in scene.props
            ],
            joints=[image.joint(joint) for joint in scene.joints],
            addons=[*([Map(walls)] if walls else []), *map(image.addon, scene.addons)],
            workspace=None if scene.room is None else [image.point(p) for p in scene.room],
            on_exit=scene.on_exit,
            physics=scene.physics,
            sampling_time=sampling_time,
            stop_time=1e3,
        )
    )


def run(scene: Scene, image: Image, sampling_time: float = 0.1) -> np.ndarray:
    """The poses (T, 3, n + p) every 0.5 s of the image of a scene."""
    world = world_of(scene, image, sampling_time)
    commands = commands_of(scene, image)
    poses = []
    for k in range(round(scene.duration / sampling_time)):
        if not world.over:
            world.step(commands)
        if (k + 1) % round(0.5 / sampling_time) == 0:
            poses.append(np.hstack([world.pose, world.prop_pose]))
    return np.array(poses)


def commands_of(scene: Scene, image: Image) -> np.ndarray:
    """The commands (2, n) of the image of a scene."""
    given = zip(scene.robots, scene.commands, strict=True)
    return np.transpose([image.command(robot, command) for robot, command in given])


def seen(image: Image, poses: np.ndarray) -> np.ndarray:
    """The image of poses (T, 3, N)."""
    flat = poses.transpose(0, 2, 1).reshape(-1, 3)
    moved = np.array([image.pose(pose) for pose in flat.tolist()])
    return moved.reshape(len(poses), -1, 3).transpose(0, 2, 1)


IMAGES = {
    "mirrored": Image(mirror=True),
    "turned and moved": Image(angle=0.7345, shift=(37.1, -12.3)),
    "all of it": Image(angle=-2.1, shift=(-3.3, 8.7), mirror=True),
}


@pytest.fixture(scope="module")
def original() -> Callable[[str], np.ndarray]:
    known: dict[str, np.ndarray] = {}

    def poses(name: str) -> np.ndarray:
        if name not in known:
            known[name] = found = run(SCENES[name], Image())
            assert np.abs(found[-1] - found[0]).max() > 0.2, "nothing happens"
        return known[name]

    return poses


@each_case("image", IMAGES.values())
@each_case("name", SCENES)
def test_the_image_of_a_scene_goes_as_the_image_of_its_poses(name, image, original):
    error = np.abs(run(SCENES[name], image) - seen(image, original(name))).max()
    assert error < SCENES[name].tolerance


@each_case("sampling_time", [0.02, 0.5])
@each_case("name", SCENES)
def test_held_commands_give_the_same_poses_for_any_sampling_time(name, sampling_time, original):
    error = np.abs(run(SCENES[name], Image(), sampling_time) - original(name)).max()
    assert error < SCENES[name].split


# -- sensors --------------------------------------------------------------------------------------

LOOKING = [
    sensors.Beacon(range=2.0, mount=(0.1, 0.05, 0.2)),
    sensors.Bumper(sectors=5, field_of_view=4.0),
    sensors.Ground(mount=(0.1, 0.05, 0)),
    sensors.Imu(mount=(0.03, -0.02, 0.4)),
    sensors.LineCamera(pixels=11, range=3.0, mount=(0.1, 0.02, 0.3)),
    sensors.Odometry(),
    sensors.Pose(),
    sensors.Proximity(range=0.35, mount=(0.1, 0.1, 0)),
    sensors.RangeBearing(range=1.5),
    sensors.RangeFinder(beams=13, range=2.0, field_of_view=4.0, mount=(0.1, 0.02, 0.3)),
    sensors.SonarRing(sonars=7, range=2.0, field_of_view=4.0, mount=(0.1, 0.02, 0.3)),
]

TOUR = Scene(
    [
        Robot(pose=(0, 0, 0.3), sensors=LOOKING),
        Robot(pose=(0.9, 0.8, -2.4), sensors=LOOKING, shape=WEDGE, color="#d62728"),
    ],
    [(0.3, 0.35), (0.35, 0.3)],
    [Box(pose=(1.5, -0.5, 0.4)), Puck(pose=(-0.7, 0.9, 0), velocity=(0.2, -0.1, 0))],
    walls=[[(-1, -0.6), (2, -1.1)], [(0.2, 1.2), (0.6, 1.4), (0.3, 1.7)]],
    addons=[
        Beacon(name="lamp", at=(1.3, 1.1)),
        Beacon(name="lantern", at=(-1, 0.2)),
        Floor(patches=[([(0.2, -0.3), (2, -0.4), (1.9, 0.6), (0.25, 0.5)], "#336699")]),
    ],
    tolerance=1e-6,
)  # fmt: skip


def readings(image: Image) -> dict[str, np.ndarray]:
    """What all sensors read in the image of the tour, by name."""
    world = world_of(TOUR, image)
    commands = commands_of(TOUR, image)
    for _ in range(40):
        world.step(commands)
    return dict(world.record.sensors)


@pytest.fixture(scope="module")
def originals() -> dict[str, np.ndarray]:
    return readings(Image())


def test_all_shipped_sensors_read_something_on_the_tour(originals):
    shipped = {k.__name__ for k in members("sensors").values() if k.__module__[:7] == "mars2d."}
    assert {type(sensor).__name__ for sensor in LOOKING} == shipped
    for name, values in originals.items():
        assert (values != values[0]).any(axis=tuple(range(2, values.ndim))).any(), name


@each_case("image", IMAGES.values())
def test_in_the_image_of_a_scene_sensors_read_the_images_of_their_readings(image, originals):
    for name, values in readings(image).items():
        expected = image.reading(name, originals[name])
        assert np.allclose(values, expected, rtol=0, atol=TOUR.tolerance, equal_nan=True), name
