"""A rigid body: where it is, how it moves and what has worked on it; pieces, mass, and floor."""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, length
from mars2d.physics.islands.piece import Piece


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


@cython.cclass
class RigidBody(Progress):
    """What a robot or prop is, but for its drive."""

    number: cython.int
    is_robot: cython.bint
    is_disc: cython.bint  # a single one, about the pose
    laid: cython.bint  # whether faces go on in other bodies
    mass: cython.double
    moment: cython.double  # about the centre of mass
    com: cython.double  # m, from the pose ahead to the centre of mass
    com_x: cython.double  # the same in the world, as it was last worked out
    com_y: cython.double
    radius: cython.double  # of a circle round it
    offset_x: cython.double  # from the pose to the circle's centre, in its frame
    offset_y: cython.double
    offset: cython.double
    center_x: cython.double  # where the circle's centre is
    center_y: cython.double
    reach: cython.double  # from the pose to its farthest point
    surface: object
    pieces: list[Piece]
    # the floor under a prop
    grip: cython.double  # N, its friction against sliding
    twist_grip: cython.double  # N m, and against spinning
    rest_grip: cython.double  # the same while it rests
    rest_twist_grip: cython.double
    lever: cython.double
    slows: cython.double  # m/s^2 and rad/s^2, how it slows
    stops: cython.double

    def describe(self, what: dict[str, Any]) -> None:
        """Set the properties, by the names above; those that do not apply may be left out."""
        self.mass, self.moment = what["mass"], what["moment"]
        self.com = what.get("com", 0.0)
        self.radius, self.is_disc = what["radius"], what["is_disc"]
        self.offset_x, self.offset_y = what["offset_x"], what["offset_y"]
        self.offset = length(self.offset_x, self.offset_y)
        self.reach = self.radius + self.offset
        self.lever, self.grip = what.get("lever", 0.0), what.get("grip", 0.0)
        self.twist_grip = self.grip * self.lever
        self.rest_grip = what.get("rest_grip", self.grip)
        self.rest_twist_grip = self.rest_grip * self.lever
        self.slows, self.stops = self.grip / self.mass, self.twist_grip / self.moment

    def locate(self) -> cython.void:
        """Work out where its circle and its corners are."""
        if self.is_disc:
            self.center_x, self.center_y = self.x, self.y
            return
        c, s = cosine_sine(self.angle)
        self.center_x = self.x + (c * self.offset_x - s * self.offset_y)
        self.center_y = self.y + (s * self.offset_x + c * self.offset_y)
        for piece in self.pieces:
            piece.turn(c, s)

    def lift(self) -> cython.void:
        """Forget that its faces go on in other bodies."""
        self.laid = False
        for piece in self.pieces:
            for corner in piece.corners:
                corner.ends_in = self.number if corner.ends_in == self.number else -1
                corner.starts_in = self.number if corner.starts_in == self.number else -1

    def place_com(self, angle: cython.double) -> cython.void:
        """Work out where its centre of mass lies from its pose at a heading."""
        c, s = cosine_sine(angle)
        self.com_x, self.com_y = self.com * c, self.com * s

    def kinetic_at(
        self, vx: cython.double, vy: cython.double, spin: cython.double
    ) -> cython.double:
        """Return its kinetic energy at a velocity of its centre of mass, J."""
        return 0.5 * (self.mass * (vx * vx + vy * vy) + self.moment * spin * spin)

    def account(self, vx: cython.double, vy: cython.double, spin: cython.double) -> cython.void:
        """Count the momentum gained at a velocity as work of its drive, or of the floor."""
        energy: cython.double = self.kinetic_at(vx, vy, spin)
        self.by_holder += energy - self.energy
        self.energy = energy

    def account_now(self) -> cython.void:
        """Do the same at its present velocity."""
        if self.com != 0.0:
            self.place_com(self.angle)
        x: cython.double = self.vx - self.spin * self.com_y
        self.account(x, self.vy + self.spin * self.com_x, self.spin)
