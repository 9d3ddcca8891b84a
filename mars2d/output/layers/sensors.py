"""What the sensors of the robots have read."""

from __future__ import annotations

from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame

__all__ = ["sensors"]


def sensors(frame: Frame) -> Scene:
    """Return the latest readings, each as its sensor draws it."""
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
