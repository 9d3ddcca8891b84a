"""Ties: joints between two bodies, or one and the world; when and how firmly they hold."""

from __future__ import annotations

from math import sqrt
from typing import Any

from mars2d.physics.islands import settings
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.chipmunk import Held


@cython.cclass
class Tie:
    """A joint. b: the second body; where there is none, the world, and a again.

    A rope holds its bodies while it is taut; others always do.
    """

    a: Body
    b: Body
    to_world: cython.bint
    anchor_ax: cython.double
    anchor_ay: cython.double
    anchor_bx: cython.double
    anchor_by: cython.double
    length: cython.double  # of a rope or rod, or a spring at rest
    is_rope: cython.bint
    always: cython.bint
    rigid: cython.bint
    pinned: cython.bint
    springy: cython.bint
    least: cython.double  # of the angle of b, or without b of a, rad
    largest: cython.double
    rebound: cython.double  # at these limits, the restitution
    parts: list[Any]  # how it is made in the solver: kind, whether turned round, three numbers
    joints: list[Held]  # there
    # as measured now
    arm_ax: cython.double
    arm_ay: cython.double
    arm_bx: cython.double
    arm_by: cython.double
    normal_x: cython.double
    normal_y: cython.double
    apart: cython.double
    slack: cython.double
    turn: cython.double
    angle: cython.double
    turning: cython.double  # rad/s, how fast the angle changes
    hits: cython.bint  # whether a rope goes taut in this substep, or a limit is reached

    def __init__(
        self,
        a: Body,
        b: Body | None,
        anchors: list[float],
        far: float,
        is_what: dict[str, bool],
        limits: list[float],
        parts: list[Any],
    ) -> None:
        """Take its bodies, its ends in their frames, its length, its nature, and its parts.

        limits: the least and the largest angle, rad, and the restitution there.
        """
        self.a, self.b, self.to_world = a, a if b is None else b, b is None
        self.anchor_ax, self.anchor_ay, self.anchor_bx, self.anchor_by = anchors
        self.length = far
        self.is_rope, self.always = is_what["is_rope"], is_what["always"]
        self.rigid, self.pinned = is_what["rigid"], is_what["pinned"]
        self.springy = is_what["springy"]
        self.least, self.largest, self.rebound = limits
        self.parts, self.joints = parts, []

    def measure(self) -> cython.void:
        """Measure where its ends are."""
        c, s = cosine_sine(self.a.angle)
        self.arm_ax = c * self.anchor_ax - s * self.anchor_ay
        self.arm_ay = s * self.anchor_ax + c * self.anchor_ay
        x: cython.double = self.anchor_bx
        y: cython.double = self.anchor_by
        self.arm_bx, self.arm_by = x, y
        if not self.to_world:
            c, s = cosine_sine(self.b.angle)
            self.arm_bx = c * x - s * y
            self.arm_by = s * x + c * y
            x = self.b.x + self.arm_bx
            y = self.b.y + self.arm_by
        x = x - (self.a.x + self.arm_ax)
        y = y - (self.a.y + self.arm_ay)
        self.apart = length(x, y)
        scale: cython.double = max(self.apart, 1e-12)
        self.normal_x, self.normal_y = x / scale, y / scale
        self.slack = self.length - self.apart if self.is_rope else 0.0

    def may_hold(self) -> cython.bint:
        """Return whether it may hold its bodies in this control step."""
        if self.always:
            return True
        way: cython.double = self.a.way + 2 * length(self.anchor_ax, self.anchor_ay)
        if not self.to_world:
            way = way + self.b.way + 2 * length(self.anchor_bx, self.anchor_by)
        return self.slack <= way

    def holds(self) -> cython.bint:
        """Return whether it holds its bodies now."""
        return self.always or self.slack <= settings.ROPE_TOLERANCE

    def time_to_jerk(self, stretch: cython.double, play: cython.double) -> cython.double:
        """Return how long a substep may be, seconds.

        Until then no rope gets longer by more than `stretch` metres, and no joint is pulled apart
        by more than `play`, since its ends go straight on instead of round.
        """
        nx: cython.double = self.normal_x
        ny: cython.double = self.normal_y
        a: Body = self.a
        b: Body = self.b
        part_x: cython.double = a.spin * self.arm_ay - a.vx
        part_y: cython.double = -a.vy - a.spin * self.arm_ax
        turn: cython.double = a.acceleration + a.spin * a.spin * length(self.arm_ax, self.arm_ay)
        if not self.to_world:
            part_x = part_x + b.vx - b.spin * self.arm_by
            part_y = part_y + b.vy + b.spin * self.arm_bx
            turn = turn + b.acceleration + b.spin * b.spin * length(self.arm_bx, self.arm_by)
        along: cython.double = part_x * nx + part_y * ny
        if self.length > 0:  # motion across a rope or rod lengthens it, too
            across: cython.double = part_x * ny - part_y * nx
            turn = turn + across * across / max(self.apart, 1e-12)
        self.turn = turn
        h: cython.double = 1e300
        if self.is_rope:
            room: cython.double = max(self.slack + stretch, stretch / 64)
            rate: cython.double = max(along, 0.0)
            h = 2 * room / (rate + sqrt(rate * rate + 2 * turn * room) + 1e-12)
        if self.slack <= settings.ROPE_TOLERANCE and self.rigid:
            # The ends of a hinge may part in any direction at the start, those of a rod along it.
            speed: cython.double = 0.0
            if self.length <= 0:
                speed = length(part_x, part_y)
            elif not self.is_rope:
                speed = abs(along)
            h = min(h, 2 * play / (speed + sqrt(speed * speed + 2 * turn * play) + 1e-12))
        return min(h, self.time_to_stop(play))

    def time_to_stop(self, play: cython.double) -> cython.double:
        """Return when bodies have turned beyond a limit by so little that no tip goes `play` m."""
        self.turning = self.a.spin
        self.angle = self.a.angle
        reach: cython.double = self.a.reach
        if not self.to_world:
            self.turning = self.b.spin - self.a.spin
            self.angle = self.b.angle - self.a.angle
            reach = max(reach, self.b.reach)
        room: cython.double = self.largest - self.angle
        if self.turning < 0.0:
            room = self.angle - self.least
        play = play / reach
        return max(room + play, play / 64) / max(abs(self.turning), 1e-300)
