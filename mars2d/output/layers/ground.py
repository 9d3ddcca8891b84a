"""The ground of a scenario: the workspace with its edge, and the obstacles on it."""

from __future__ import annotations

from dataclasses import replace

from mars2d.bodies.colors import OBSTACLE
from mars2d.core.scene import INK, Polygon, Scene, faded
from mars2d.scenario.scenario import Scenario


def workspace(scenario: Scenario) -> Scene:
    """Return the workspace with its edge; a wall has a heavier one."""
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


def edge(scenario: Scenario) -> Scene:
    """Return the workspace's edge alone, to be drawn again over the floor and the grid."""
    shapes = workspace(scenario).shapes
    return Scene([replace(shape, fill=None) for shape in shapes if isinstance(shape, Polygon)])


def obstacles(scenario: Scenario) -> Scene:
    """Return the obstacles: areas filled, walls as lines."""
    scene = Scene()
    for outline in scenario.obstacles:
        if len(outline) == 2:
            scene.line(outline, stroke=INK, width=2.5)
        else:
            scene.polygon(outline, fill=OBSTACLE, stroke=INK, width=1.5)
    return scene
