"""Links between robots that are neighbours, and how far they reach by radio or see each other."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Line, Scene, faded
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Everyone
from mars2d.scenario.scenario import Scenario

LINK = "#aab1b9"
"""The colour of a link, opaque: hundreds of long faint lines would be slow to draw."""

MAX_LINKS = 600
"""Of more links in a frame, the first are drawn."""


def neighbours(frame: Frame) -> Scene:
    """Return a line between neighbours at the last control step, none where all robots are."""
    rule, pairs = frame.scenario.neighbours, set()
    if not isinstance(rule, Everyone):
        sensed = frame.pose if frame.sensed is None else frame.sensed
        with called("Scenario.neighbours", rule.of):
            found = rule.of(sensed[:2])
        pairs = {(min(i, j), max(i, j)) for i, row in enumerate(found) for j in row}
    places = frame.pose[:2].T
    return Scene([Line(places[list(pair)], LINK) for pair in sorted(pairs)[:MAX_LINKS]])


def range_of(scenario: Scenario) -> float | None:
    """Return how far robots hear each other, else how far neighbours are apart, metres.

    None where neither has a bound.
    """
    radios = [addon for addon in scenario.addons if addon.carries_messages]
    for source in (*radios, scenario.neighbours):
        reach: Any = getattr(source, "range", None)
        if reach is not None and reach < inf:
            return float(reach)
    return None


def place_range(scene: Scene, scenario: Scenario, body: int, pose: NDArray[np.float64]) -> None:
    """Draw a faint circle, as far as a body's radio reaches, at a pose (3,), if it is a robot.

    body: its index in `Scenario.bodies`.
    """
    reach = range_of(scenario)
    if reach is not None and body < len(scenario.robots):
        scene.circle(pose[:2], reach, stroke=faded(scenario.colors[body], 0.5), width=1.0)
