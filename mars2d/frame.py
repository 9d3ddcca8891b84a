"""One instant of an experiment as it is seen, live or recorded, and the scene made of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.contact import CONTACT
from mars2d.geometry import rectangle
from mars2d.looks import INK, OBSTACLE, draw_prop, draw_robot, draw_tie, prop_colors, prop_edge
from mars2d.message import MESSAGE
from mars2d.robot import Robot
from mars2d.scenario import Scenario
from mars2d.scene import Scene, faded
from mars2d.usercode import called

__all__ = [
    "Frame",
    "addons",
    "floor",
    "initial_poses",
    "joints",
    "obstacles",
    "prop_trail_colors",
    "props",
    "robots",
    "sensors",
    "theory",
    "trail_colors",
    "trails",
    "workspace",
]

Float = NDArray[np.float64]

TRAIL_WIDTH = 1.6
PROP_TRAIL_WIDTH = 1.0


def _no_contacts() -> NDArray[np.void]:
    return np.empty(0, dtype=CONTACT)


def addons(frame: Frame) -> Scene:
    """Return what the add-ons draw: by their fields and the time, and where they are alive."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.draw):
            addon.draw(scene, frame)
    if frame.draw_addons is not None:
        frame.draw_addons(scene)
    return scene


def theory(frame: Frame) -> Scene:
    """Return what the add-ons draw of what theory predicts."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.theory):
            addon.theory(scene, frame)
    return scene


def _no_messages() -> NDArray[np.void]:
    return np.empty(0, dtype=MESSAGE)


def _no_message_log() -> tuple[NDArray[np.void], Sequence[str]]:
    return _no_messages(), ()


def _no_readings(name: str, robot: int) -> None:  # noqa: ARG001
    return None


@dataclass(frozen=True, slots=True)
class Frame:
    """What is seen at one instant.

    pose: (3, n) now. path: (k, 3, n), the poses at all sampling times before, from the start on.
    readings: for each sensor's name the pairs (robot index, reading). sensed: (3, n), the poses at
    which they were read, where these are others than `pose`. draw_addons: adds the add-ons' shapes
    to a scene, where they are alive. prop_pose: (3, p). contacts: those of the control step that
    led here, and effort (n,) of the drives in it. contact_log: returns all contacts so far.
    prop_path: (k, 3, p), effort_path: (k, n) and command_path: (k, 2, n), as path; they may be left
    empty. messages: those that were under way in the control step that led here. message_log:
    returns all so far, and the texts that their field `content` numbers. reading_path: returns what
    a sensor, by its name, read on a robot at the times of `path`, (k, ...), or None where that is
    not known.
    """

    scenario: Scenario
    time: float
    iteration: int
    pose: Float
    path: Float
    readings: Mapping[str, Sequence[tuple[int, Any]]] = field(default_factory=dict)
    over_message: str = ""
    sensed: Float | None = None
    draw_addons: Callable[[Scene], None] | None = None
    prop_pose: Float = field(default_factory=lambda: np.empty((3, 0)))
    contacts: NDArray[np.void] = field(default_factory=_no_contacts)
    effort: Float = field(default_factory=lambda: np.empty(0))
    contact_log: Callable[[], NDArray[np.void]] = _no_contacts
    prop_path: Float = field(default_factory=lambda: np.empty((0, 3, 0)))
    effort_path: Float = field(default_factory=lambda: np.empty((0, 0)))
    messages: NDArray[np.void] = field(default_factory=_no_messages)
    command_path: Float = field(default_factory=lambda: np.empty((0, 2, 0)))
    message_log: Callable[[], tuple[NDArray[np.void], Sequence[str]]] = _no_message_log
    reading_path: Callable[[str, int], NDArray[Any] | None] = _no_readings

    @property
    def velocity(self) -> Float:
        """The mean velocities (3, n + p) of robots and props: x', y' [m/s], theta' [rad/s].

        Over the control step that led here, as far as it has got; 0 where that is not known.
        """
        velocity = np.zeros((3, self.pose.shape[1] + self.prop_pose.shape[1]))
        dt = self.scenario.sampling_time
        row = ceil(self.time / dt - 1e-6) - 1  # at which the control step began
        spent, n = self.time - row * dt, self.pose.shape[1]
        if 0 <= row < len(self.path):
            velocity[:, :n] = (self.pose - self.path[row]) / spent
        if 0 <= row < len(self.prop_path):
            velocity[:, n:] = (self.prop_pose - self.prop_path[row]) / spent
        return velocity


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


def floor(scenario: Scenario) -> Scene:
    """Return what the add-ons paint on the workspace, beneath the grid."""
    scene, area = Scene(), scenario.workspace or rectangle(*scenario.bounds)
    for addon in scenario.addons:
        with called(f"add-on {addon.key!r}", addon.paint):
            addon.paint(scene, area)
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
    """Return the paths so far: the robots' as the animation's wake style says, the props' thin."""
    scene = Scene()
    if len(frame.prop_path):
        for i, color in enumerate(prop_trail_colors(frame.scenario)):
            path = np.vstack([frame.prop_path[:, :2, i], frame.prop_pose[None, :2, i]])
            if np.ptp(path, axis=0).max() > 0:
                scene.line(path, stroke=color, width=PROP_TRAIL_WIDTH)
    style = frame.scenario.animation.wake_style
    for i, color in enumerate(trail_colors(frame.scenario)):
        path = np.vstack([frame.path[:, :2, i], frame.pose[None, :2, i]])
        scene.line(path, stroke=color, width=TRAIL_WIDTH, style=style)
    return scene


