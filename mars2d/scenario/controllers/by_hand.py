"""A robot that a person drives."""

from __future__ import annotations

from typing import Any, ClassVar

from mars2d.scenario.controllers.base import Command, Controller, still


class ByHand(Controller):
    """Waits for a person: the window lets you drive it at once, by keys or a game controller.

    Without a window, and when nobody drives it, it stands still.
    """

    title: ClassVar[str] = "driven by hand"

    def __call__(self, robot: Any) -> Command:
        """Return the command to stand still."""
        return still(robot.drive)
