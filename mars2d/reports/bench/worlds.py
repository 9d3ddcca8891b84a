"""The suite's scenes as worlds of MARS2D, and the overlaps of their robots."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.addons import Map
from mars2d.reports.bench.scenes import Scene, Turns
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors import Proximity, RangeFinder
from mars2d.sensors.base import Sensor
from mars2d.world.views import RobotView
from mars2d.world.world import World

__all__ = ["SETTINGS", "deepest", "world_of"]

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


def deepest(scene: Scene, pose: Float) -> float:
    """Return the deepest overlap at any of the poses (T, 3, n), metres; 0 if there is none.

    Overlaps of robots with each other, with the walls and with the boxes count.
    """
    import shapely
    from scipy.spatial import cKDTree

    r = scene.radius
    x, y = pose[:, 0].ravel(), pose[:, 1].ravel()
    wall = float(np.maximum(np.abs(x), np.abs(y)).max()) + r - scene.side / 2
    # Rows lie in planes that are further apart than touching robots: one tree finds all pairs.
    plane = np.repeat(np.arange(len(pose)) * 4 * r, pose.shape[2])
    space = np.column_stack([x, y, plane])
    i, j = cKDTree(space).query_pairs(2 * r, output_type="ndarray").T
    pairs = 2 * r - np.hypot(x[i] - x[j], y[i] - y[j])
    boxes = np.array([shapely.Polygon(box) for box in scene.boxes], dtype=object)
    centers = shapely.points(x, y)
    k, box = shapely.STRtree(boxes).query(centers, "dwithin", r)
    inside = r - shapely.distance(centers[k], boxes[box])
    return float(max(0.0, wall, pairs.max(initial=0.0), inside.max(initial=0.0)))
