"""What add-ons paint on the floor, draw over it, and predict."""

from __future__ import annotations

from mars2d.core.plane import Outline, rectangle
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario


def floor(scenario: Scenario) -> Scene:
    """Return the add-ons' drawings on the floor of the workspace, beneath the grid."""
    return _drawn("paint", scenario, scenario.workspace or rectangle(*scenario.bounds))


def addons(frame: Frame) -> Scene:
    """Return the add-ons' drawings, from their fields, the time and their live state."""
    scene = _drawn("draw", frame.scenario, frame)
    if frame.draw_addons is not None:
        frame.draw_addons(scene)
    return scene


def theory(frame: Frame) -> Scene:
    """Return the add-ons' drawings of theoretical predictions."""
    return _drawn("theory", frame.scenario, frame)


def _drawn(method: str, scenario: Scenario, seen: Outline | Frame) -> Scene:
    """Return what a method of all add-ons draws of what is seen."""
    scene = Scene()
    for addon in scenario.addons:
        draw = getattr(addon, method)
        with called(f"add-on {addon.key!r}", draw):
            draw(scene, seen)
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
