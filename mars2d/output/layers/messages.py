"""Messages as links between robots: how far each has got, and which are lost."""

from __future__ import annotations

from math import hypot, sqrt

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Scene, faded
from mars2d.record.frame import Frame
from mars2d.record.message import DELIVERED, ON_ITS_WAY

LOST_LINK = "#c92a2a"
"""The colour of a link over which nothing gets through."""

MAX_LINKS = 400
"""Of more links in a frame, the last are drawn."""

ASIDE = 0.3
"""How far a link lies right of the line between two centres, in radii: both ways can be seen."""

WIDTH = 2.2  # points
COMET = 0.35  # length of a message, in shares of its link
CROSS = 0.5  # of the smaller robot's radius


def messages(frame: Frame) -> Scene:
    """Return the links of the messages that were under way in the step that led to a frame.

    A link is a faint line from rim to rim in the sender's colour. The message is an arrow on it, as
    far as it has got: when it arrives, at the receiver. Over a red broken line with a cross nothing
    gets through.
    """
    scene = Scene()
    robots, colors = frame.scenario.robots, frame.scenario.colors
    for row in frame.messages[-MAX_LINKS:]:
        one, other = int(row["sender"]), int(row["receiver"])
        sizes = robots[one].radius, robots[other].radius
        ends = _ends(frame.pose[:2, one].tolist(), frame.pose[:2, other].tolist(), sizes)
        if ends is None:
            continue
        tail, tip = ends
        if row["status"] in (ON_ITS_WAY, DELIVERED):
            scene.line([tail, tip], stroke=faded(colors[one], 0.5), width=WIDTH / 2)
            sent, arrival = float(row["time"]), float(row["arrival"])
            share = min(max((frame.time - sent) / (arrival - sent), 0.0), 1.0)
            way = max(share - COMET, 0.0), share
            start, head = (tail + part * (tip - tail) for part in way)
            scene.arrow(start, head, fill=faded(colors[one], 0.9), width=WIDTH)
        else:
            scene.line([tail, tip], stroke=faded(LOST_LINK, 0.75), width=WIDTH / 2, style="--")
            length = float(np.hypot(*(tip - tail)))
            size = min(CROSS * min(sizes), length / 4)
            center = tail + 0.6 * (tip - tail)
            scene.cross(center, sqrt(0.5) * size, stroke=LOST_LINK, width=WIDTH)
    return scene


def _ends(
    one: list[float], other: list[float], sizes: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return where a link between two centres begins and ends, at their rims; None if too near."""
    dx, dy = other[0] - one[0], other[1] - one[1]
    apart = hypot(dx, dy)
    if apart <= sum(sizes):
        return None
    ahead = np.array([dx, dy]) / apart
    aside = ASIDE * min(sizes) * np.array([ahead[1], -ahead[0]])
    return np.array(one) + sizes[0] * ahead + aside, np.array(other) - sizes[1] * ahead + aside
