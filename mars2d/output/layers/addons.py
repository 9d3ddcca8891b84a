"""What add-ons paint on the floor, draw over it, and predict."""

from __future__ import annotations

from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

__all__ = ["addons", "floor", "theory"]


def floor(scenario: Scenario) -> Scene:
    """Return what the add-ons paint on the workspace, beneath the grid."""
    scene, area = Scene(), scenario.workspace or rectangle(*scenario.bounds)
    for addon in scenario.addons:
        with called(f"add-on {addon.key!r}", addon.paint):
            addon.paint(scene, area)
    return scene


def addons(frame: Frame) -> Scene:
    """Return what the add-ons draw, from their fields and the time, and from their live state."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.draw):
            addon.draw(scene, frame)
    if frame.draw_addons is not None:
        frame.draw_addons(scene)
    return scene


def theory(frame: Frame) -> Scene:
    """Return what the add-ons draw of theory's predictions."""
    scene = Scene()
    for addon in frame.scenario.addons:
        with called(f"add-on {addon.key!r}", addon.theory):
            addon.theory(scene, frame)
    return scene
