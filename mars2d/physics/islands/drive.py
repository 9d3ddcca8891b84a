"""A drive: the command of a robot, and the bounds of what moves it as commanded.

Source of the arc: that of radius v / omega seen as its chord, of length v h sinc(omega h / 2) in
the direction theta + omega h / 2.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import chord_share, cosine_sine, length
from mars2d.physics.islands.rigid import RigidBody


@cython.cclass
class DrivenBody(RigidBody):
    """A body with a drive, if it is a robot: its command is a twist, in m/s and rad/s."""

    in_robot_frame: cython.bint
    forward: cython.double
    left: cython.double
    turning: cython.double
    force: cython.double
    torque: cython.double
    rim: cython.double
    grips: cython.bint  # whether its force has other bounds than that of its motors
    no_load_speed: cython.double  # m/s, where that has fallen to nothing
    grip_ahead: cython.double  # N, what its wheels bear
    grip_across: cython.double
    wheeled: cython.bint  # whether these wheels roll ahead only
    strength: cython.double  # N, the largest force in any direction, at any speed
    bound: cython.double  # N, and in the direction and at the speed of now
    bound_ahead: cython.double  # N, that of its motors on its wheels now
    bound_across: cython.double  # N, and of what the wheels hold
    skid: cython.double  # how much more they would have to bear than they can, a factor
    limited: cython.bint  # whether its force and torque bound its acceleration in the open, too
    accelerates: cython.bint  # whether it has yet to reach its command, and nothing touches it
    acceleration: cython.double  # m/s^2, how fast its velocity may change
    aim_x: cython.double  # the velocity that it is told
    aim_y: cython.double
    aim_spin: cython.double
    end_x: cython.double  # and that which it has at the end of a substep
    end_y: cython.double
    end_spin: cython.double

    def describe_drive(self, what: dict[str, Any]) -> None:
        """Set what its drive can do, by the names above."""
        self.force, self.torque = what["force"], what["torque"]
        self.rim, self.in_robot_frame = self.radius, what["in_robot_frame"]
        self.no_load_speed, self.limited = what["no_load_speed"], what["limited"]
        self.grip_ahead, self.grip_across = what["grips"]
        self.grips = min(self.no_load_speed, self.grip_ahead, self.grip_across) < 1e300
        self.strength = self.bound = self.force
        if self.grip_across < 1e300:
            self.strength = max(min(self.force, self.grip_ahead), self.grip_across)
            self.wheeled = self.in_robot_frame

    def follow(self, angle: cython.double, h: cython.double) -> cython.void:
        """Aim a robot along its command's arc: at the velocity that leads to its end within h s.

        angle: its heading at the beginning.
        """
        half: cython.double = self.turning * (h / 2) if self.in_robot_frame else 0.0
        turned: cython.double = angle + half if self.in_robot_frame else 0.0
        share: cython.double = chord_share(half)
        c, s = cosine_sine(turned)
        c, s = share * c, share * s
        self.aim_x = self.forward * c - self.left * s
        self.aim_y = self.forward * s + self.left * c
        self.aim_spin = self.turning

    def is_told(self) -> cython.bint:
        """Return whether it is a robot that is commanded to move."""
        told: cython.bint = self.forward != 0.0 or self.left != 0.0 or self.turning != 0.0
        return self.is_robot and told

    def follows(self) -> cython.bint:
        """Return whether it is a robot that moves as it is commanded at once."""
        return self.is_robot and not self.slips and not self.limited

    def obey(self) -> cython.void:
        """Let a robot that follows its command have the velocity that it is told now."""
        if self.follows():
            self.follow(self.angle, 0.0)
            self.vx, self.vy, self.spin = self.aim_x, self.aim_y, self.aim_spin

    def go_along(self, h: cython.double) -> cython.void:
        """Aim a robot along its command's arc for h s, and work out its velocity at the end."""
        self.follow(self.angle + h * self.turning, 0.0)
        self.end_x, self.end_y, self.end_spin = self.aim_x, self.aim_y, self.aim_spin
        self.follow(self.angle, h)

    def motors(self, ahead: cython.double, speed: cython.double) -> cython.double:
        """Return the force of its motors, N, at a speed ahead, in the direction of `ahead`."""
        if speed * ahead > 0.0:
            return self.force * max(1.0 - abs(speed) / self.no_load_speed, 0.0)
        return self.force

    def force_across(self) -> cython.double:
        """Return the largest force that it bears across its heading, N."""
        return self.force if self.grip_across >= 1e300 else self.grip_across

    def set_bound(
        self,
        x: cython.double,
        y: cython.double,
        angle: cython.double,
        vx: cython.double,
        vy: cython.double,
    ) -> cython.void:
        """Work out how large its drive's force may be in a direction x, y, of any length.

        angle, vx, vy: its heading, and its velocity.

        Its motors bound the part ahead, and less the faster they turn, unless they brake. Its
        wheels bound both by an ellipse. Wheels without a grip push as hard to the side.
        """
        far: cython.double = length(x, y)
        self.bound = self.strength
        if far == 0.0:
            return
        c, s = cosine_sine(angle)
        ahead: cython.double = (c * x + s * y) / far
        across: cython.double = (c * y - s * x) / far
        motors: cython.double = self.motors(ahead, c * vx + s * vy)
        if self.grip_across >= 1e300:
            self.bound = motors
            return
        self.bound = 1.0 / length(ahead / self.grip_ahead, across / self.grip_across)
        if self.bound * abs(ahead) > motors:
            self.bound = motors / abs(ahead)

    def divide(
        self, ahead: cython.double, across: cython.double, speed: cython.double
    ) -> cython.void:
        """Bound the forces on its wheels, where it takes these two, N, to move as commanded.

        speed: its own, ahead, m/s.

        Within the ellipse each bound is what the other force leaves. Beyond it wheels skid, and
        their force opposes their slip, unless motors are weaker: then they roll.
        """
        motors: cython.double = self.motors(ahead, speed)
        a: cython.double = abs(ahead) / self.grip_ahead
        b: cython.double = abs(across) / self.grip_across
        off: cython.double = max(length(a, b), 1.0)
        self.skid = off
        a, b = min(a / off, motors / self.grip_ahead), b / off
        self.bound_across = self.grip_across * sqrt(max(1.0 - a * a, 0.0))
        self.bound_ahead = min(motors, self.grip_ahead * sqrt(max(1.0 - b * b, 0.0)))

    def time_to_brake(self, turned: cython.double) -> cython.double:
        """Return when its drive stops the spin that a blow has given a robot: there a substep ends.

        It has a lower bound, in which its rim turns by `turned`, too little to be seen.
        """
        spin: cython.double = abs(self.spin - self.turning)
        moment: cython.double = self.moment + self.mass * self.com * self.com
        return max(spin * moment / self.torque, turned / max(spin * self.rim, 1e-300))

    def out_of_reach(self, h: cython.double) -> cython.bint:
        """Return whether its drive can't bring it back to its command within h seconds."""
        self.follow(self.angle, h)
        if self.com != 0.0:
            return self.takes_more(h)
        off: cython.double = length(self.vx - self.aim_x, self.vy - self.aim_y)
        if self.grips:
            self.set_bound(self.aim_x - self.vx, self.aim_y - self.vy, self.angle, self.vx, self.vy)
        if off * self.mass > self.bound * h:
            return True
        return abs(self.spin - self.turning) * self.moment > self.torque * h

    def takes_more(self, h: cython.double) -> cython.bint:
        """Do `out_of_reach` for one whose drive acts beside its centre of mass.

        The impulse J and the angular impulse that its drive has to give change the velocity of the
        centre by J / m, and the spin by (angular impulse - r x J) / I, with r from pose to centre.
        """
        self.place_com(self.angle)
        x: cython.double = self.com_x
        y: cython.double = self.com_y
        spin: cython.double = self.turning - self.spin
        push_x: cython.double = self.mass * (self.aim_x - self.vx - spin * y)
        push_y: cython.double = self.mass * (self.aim_y - self.vy + spin * x)
        if self.grip_across < 1e300:
            self.set_bound(push_x, push_y, self.angle, self.vx, self.vy)
        if length(push_x, push_y) > self.bound * h:
            return True
        return abs(self.moment * spin + x * push_y - y * push_x) > self.torque * h

    def look_ahead(self) -> cython.void:
        """Do `look` for such a robot: it moves as it has come to, whatever it is commanded."""
        self.follow(self.angle, 0.0)
        self.accelerates = self.vx != self.aim_x or self.vy != self.aim_y or self.lags(self.spin)
        if not self.accelerates:
            self.acceleration = self.pull_on_arc(self.turning) / self.mass
            return
        self.acceleration = self.strength / self.mass
        if self.spin != self.turning:
            self.acceleration += self.torque / self.moment * self.reach

    def pull_on_arc(self, spin: cython.double) -> cython.double:
        """Return the force that holds it on its command's arc at a spin, N."""
        if not self.in_robot_frame:
            return 0.0
        return self.mass * abs(length(self.forward, self.left) * spin)

    def is_flung(self, spin: cython.double) -> cython.bint:
        """Return whether its force can't hold it on its command's arc."""
        most: cython.double = self.force_across()
        return self.pull_on_arc(max(abs(spin), abs(self.turning))) > most * (1 + 1e-9)

    def lags(self, spin: cython.double) -> cython.bint:
        """Return whether a robot of this spin, and of the speed commanded, can't keep it up."""
        return spin != self.turning or self.is_flung(spin)

    def time_to_turn(self, deep: cython.double) -> cython.double:
        """Return for how long its corners stay within `deep` metres of its present spin."""
        if self.is_disc or not self.accelerates or self.spin == self.turning:
            return 1e300
        return sqrt(2 * deep * self.moment / (self.torque * self.reach))
