"""One instant of an experiment as it is seen, live or recorded, and the scene made of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.contact import CONTACT
from mars2d.robot import Robot
from mars2d.scenario import Scenario
from mars2d.scene import Scene, faded
from mars2d.usercode import called

__all__ = [
    "Frame",
    "initial_poses",
    "obstacles",
    "robots",
    "sensors",
    "trail_colors",
    "trails",
    "workspace",
]

Float = NDArray[np.float64]

INK = "#3d4852"
OBSTACLE = "#b8c0c8"
TRAIL_WIDTH = 1.6


def _no_contacts() -> NDArray[np.void]:
    return np.empty(0, dtype=CONTACT)


@dataclass(frozen=True, slots=True)
class Frame:
    """What is seen at one instant.

    pose: (3, n) now. path: (k, 3, n), the poses at all sampling times before, from the start on.
    readings: for each sensor's name the pairs (robot index, reading). draw_addons: adds the
    add-ons' shapes to a scene, where they are alive. prop_pose: (3, p). contacts: those of the
    control step that led here, and effort (n,) of the drives in it. contact_log: returns all
    contacts so far.
    """

    scenario: Scenario
    time: float
    iteration: int
    pose: Float
    path: Float
    readings: Mapping[str, Sequence[tuple[int, Any]]] = field(default_factory=dict)
    over_message: str = ""
    draw_addons: Callable[[Scene], None] | None = None
    prop_pose: Float = field(default_factory=lambda: np.empty((3, 0)))
    contacts: NDArray[np.void] = field(default_factory=_no_contacts)
    effort: Float = field(default_factory=lambda: np.empty(0))
    contact_log: Callable[[], NDArray[np.void]] = _no_contacts


def workspace(scenario: Scenario) -> Scene:
    """Return the workspace, on which a grid may be drawn."""
    scene = Scene()
    if scenario.workspace is not None:
        wall = scenario.on_exit == "wall"
        scene.polygon(
            scenario.workspace,
            fill="#ffffff",
            stroke=INK if wall else faded(INK, 0.55),
            width=2.5 if wall else 1.2,
        )
    return scene


def obstacles(scenario: Scenario) -> Scene:
    """Return the obstacles."""
    scene = Scene()
    for outline in scenario.obstacles:
        if len(outline) == 2:
            scene.line(outline, stroke=INK, width=2.5)
        else:
            scene.polygon(outline, fill=OBSTACLE, stroke=INK, width=1.5)
    return scene


def trails(frame: Frame) -> Scene:
    """Return the paths of the robots so far, as the animation's wake style says."""
    scene = Scene()
    style = frame.scenario.animation.wake_style
    for i, color in enumerate(trail_colors(frame.scenario)):
        path = np.vstack([frame.path[:, :2, i], frame.pose[None, :2, i]])
        scene.line(path, stroke=color, width=TRAIL_WIDTH, style=style)
    return scene


def trail_colors(scenario: Scenario) -> tuple[str, ...]:
    """Return the colours of the robots' paths."""
    return tuple(faded(color, 0.85) for color in scenario.colors)


def initial_poses(scenario: Scenario) -> Scene:
    """Return the robots at their starts, hollow."""
    scene = Scene()
    for robot, pose, color in zip(
        scenario.robots, scenario.initial_pose.T, scenario.colors, strict=True
    ):
        _robot(scene, scenario, robot, pose, fill=None, stroke=faded(color, 0.8))
    return scene


def robots(frame: Frame) -> Scene:
    """Return the robots where they are, filled."""
    scene = Scene()
    scenario = frame.scenario
    for robot, pose, color in zip(scenario.robots, frame.pose.T, scenario.colors, strict=True):
        _robot(scene, scenario, robot, pose, fill=color, stroke="#ffffff")
    return scene


def _robot(
    scene: Scene, scenario: Scenario, robot: Robot, pose: Float, fill: str | None, stroke: str
) -> None:
    """Draw a robot: its disc with a line from the centre of rotation to the front, or a point."""
    x, y, theta = pose.tolist()
    if not scenario.animation.show_real_shape:
        scene.circle((x, y), 0.0, fill=fill, stroke=stroke, pixels=5.0)
        return
    c, s = np.cos(theta), np.sin(theta)
    offset, r = robot.center_offset, robot.radius
    center = (x - offset * c, y - offset * s)
    scene.circle(center, r, fill=fill, stroke=stroke, width=1.5)
    mark = stroke if fill is None else "#ffffff"
    back, front = min(offset, 0.0), r
    ends = [(center[0] + d * c, center[1] + d * s) for d in (back, front)]
    scene.line(ends, stroke=mark, width=2.5)
    if offset:
        scene.circle((x, y), r / 6, fill=mark)  # the centre of rotation


def sensors(frame: Frame) -> Scene:
    """Return what the sensors see, each drawn by itself."""
    scene = Scene()
    colors = frame.scenario.colors
    carried = [{sensor.key: sensor for sensor in r.sensors} for r in frame.scenario.robots]
    for key, readings in frame.readings.items():
        for i, reading in readings:
            sensor = carried[i].get(key)  # a loaded record lacks sensors of the user's own
            if sensor is not None:
                with called(f"sensor {key!r}", sensor.draw):
                    sensor.draw(scene, frame.pose[:, i], reading, colors[i])
    return scene
