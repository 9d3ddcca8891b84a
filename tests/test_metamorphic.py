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

from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.joints import Hinge, Rope, Spring
from mars2d.props import Ball, Bar, Box, Prop, Puck, Solid
from mars2d.shapes import Polygon

Point = tuple[float, float]

WEDGE = Polygon([(-0.15, -0.12), (0.2, 0), (-0.15, 0.12)])


class Scene(NamedTuple):
    """What is simulated, and how well its images agree with it, in metres and radians."""

    robots: list[Robot]
    commands: list[Point]
    props: list[Prop] = []
    joints: list = []
    walls: list[list[Point]] = []
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
        return command[0], -command[1] if self.mirror else command[1]

    def shape(self, part):
        """A chassis or a solid of which a polygon is given."""
        if isinstance(getattr(part, "shape", None), Polygon) and not isinstance(part, (Box, Bar)):
            outline = [self.local(p) for p in part.shape.outline]
            return part.replace(shape=Polygon(outline))
        return part

    def joint(self, joint):
        anchor_b = self.local(joint.anchor_b) if joint.b else self.point(joint.anchor_b)
        return joint.replace(anchor_a=self.local(joint.anchor_a), anchor_b=anchor_b)


def run(scene: Scene, image: Image, sampling_time: float = 0.1) -> np.ndarray:
    """The poses (T, 3, n + p) every 0.1 s of the image of a scene."""
    walls = [[image.point(p) for p in wall] for wall in scene.walls]
    world = World(
        Scenario(
            robots=[
                image.shape(robot).replace(pose=image.pose(robot.pose)) for robot in scene.robots
            ],
            props=[
                image.shape(prop).replace(
                    pose=image.pose(prop.pose), velocity=image.velocity(prop.velocity)
                )
                for prop in scene.props
            ],
            joints=[image.joint(joint) for joint in scene.joints],
            addons=[Map(walls)] if walls else [],
            workspace=None,
            sampling_time=sampling_time,
            stop_time=1e3,
        )
    )
    commands = [
        image.command(robot, command)
        for robot, command in zip(scene.robots, scene.commands, strict=True)
    ]
    poses = []
    for k in range(round(scene.duration / sampling_time)):
        world.step(np.transpose(commands))
        if (k + 1) % round(0.5 / sampling_time) == 0:
            poses.append(np.hstack([world.pose, world.prop_pose]))
    return np.array(poses)


def seen(image: Image, poses: np.ndarray) -> np.ndarray:
    """The image of poses (T, 3, N)."""
    flat = poses.transpose(0, 2, 1).reshape(-1, 3)
    moved = np.array([image.pose(pose) for pose in flat.tolist()])
    return moved.reshape(len(poses), -1, 3).transpose(0, 2, 1)


IMAGES = {
    "mirrored": Image(mirror=True),
    "turned": Image(angle=0.7345),
    "moved": Image(shift=(37.1, -12.3)),
    "all of it": Image(angle=-2.1, shift=(-3.3, 8.7), mirror=True),
}


@pytest.fixture(scope="module")
def original() -> Callable[[str], np.ndarray]:
    known: dict[str, np.ndarray] = {}

    def poses(name: str) -> np.ndarray:
        if name not in known:
            known[name] = run(SCENES[name], Image())
        return known[name]

    return poses


@pytest.mark.parametrize("image", IMAGES.values(), ids=IMAGES)
@pytest.mark.parametrize("name", SCENES)
def test_the_image_of_a_scene_goes_as_the_image_of_its_poses(name, image, original):
    error = np.abs(run(SCENES[name], image) - seen(image, original(name))).max()
    assert error < SCENES[name].tolerance


@pytest.mark.parametrize("sampling_time", [0.05, 0.02, 0.5])
@pytest.mark.parametrize("name", SCENES)
def test_held_commands_give_the_same_poses_for_any_sampling_time(name, sampling_time, original):
    error = np.abs(run(SCENES[name], Image(), sampling_time) - original(name)).max()
    assert error < SCENES[name].split


@pytest.mark.parametrize("name", SCENES)
def test_scenes_do_something(name, original):
    poses = original(name)
    assert np.isfinite(poses).all()
    assert np.abs(poses[-1] - poses[0]).max() > 0.2
