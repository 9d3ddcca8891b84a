"""The fields of view of the robots' sensors, drawn in figures and films as well."""

from __future__ import annotations

from mars2d.addons.base import Addon
from mars2d.core.interfaces import FrameLike
from mars2d.core.scene import Scene, faded

FAR = 50.0
"""The range beyond which a field is not drawn, metres."""


class FieldOfView(Addon):
    """Draws the fields of view of the robots' sensors: sectors of their range and angle.

    The window shows all sensors and what they read; this add-on draws the fields alone, in figures,
    films and replays too. Walls do not cut them off. Ranges above 50 m are left out.
    """

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw a sector, or a disc, for each sensor of each robot that has range and angle."""
        scenario = frame.scenario
        for robot, pose, color in zip(scenario.robots, frame.pose.T, scenario.colors, strict=True):
            fill, stroke = faded(color, 0.08), faded(color, 0.45)
            for sensor in robot.sensors:
                reach = getattr(sensor, "range", FAR + 1)
                if reach <= FAR and hasattr(sensor, "field_of_view"):
                    scene.sector(
                        sensor.placed(pose), reach, sensor.field_of_view, fill=fill, stroke=stroke
                    )
