"""The fields of view of the robots' sensors, drawn in figures and films as well."""

from __future__ import annotations

from typing import Any

from mars2d.addons.base import Addon
from mars2d.core.checks import names
from mars2d.core.description import entry, wrong
from mars2d.core.errors import InputError, nearest
from mars2d.core.interfaces import FrameLike, WorldLike
from mars2d.core.scene import Scene, faded

FAR = 50.0
"""The range beyond which a field is drawn only if its sensor is named, metres."""


def _field(sensor: Any) -> tuple[float, float] | None:
    """Return range [m] and angle [rad] of a sensor that has both."""
    reach, angle = getattr(sensor, "range", None), getattr(sensor, "field_of_view", None)
    return None if reach is None or angle is None else (float(reach), float(angle))


class FieldOfView(Addon):
    """Draws the fields of view of the robots' sensors: sectors of their range and angle.

    >>> FieldOfView(sensors=["ahead"]).key
    'field_of_view'

    A sensor has the name under which laws find it in ``robot.sense``. The window shows all sensors
    and what they read; this add-on draws the fields alone, in figures, films and replays too. Walls
    do not cut them off.
    """

    sensors: tuple[str, ...] | None = entry(
        default=None,
        check=names("a list of sensors' names, such as ['range_bearing'], or None"),
        doc="the sensors' names; None: all with a range of up to 50 m",
    )

    def on_start(self, world: WorldLike) -> None:
        """Look the sensors up; raise InputError if no robot has one of such a name."""
        carried = [sensor for robot in world.scenario.robots for sensor in robot.sensors]
        known = sorted({sensor.key for sensor in carried if _field(sensor)})
        if not known:
            raise InputError("FieldOfView: no robot has a sensor with range and field_of_view")
        for name in self.sensors or ():
            if name not in known:
                expected = f"the names of sensors with a field_of_view{nearest(name, known)}"
                raise wrong("FieldOfView.sensors", list(self.sensors or ()), expected)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw a sector, or a disc, for each sensor of each robot."""
        scenario = frame.scenario
        for robot, pose, color in zip(scenario.robots, frame.pose.T, scenario.colors, strict=True):
            fill, stroke = faded(color, 0.08), faded(color, 0.45)
            for sensor in robot.sensors:
                reach, angle = _field(sensor) or (0.0, 0.0)
                shown = reach <= FAR if self.sensors is None else sensor.key in self.sensors
                if reach and shown:
                    scene.sector(sensor.placed(pose), reach, angle, fill=fill, stroke=stroke)
