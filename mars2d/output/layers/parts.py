"""One instant as scenes: the workspace, paths, bodies, sensors and add-ons, each by itself."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene, faded
from mars2d.core.usercode import called
from mars2d.output.layers.bodies import (
    INK,
    OBSTACLE,
    draw_prop,
    draw_robot,
    draw_tie,
    prop_colors,
    prop_edge,
)
from mars2d.record.frame import Frame
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario

__all__ = [
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
