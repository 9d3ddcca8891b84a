"""What add-ons paint on the floor, draw over it, and predict."""

from __future__ import annotations

from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario


def floor(scenario: Scenario) -> Scene:
    """Return the add-ons' drawings on the floor of the workspace, beneath the grid."""
    scene, area = Scene(), scenario.workspace or rectangle(*scenario.bounds)
    for addon in scenario.addons:
        with called(f"add-on {addon.key!r}", addon.paint):
            addon.paint(scene, area)
    return scene


def addons(frame: Frame) -> Scene:
    """Return the add-ons' drawings, from their fields, the time and their live state."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.draw):
            addon.draw(scene, frame)
    if frame.draw_addons is not None:
        frame.draw_addons(scene)
    return scene


def theory(frame: Frame) -> Scene:
    """Return the add-ons' drawings of theoretical predictions."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.theory):
            addon.theory(scene, frame)
    return scene


def sensors(frame: Frame) -> Scene:
    """Return the latest readings, each as its sensor draws it, from where it was measured."""
    scene = Scene()
    colors = frame.scenario.colors
    carried = [{sensor.key: sensor for sensor in r.sensors} for r in frame.scenario.robots]
    for key, readings in frame.readings.items():
        for i, reading in readings:
            sensor = carried[i].get(key)  # a loaded record lacks sensors of the user's own
            if sensor is not None:
                with called(f"sensor {key!r}", sensor.draw):
                    sensor.draw(scene, frame.measured(sensor)[:, i], reading, colors[i])
    return scene
