"""The suite's scenes as worlds of MARS2D."""

from __future__ import annotations

import numpy as np

from mars2d.addons import Map
from mars2d.reports.bench.scenes import Scene, Turns
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors import Proximity, RangeFinder
from mars2d.sensors.base import Sensor
from mars2d.world.views import RobotView
from mars2d.world.world import World

__all__ = ["SETTINGS", "world_of"]

SETTINGS = {"default": 1e-3, "loose": 0.02}
"""`Scenario.max_overlap` by the names of the suite's settings, metres."""


def wander(robot: RobotView) -> tuple[float, float]:
    """Do what Algorithm 2 does. Source: Casini & Garulli (2016), section 4."""
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
    robot = Robot(
        diameter=2 * scene.radius, sensors=sensors, controller=wander if scene.proximity else None
    )
    scenario = Scenario(
        title=scene.title,
        robots=[robot.at(*pose) for pose in scene.poses.tolist()],
        workspace=scene.walls,
        on_exit="wall",
        sampling_time=scene.sampling_time,
        stop_time=1e6,
        max_overlap=max_overlap,
        addons=[Map(scene.boxes)],
    )
    if scene.proximity:
        return World(scenario)
    law = Turns(len(scene.poses), scene.sampling_time)
    return World(scenario, lambda world: law(world.iteration))
