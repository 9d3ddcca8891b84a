"""Links between robots that are neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Line, Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Everyone, Neighbourhood

__all__ = ["LINK", "Links", "neighbours"]

LINK = "#aab1b9"
"""The colour of a link, opaque: hundreds of long faint lines would be slow to draw."""

MAX_LINKS = 600
"""Of more links in a frame, the first are drawn."""


class Links:
    """Return a line between neighbours, none where all robots are neighbours of each other.

    The last answer of a neighbourhood is kept for the same positions, so a picture that is drawn
    again does not ask the rule again.
    """

    def __init__(self) -> None:
        """Start with nothing asked."""
        self._last: tuple[object, object, NDArray[np.int_]] | None = None

    def __call__(self, frame: Frame) -> Scene:
        """Return the links of a frame."""
        ends = frame.pose[:2].T[self._pairs_of(frame)]  # (k, 2, 2)
        return Scene([Line(pair, LINK) for pair in ends])

    def _pairs_of(self, frame: Frame) -> NDArray[np.int_]:
        """Return the pairs (k, 2) that are linked."""
        rule = frame.scenario.neighbours
        sensed = frame.pose if frame.sensed is None else frame.sensed
        last = self._last  # replaced as a whole: frames may be drawn in several threads
        if last is not None and last[0] is frame.scenario and (rule.fixed or last[1] is sensed):
            return last[2]
        found = _linked(rule, sensed[:2])
        self._last = frame.scenario, sensed, found
        return found


def _linked(rule: Neighbourhood, position: NDArray[np.float64]) -> NDArray[np.int_]:
    """Return the pairs (k, 2) of neighbours at positions (2, n)."""
    pairs: set[tuple[int, int]] = set()
    if not isinstance(rule, Everyone):
        with called("Scenario.neighbours", rule.of):
            found = rule.of(position)
        pairs = {(min(i, j), max(i, j)) for i, row in enumerate(found) for j in row}
    return np.array(sorted(pairs)[:MAX_LINKS], dtype=int).reshape(-1, 2)


neighbours = Links()
"""The layer of links."""
