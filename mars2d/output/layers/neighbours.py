"""Links between robots that are neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.core.scene import Line, Scene
from mars2d.core.usercode import called
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Everyone

LINK = "#aab1b9"
"""The colour of a link, opaque: hundreds of long faint lines would be slow to draw."""

MAX_LINKS = 600
"""Of more links in a frame, the first are drawn."""


class Links:
    """Return a line between neighbours, none where all robots are neighbours of each other.

    The last answer is kept, so the rule of the neighbourhood is asked once a control step.
    """

    def __init__(self) -> None:
        """Start with nothing asked."""
        self._asked: tuple[Frame, NDArray[np.int_]] | None = None

    def __call__(self, frame: Frame) -> Scene:
        """Return the links of a frame."""
        asked = self._asked  # replaced as a whole: frames may be drawn in several threads
        if asked is None or not _same_neighbours(asked[0], frame):
            self._asked = asked = frame, _linked(frame)
        ends = frame.pose[:2].T[asked[1]]  # (k, 2, 2)
        return Scene([Line(pair, LINK) for pair in ends])


def _sensed(frame: Frame) -> NDArray[np.float64]:
    """Return the poses (3, n) at the last control step."""
    return frame.pose if frame.sensed is None else frame.sensed


def _same_neighbours(one: Frame, other: Frame) -> bool:
    """Return whether two frames show the same control step of a run, or a graph that is fixed."""
    same_step = _sensed(one) is _sensed(other) and len(one.path) == len(other.path)
    return one.scenario is other.scenario and (one.scenario.neighbours.fixed or same_step)


def _linked(frame: Frame) -> NDArray[np.int_]:
    """Return the pairs (k, 2) of neighbours at the last control step."""
    rule, pairs = frame.scenario.neighbours, set()
    if not isinstance(rule, Everyone):
        with called("Scenario.neighbours", rule.of):
            found = rule.of(_sensed(frame)[:2])
        pairs = {(min(i, j), max(i, j)) for i, row in enumerate(found) for j in row}
    return np.array(sorted(pairs)[:MAX_LINKS], dtype=int).reshape(-1, 2)


neighbours = Links()
"""The layer of links."""
