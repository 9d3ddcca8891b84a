"""Links between robots that are neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Line, Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Everyone

__all__ = ["LINK", "Links", "neighbours"]

LINK = "#aab1b9"
"""The colour of a link, opaque: hundreds of long faint lines would be slow to draw."""

MAX_LINKS = 600
"""Of more links in a frame, the first are drawn."""


class Links:
    """Return a line between neighbours, none where all robots are neighbours of each other.

    The rule of the neighbourhood is asked once a control step.
    """

    def __init__(self) -> None:
        """Start with nothing asked."""
        self._asked: tuple[object, ...] = ()
        self._pairs = np.empty((0, 2), dtype=int)

    def __call__(self, frame: Frame) -> Scene:
        """Return the links of a frame."""
        ends = frame.pose[:2].T[self._pairs_of(frame)]  # (k, 2, 2)
        return Scene([Line(pair, LINK) for pair in ends])

    def _pairs_of(self, frame: Frame) -> NDArray[np.int_]:
        """Return the pairs (k, 2) that are linked."""
        rule = frame.scenario.neighbours
        asked = frame.scenario, len(frame.path), rule.fixed
        if self._asked[:1] == asked[:1] and (rule.fixed or self._asked == asked):
            return self._pairs
        self._asked = asked
        pairs: set[tuple[int, int]] = set()
        if not isinstance(rule, Everyone):
            position = frame.pose[:2] if frame.sensed is None else frame.sensed[:2]
            with called("Scenario.neighbours", rule.of):
                found = rule.of(position)
            pairs = {(min(i, j), max(i, j)) for i, row in enumerate(found) for j in row}
        self._pairs = np.array(sorted(pairs)[:MAX_LINKS], dtype=int).reshape(-1, 2)
        return self._pairs


neighbours = Links()
"""The layer of links; it remembers the answer of the last frame's neighbourhood."""
