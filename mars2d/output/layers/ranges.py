"""How far robots reach by radio, or see their neighbours."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.scenario.scenario import Scenario


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
