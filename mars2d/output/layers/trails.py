"""The paths of robots and props so far."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.colors import prop_colors
from mars2d.core.scene import Scene, faded
from mars2d.output.layers.bodies import prop_edge
from mars2d.record.frame import Frame
from mars2d.record.interventions import Leap
from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]

TRAIL_WIDTH, PROP_TRAIL_WIDTH = 1.6, 1.0
"""The width of a robot's and of a prop's path, points."""


def trails(frame: Frame) -> Scene:
    """Return the paths so far: the robots' in the animation's wake style, the props' thin.

    Props that never moved have none. A path is broken where its body was put elsewhere by hand.
    """
    scene, n = Scene(), len(frame.scenario.robots)
    if len(frame.prop_path):
        for i, color in enumerate(prop_trail_colors(frame.scenario)):
            path = np.vstack([frame.prop_path[:, :2, i], frame.prop_pose[None, :2, i]])
            if np.ptp(path, axis=0).max() > 0:
                for piece in _pieces(path, frame.leaps, n + i):
                    scene.line(piece, stroke=color, width=PROP_TRAIL_WIDTH)
    style = frame.scenario.animation.wake_style
    for i, color in enumerate(trail_colors(frame.scenario)):
        path = np.vstack([frame.path[:, :2, i], frame.pose[None, :2, i]])
        for piece in _pieces(path, frame.leaps, i):
            scene.line(piece, stroke=color, width=TRAIL_WIDTH, style=style)
    return scene


def _pieces(path: Float, leaps: Sequence[Leap], body: int) -> list[Float]:
    """Return a path (k, 2) in the pieces between a body's leaps."""
    cuts = {row for row, leaping in leaps if leaping == body}
    return [piece for piece in np.split(path, sorted(cuts)) if len(piece)]


def trail_colors(scenario: Scenario) -> tuple[str, ...]:
    """Return the colours of the robots' paths."""
    return tuple(faded(color, 0.85) for color in scenario.colors)


def prop_trail_colors(scenario: Scenario) -> tuple[str, ...]:
    """Return the colours of the props' paths."""
    return tuple(faded(prop_edge(color), 0.6) for color in prop_colors(scenario.props))
