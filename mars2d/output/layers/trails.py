"""The paths of robots and props so far."""

from __future__ import annotations

import numpy as np

from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import prop_colors, prop_edge
from mars2d.record.frame import Frame
from mars2d.scenario.scenario import Scenario

__all__ = ["PROP_TRAIL_WIDTH", "TRAIL_WIDTH", "prop_trail_colors", "trail_colors", "trails"]

TRAIL_WIDTH, PROP_TRAIL_WIDTH = 1.6, 1.0
"""The width of a robot's and of a prop's path, points."""


def trails(frame: Frame) -> Scene:
    """Return the paths so far: the robots' in the animation's wake style, the props' thin.

    Props that have never moved have none.
    """
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