def trail_colors(scenario: Scenario) -> tuple[str, ...]:
    """Return the colours of the robots' paths."""
    return tuple(faded(color, 0.85) for color in scenario.colors)


def prop_trail_colors(scenario: Scenario) -> tuple[str, ...]:
    """Return the colours of the props' paths."""
    return tuple(faded(prop_edge(color), 0.6) for color in prop_colors(scenario.props))


def initial_poses(scenario: Scenario) -> Scene:
    """Return the props and robots at their starts, hollow."""
    scene = Scene()
    for prop, color in zip(scenario.props, prop_colors(scenario.props), strict=True):
        draw_prop(scene, prop, np.array(prop.pose), color, hollow=True)
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
    """Draw a robot to scale or as a point."""
    if scenario.animation.show_real_shape:
        draw_robot(scene, robot, pose, fill, stroke)
    else:
        scene.circle(pose[:2], 0.0, fill=fill, stroke=stroke, pixels=5.0)


def props(frame: Frame) -> Scene:
    """Return the props where they are, filled."""
    scene = Scene()
    listed = frame.scenario.props
    for prop, pose, color in zip(listed, frame.prop_pose.T, prop_colors(listed), strict=True):
        draw_prop(scene, prop, pose, color)
    return scene


def joints(frame: Frame) -> Scene:
    """Return what ties bodies together, where it acts: ropes, rods, springs, pins of hinges."""
    scene = Scene()
    if frame.scenario.ties and frame.scenario.physics == "contact":
        poses = np.hstack([frame.pose, frame.prop_pose])
        for tie in frame.scenario.ties:
            draw_tie(scene, tie, poses)
    return scene


def sensors(frame: Frame) -> Scene:
    """Return what the sensors see, each drawn by itself."""
    scene = Scene()
    colors = frame.scenario.colors
    sensed = frame.pose if frame.sensed is None else frame.sensed
    carried = [{sensor.key: sensor for sensor in r.sensors} for r in frame.scenario.robots]
    for key, readings in frame.readings.items():
        for i, reading in readings:
            sensor = carried[i].get(key)  # a loaded record lacks sensors of the user's own
            if sensor is not None:
                with called(f"sensor {key!r}", sensor.draw):
                    pose = sensed if sensor.stays else frame.pose
                    sensor.draw(scene, pose[:, i], reading, colors[i])
    return scene
