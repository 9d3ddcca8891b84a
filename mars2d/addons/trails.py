"""The robots' last seconds, as trails that fade out behind them."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, floor

import numpy as np

from mars2d.addons.base import Addon
from mars2d.core.arithmetic import ROUNDING
from mars2d.core.description import number
from mars2d.core.interfaces import FrameLike
from mars2d.core.scene import Scene, color_of, rgb

MAX_PIECES = 12
"""The most pieces of one trail, each fainter than the one before it."""

MAX_LINES = 600
"""The most pieces in a frame: with many robots each trail has fewer, but at least one."""

MAX_POINTS = 400
"""The most points of one trail."""

STRENGTH = 0.85
"""The opacity of the colour right behind a robot; the trail ends in white."""


class Trails(Addon):
    """Draws the paths of the last seconds, which fade out behind the robots.

    >>> Trails(duration=20).key
    'trails'

    They show in the window, in figures, films and replays. ``Animation(wake=False)`` switches off
    the paths from the start on. The cost of drawing does not grow with the duration: a long trail
    has fewer points, and in a large team a trail fades in fewer steps.
    """

    duration: float = number(
        default=10.0, above=0, high=1e6, unit="s", doc="the duration of a trail"
    )
    width: float = number(
        default=2.5, above=0, high=50, unit="points", doc="width of the line, on the screen or page"
    )

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Draw the paths of the last `duration` seconds."""
        period, colors = frame.scenario.sampling_time, frame.scenario.colors
        rows = min(len(frame.path), floor(frame.time / period + ROUNDING) + 1)
        first = max(0, ceil((frame.time - self.duration) / period - ROUNDING))
        stride = 1
        while (rows - first) > stride * MAX_POINTS:
            stride *= 2
        # Multiples of the stride: so the points that are kept are the same from frame to frame.
        kept = np.arange(-(-first // stride) * stride, rows, stride)
        path = np.concatenate([frame.path[kept, :2], frame.pose[None, :2]])  # (k, 2, n)
        age = frame.time - np.append(kept * period, frame.time)
        pieces = max(1, min(MAX_PIECES, MAX_LINES // max(len(colors), 1)))
        freshness = np.clip(np.ceil((1 - age / self.duration) * pieces), 1, pieces).astype(int)
        starts = np.searchsorted(freshness, np.arange(1, pieces + 2))
        for i, color in enumerate(colors):
            for level, (start, stop) in enumerate(pairwise(starts.tolist()), 1):
                points = path[max(start - 1, 0) : stop, :, i]  # on from the last piece's end
                if start < stop and len(points) > 1:
                    scene.line(points, stroke=_pale(color, level / pieces), width=self.width)


def _pale(color: str, share: float) -> str:
    """Return a share of a colour over white: pieces of one opacity would show where they meet."""
    return color_of(1 - STRENGTH * share * (1 - value) for value in rgb(color))
