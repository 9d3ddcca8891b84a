"""The base of joints, which tie two bodies together, or one to the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.bodies.constraints import Constraint
from mars2d.core import checks
from mars2d.core.description import Description, entry, text
from mars2d.core.plane import Point
from mars2d.core.scene import Scene

__all__ = ["STEEL", "Joint", "beside"]

Float = NDArray[np.float64]

STEEL = "#52606d"
"""The colour of rods and springs."""


class Joint(Description):
    """The base of all joints.

    A joint holds a point of body `a` and a point of body `b`, or of the world. A joint of one's
    own says in `constraints` what it does to its bodies, and in `draw` how it looks. Joints act
    if ``Scenario.physics`` is "contact".
    """

    a: str = text(doc="the name of a robot or prop")
    b: str | None = text(default=None, optional=True, doc="the name of another; None: the world")
    anchor_a: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m", doc="where it holds a, in a's frame"
    )
    anchor_b: Point = entry(
        default=(0.0, 0.0), check=checks.point, unit="m",
        doc="where it holds b, in b's frame; without b, the point of the world",
    )  # fmt: skip

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return the constraints that it puts on its bodies; see `mars2d.bodies.constraints`.

        apart: the distance of its ends at the start, metres. A constraint of that distance comes
        first.
        """
        raise NotImplementedError(f"{type(self).__name__} must say what it does to its bodies")

    def draw(self, scene: Scene, start: Float, end: Float, length: float) -> None:  # noqa: ARG002
        """Draw it between its ends (2,), metres in the world; by default, as a rod.

        length: metres, that of its first constraint, 0 if this has none.
        """
        scene.line([start, end], stroke="#ffffff", width=6.0)
        scene.line([start, end], stroke=STEEL, width=4.0)
        for point in (start, end):
            scene.circle(point, 0.0, fill=STEEL, pixels=3.0)


def beside(start: Float, end: Float, share: Float, side: Float) -> Float:
    """Return points (k, 2) at shares of the way from start to end, and metres to its left."""
    along = end - start
    apart = float(np.hypot(*along))
    normal = np.array([-along[1], along[0]]) / apart if apart > 0 else np.array([0.0, 1.0])
    return np.asarray(start + share[:, None] * along + side[:, None] * normal)
