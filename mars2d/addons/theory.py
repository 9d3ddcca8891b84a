"""The prediction of a formula, drawn over the run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from mars2d.addons.base import Addon
from mars2d.core.checks import function
from mars2d.core.description import entry
from mars2d.core.interfaces import FrameLike
from mars2d.core.scene import Scene


class Theory(Addon):
    """Draws the prediction of a formula, by a function of the experiment.

    >>> def circle(scene, frame):
    ...     scene.circle((0, 0), 1.91, stroke="#7b3294")
    >>> Theory(circle).key
    'theory'

    The function gets the scene to draw on and the frame, one instant: its time [s], pose (3, n) and
    the path (k, 3, n) before. It is called where theory is shown: after the key Y in a window, or
    with ``--theory``; it neither changes the run nor is it kept in a saved record.
    """

    draws: Callable[[Scene, Any], Any] = entry(
        check=lambda name, value: function(name, value, "the scene", "the frame"),
        kw_only=False,
        doc="the function: draws(scene, frame)",
    )

    def theory(self, scene: Scene, frame: FrameLike) -> None:
        """Call the function."""
        self.draws(scene, frame)
