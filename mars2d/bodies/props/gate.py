"""A gate: a bar on a hinge."""

from __future__ import annotations

from math import pi

from mars2d.bodies.joints.base import Joint
from mars2d.bodies.joints.hinge import Hinge, turning_limits
from mars2d.bodies.props.rectangles import Bar
from mars2d.core.arithmetic import cosine_sine
from mars2d.core.description import entry, number


class Gate(Bar):
    """A bar on a hinge that is fixed to the world, at the bar's rear end.

    The pose is that of its middle. Without stiffness it stays where it was left.
    """

    ground_friction = 0.0
    limits: tuple[float, float] | None = entry(
        default=(-pi / 2, pi / 2), check=turning_limits, optional=True, unit="rad",
        doc="its range of rotation; None: unbounded",
    )  # fmt: skip
    limit_restitution: float = number(
        default=0.0, low=0, high=1, doc="at the limits: 0 stops, 1 turns back as fast"
    )
    stiffness: float = number(
        default=0.0, low=0, high=1e6, unit="N m/rad", doc="stiffness of the spring that shuts it"
    )
    damping: float = number(
        default=0.05, low=0, high=1e6, unit="N m s/rad", doc="damping of its rotation"
    )

    def joints(self) -> tuple[Joint, ...]:
        """Return the hinge."""
        x, y, theta = self.pose
        end = -self.length / 2
        c, s = cosine_sine(theta)
        return (
            Hinge(
                a=str(self.name),
                anchor_a=(end, 0.0),
                anchor_b=(x + end * c, y + end * s),
                limits=self.limits,
                limit_restitution=self.limit_restitution,
                stiffness=self.stiffness,
                damping=self.damping,
            ),
        )
