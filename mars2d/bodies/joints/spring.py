"""A spring with a damper."""

from __future__ import annotations

import numpy as np

from mars2d.bodies.constraints import Constraint, SpringDamper
from mars2d.bodies.joints.base import STEEL, Float, Joint, beside
from mars2d.core.arithmetic import norm
from mars2d.core.description import number
from mars2d.core.scene import Scene

COILS = 9
"""The number of coils that are drawn."""


class Spring(Joint):
    """A spring with a damper beside it: the force k (length - rest length) + c (length)'."""

    rest_length: float | None = number(
        default=None, low=0, high=1e6, unit="m", optional=True,
        doc="its length without force; None: as at the start",
    )  # fmt: skip
    stiffness: float = number(default=20.0, above=0, high=1e6, unit="N/m", doc="k")
    damping: float = number(default=0.0, low=0, high=1e6, unit="N s/m", doc="c")

    def constraints(self, apart: float) -> tuple[Constraint, ...]:
        """Return a spring with a damper."""
        length = apart if self.rest_length is None else self.rest_length
        return (SpringDamper(length, stiffness=self.stiffness, damping=self.damping),)

    def draw(self, scene: Scene, start: Float, end: Float, length: float) -> None:
        """Draw the coils, closer together the shorter the spring is."""
        scene.line(_zigzag(start, end, length), stroke=STEEL, width=1.8)
        for point in (start, end):
            scene.circle(point, 0.0, fill=STEEL, pixels=3.0)


def _zigzag(start: Float, end: Float, length: float) -> Float:
    """Return a spring's coils between two short straight ends."""
    apart = float(norm(*(end - start)))
    height = 0.1 * max(length, 0.6)
    lead = min(0.1 * max(length, apart), 0.2 * apart) / max(apart, 1e-9)
    coils = lead + (1 - 2 * lead) * (np.arange(2 * COILS) + 0.5) / (2 * COILS)
    share = np.concatenate([[0.0, lead], coils, [1 - lead, 1.0]])
    side = np.concatenate([[0.0, 0.0], np.resize([height, -height], 2 * COILS), [0.0, 0.0]])
    return beside(start, end, share, side)
