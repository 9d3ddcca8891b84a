"""The state of a body: what changes as it moves, and what it has been given since the beginning."""

from __future__ import annotations

from mars2d.physics.islands import shadow as cython


@cython.cclass
class State:
    """A pose and its rates: metres, rad, m/s, rad/s."""

    x: cython.double
    y: cython.double
    angle: cython.double
    vx: cython.double
    vy: cython.double
    spin: cython.double

    def go_to(self, other: State) -> cython.void:
        """Take the pose and the rates of another."""
        self.x, self.y, self.angle = other.x, other.y, other.angle
        self.vx, self.vy, self.spin = other.vx, other.vy, other.spin


@cython.cclass
class Progress(State):
    """All that a control step changes, and that it begins with once more if it is repeated."""

    slips: cython.bint  # whether it was thrown off its command, and has not come back to it
    since: cython.int  # substeps since it slipped
    effort: cython.double  # the largest share of its drive's bounds that was used
    energy: cython.double  # J, its kinetic energy as far as it has been accounted for
    # work since the beginning, J: of its drive, or of the floor under it; of pushes and of friction
    # of contacts that are counted for it; of its joints; of pulls from outside
    by_holder: cython.double
    by_push: cython.double
    by_friction: cython.double
    by_joint: cython.double
    by_hand: cython.double

    def begin_with(self, other: Progress) -> cython.void:
        """Take all of another."""
        self.go_to(other)
        self.slips, self.since, self.effort = other.slips, other.since, other.effort
        self.energy, self.by_holder, self.by_push = other.energy, other.by_holder, other.by_push
        self.by_friction, self.by_joint, self.by_hand = (
            other.by_friction,
            other.by_joint,
            other.by_hand,
        )
