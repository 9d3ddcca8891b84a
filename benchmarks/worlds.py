"""The suite's scenes as worlds of MARS2D, and the overlaps of their bodies."""

from __future__ import annotations

import numpy as np
from gaps import Gaps
from numpy.typing import NDArray
from scenes import BOX, FLOOR, MASS, Scene

from mars2d.addons import Map
from mars2d.bodies import Box, Rope
from mars2d.geometry.shapes import rectangle
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors import Proximity, RangeFinder
from mars2d.sensors.base import Sensor
from mars2d.world.views import RobotView
from mars2d.world.world import World

Float = NDArray[np.float64]

SETTINGS = {"default": 1e-3, "loose": 0.02}
"""`Scenario.max_overlap` by the names of the suite's settings, metres."""


def wander(robot: RobotView) -> tuple[float, float]:
    """Return the command of Algorithm 2. Source: Casini & Garulli (2016), section 4."""
    if robot.sense.proximity:
        return -0.2, 0.0
    if robot.command[0] < 0:
        return 0.0, robot.rng.uniform(np.pi / 2, 3 * np.pi / 2)
    return 0.2, 0.0


def world_of(scene: Scene, max_overlap: float = 1e-3) -> World:
    """Return a world of a scene, with its law. max_overlap: metres, as of a Scenario."""
    sensors: list[Sensor] = []
    if scene.proximity:
        sensors.append(Proximity(range=scene.proximity))
    if scene.beams:
        sensors.append(RangeFinder(beams=scene.beams, range=scene.range))
    controller = wander if scene.proximity else None
    if scene.square:
        square = rectangle(2 * scene.radius, 2 * scene.radius)
        robot = Robot(shape=square, sensors=sensors, controller=controller)
    else:
        robot = Robot(diameter=2 * scene.radius, sensors=sensors, controller=controller)
    crate = Box(length=BOX, width=BOX, mass=MASS, ground_friction=FLOOR)
    scenario = Scenario(
        title=scene.title,
        robots=[robot.at(*pose) for pose in scene.poses.tolist()],
        props=[crate.at(*pose) for pose in scene.crates.tolist()],
        joints=[Rope(a=f"robot{i}", b=f"box{k}", length=length) for i, k, length in scene.ropes],
        workspace=scene.walls,
        on_exit="wall",
        sampling_time=scene.sampling_time,
        stop_time=1e6,
        max_overlap=max_overlap,
        addons=[Map(scene.boxes)],
    )
    if scene.proximity:
        return World(scenario)
    law = scene.law()
    return World(scenario, lambda world: law(world.iteration))


def deepest(scene: Scene, pose: Float) -> float:
    """Return the deepest overlap at any of the poses (T, 3, n + p), metres; 0 if there is none.

    The poses are those of robots, then crates. Overlaps with each other, with the walls and with
    the obstacles count.
    """
    gaps = Gaps(scene)
    return max(0.0, *(-float(gap.min()) for row in pose for gap in gaps(row.T)))
