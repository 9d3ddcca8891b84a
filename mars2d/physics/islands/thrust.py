"""Thrust: how a robot moves in the open whose drive's force bounds its acceleration there, too.

Its velocity v goes towards the commanded one, c, as quickly as the force F lets its mass m: v' =
(F / m) (c - v) / |c - v|. Its spin goes towards the commanded one at torque / moment. Once it has
both it follows its command, as long as F can hold it on its arc, whose velocity turns at |c| omega.

While c stands still, and while the command is followed, this has a closed form. Else c turns with
the heading, and v is stepped by the midpoint rule, in parts in which c turns by little.
"""

from __future__ import annotations

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.floor import Glide


@cython.cclass
class Thrust:
    """A robot under way to its command."""

    # where it has got to: since the beginning, metres; and its velocity
    way_x: cython.double
    way_y: cython.double
    angle: cython.double
    vx: cython.double
    vy: cython.double
    spin: cython.double
    # what its drive can do, m/s^2 and rad/s^2
    quickens: cython.double
    turns: cython.double
    keeps: cython.bint  # whether it moves as commanded
    bent: cython.bint  # whether the commanded velocity turns
    saturated: cython.bint  # whether its drive does all that it can

    def over(self, body: Body, h: cython.double) -> cython.void:
        """Aim a robot at where it will be after h seconds, and work out its velocity then."""
        self.begin(body)
        gone: cython.double = 0.0
        fine: cython.double = h
        if self.bent:
            fine = max(0.01 / max(abs(body.spin), abs(body.turning)), h / 4096)
        if body.no_load_speed < 1e300:
            fine = max(min(fine, 0.02 * body.mass * body.no_load_speed / body.force), h / 4096)
        count: cython.int = 0
        while gone < h:
            part = h - gone
            count += 1
            if (self.keeps and not body.lags(self.spin)) or count > 16384:
                self.follow(body, part)
                break
            gone += self.advance(body, min(part, fine))
        if self.saturated:
            body.effort = 1.0
        elif body.limited:
            share: cython.double = body.pull_on_arc(body.turning) / body.force_across()
            body.effort = max(body.effort, share)
        body.aim_x, body.aim_y = self.way_x / h, self.way_y / h
        body.aim_spin = (self.angle - body.angle) / h
        body.end_x, body.end_y, body.end_spin = self.vx, self.vy, self.spin
        body.accelerates = not self.keeps or body.lags(self.spin)

    def begin(self, body: Body) -> cython.void:
        """Take a robot as it is now."""
        self.way_x = self.way_y = 0.0
        self.angle, self.vx, self.vy, self.spin = body.angle, body.vx, body.vy, body.spin
        self.quickens, self.turns = body.force / body.mass, body.torque / body.moment
        body.follow(body.angle, 0.0)
        self.keeps = body.vx == body.aim_x and body.vy == body.aim_y
        self.bent = body.in_robot_frame and (body.spin != 0.0 or body.turning != 0.0)
        moves: cython.bint = body.wheeled and (body.vx != 0.0 or body.vy != 0.0)
        self.bent = self.bent and (moves or body.forward != 0.0 or body.left != 0.0)
        self.saturated = False

    def follow(self, body: Body, part: cython.double) -> cython.void:
        """Go along the command's arc for a part of the time."""
        body.follow(self.angle, part)
        self.way_x += part * body.aim_x
        self.way_y += part * body.aim_y
        self.angle += part * body.aim_spin
        self.spin = body.turning
        self.take_command(body)

    def take_command(self, body: Body) -> cython.void:
        """Take the velocity that is commanded at its heading."""
        body.follow(self.angle, 0.0)
        self.vx, self.vy = body.aim_x, body.aim_y

    def advance(self, body: Body, part: cython.double) -> cython.double:
        """Go on for a part of the time, or until spin or velocity is reached; return how long."""
        lack: cython.double = body.turning - self.spin
        rate: cython.double = 0.0
        meets: cython.bint = False
        if lack != 0.0:
            self.saturated = True
            rate = self.turns if lack > 0.0 else -self.turns
            meets = lack / rate <= part
        if meets:
            part = lack / rate
        if self.keeps and not body.is_flung(self.spin):
            self.keep_up(body, part, rate)
        else:
            took: cython.double = self.gain(body, part, rate)
            meets = meets and took == part
            part = took
        self.angle += part * (self.spin + rate * part / 2)
        self.spin = body.turning if meets else self.spin + rate * part
        if self.keeps:
            self.take_command(body)
        return part

    def keep_up(self, body: Body, part: cython.double, rate: cython.double) -> cython.void:
        """Move as commanded, while the spin changes at a rate. Source: Simpson's rule."""
        body.follow(self.angle + part / 2 * (self.spin + rate * part / 4), 0.0)
        x: cython.double = self.vx + 4 * body.aim_x
        y: cython.double = self.vy + 4 * body.aim_y
        body.follow(self.angle + part * (self.spin + rate * part / 2), 0.0)
        self.way_x += part / 6 * (x + body.aim_x)
        self.way_y += part / 6 * (y + body.aim_y)

    def limit_force(
        self, body: Body, x: cython.double, y: cython.double, part: cython.double
    ) -> cython.void:
        """Take the acceleration that motors and wheels can give towards x, y, half-way through."""
        body.set_bound(x, y, self.angle, self.vx, self.vy)
        share: cython.double = min(
            0.5 * part * body.bound / body.mass / max(length(x, y), 1e-300), 1.0
        )
        body.set_bound(x, y, self.angle, self.vx + share * x, self.vy + share * y)
        self.quickens = body.bound / body.mass

    def gain(self, body: Body, part: cython.double, rate: cython.double) -> cython.double:
        """Go towards the commanded velocity; return for how long, at most the part."""
        self.saturated = True
        body.follow(self.angle + part * (self.spin + rate * part / 2), 0.0)
        x: cython.double = body.aim_x - self.vx
        y: cython.double = body.aim_y - self.vy
        if body.grips:
            self.limit_force(body, x, y, part)
        most: cython.double = self.quickens * part
        off: cython.double = length(x, y)
        self.keeps = off <= most
        if self.keeps:
            part = off / max(self.quickens, 1e-300)
        elif body.wheeled:
            self.roll(body, part, part * (self.spin + rate * part / 2))
            return part
        else:
            body.follow(self.angle + part / 2 * (self.spin + rate * part / 4), 0.0)
            x, y = body.aim_x - self.vx, body.aim_y - self.vy
            share: cython.double = most / 2 / max(length(x, y), 1e-300)
            middle_x: cython.double = body.aim_x - (self.vx + share * x)
            middle_y: cython.double = body.aim_y - (self.vy + share * y)
            share = most / max(length(middle_x, middle_y), 1e-300)
            x, y = share * middle_x, share * middle_y
        self.way_x += part * (self.vx + x / 2)
        self.way_y += part * (self.vy + y / 2)
        self.vx += x
        self.vy += y
        return part

    def roll(self, body: Body, part: cython.double, turn: cython.double) -> cython.void:
        """Do so for wheels, which its motors drive ahead, and which hold it across if they can.

        turn: rad, by how much it turns. `aim` is the velocity that is commanded at the end. Forces
        along and across its heading half-way turn its velocity as it turns.
        """
        c, s = cosine_sine(self.angle + turn / 2)
        near, aside = cosine_sine(turn / 2)
        x: cython.double = body.aim_x - self.vx
        y: cython.double = body.aim_y - self.vy
        rate: cython.double = body.mass / part
        speed: cython.double = c * self.vx + s * self.vy
        lack: cython.double = c * x + s * y
        hold: cython.double = c * y - s * x
        body.divide(rate * lack, rate * hold, speed)
        push: cython.double = within(lack, body.bound_ahead / rate)
        slip_x: cython.double = lack
        slip_y: cython.double = hold
        if body.skid > 2.0:  # slip changes by little: its mean gives the direction
            slip_x = 2 * (lack + aside * body.left) - push
            slip_y = 2 * (hold - aside * body.forward) - within(hold, body.bound_across / rate)
        body.divide(rate * slip_x, rate * slip_y, speed + push / 2)
        push = within(lack, body.bound_ahead / rate)
        hold -= (lack - push) * aside / max(near, 0.1)
        most: cython.double = body.bound_across / rate
        hold = within(hold, most)
        share: cython.double = 0.5
        if not self.bent and most > 0.0:  # it stops to skid within the part
            share = 1.0 - 0.5 * abs(hold) / most
        self.way_x += part * (self.vx + c * push / 2 - s * hold * share)
        self.way_y += part * (self.vy + s * push / 2 + c * hold * share)
        self.vx += c * push - s * hold
        self.vy += s * push + c * hold


def predict(body: Body, h: cython.double, glide: Glide, thrust: Thrust) -> cython.void:
    """Aim a body at where it will be after h s if nothing touches it, in closed form."""
    if not body.is_robot:
        glide.over(body, h)
    elif body.follows():
        body.go_along(h)
    else:
        thrust.over(body, h)


def within(x: cython.double, most: cython.double) -> cython.double:
    """Return the number nearest to x that is no larger than a bound."""
    return min(max(x, -most), most)
