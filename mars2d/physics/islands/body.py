"""A body in motion: a robot or prop, with its drive and its friction on the floor."""

from __future__ import annotations

from math import sqrt
from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import chord_share, cosine_sine, length
from mars2d.physics.islands.chipmunk import Handle


@cython.final
@cython.cclass
class Corner:
    """A corner of a piece: in the frame of its body, and from there, turned as the body is."""

    local_x: cython.double
    local_y: cython.double
    x: cython.double
    y: cython.double
    lever: cython.double
    ends_in: cython.int  # the number of the body in which the face that ends here goes on, or -1
    starts_in: cython.int  # and that which starts here

    def __init__(self, x: float, y: float) -> None:
        """Take its place in the frame of its body, metres."""
        self.ends_in = self.starts_in = -1
        self.local_x = self.x = x
        self.local_y = self.y = y
        self.lever = length(x, y)


@cython.final
@cython.cclass
class Edge:
    """A direction in which a piece may be parted from another, and an edge across it.

    reach: how far the piece extends in this direction from the body's pose, metres.
    """

    local_x: cython.double
    local_y: cython.double
    x: cython.double
    y: cython.double
    reach: cython.double

    def __init__(self, x: float, y: float, reach: float) -> None:
        """Take the direction, a unit vector in the frame of its body."""
        self.local_x = self.x = x
        self.local_y = self.y = y
        self.reach = reach


@cython.final
@cython.cclass
class Piece:
    """A convex piece of a body or wall: the hull of its corners, enlarged by a radius."""

    corners: list[Corner]
    edges: list[Edge]
    radius: cython.double
    shape: Handle  # the engine's
    flush: object  # what the engine knows by its address

    def __init__(self, corners: list[Any], directions: list[Any], radius: float) -> None:
        """Take corners (x, y) counter-clockwise, directions (x, y) in which it ends, a radius."""
        self.corners = [Corner(x, y) for x, y in corners]
        self.edges = [Edge(u, v, max([u * x + v * y for x, y in corners])) for u, v in directions]
        self.radius = radius

    @cython.cfunc
    def turn(self, c: cython.double, s: cython.double) -> cython.void:
        """Turn it by an angle of this cosine and sine from its body's frame."""
        corner: Corner
        edge: Edge
        for corner in self.corners:
            corner.x = c * corner.local_x - s * corner.local_y
            corner.y = s * corner.local_x + c * corner.local_y
        for edge in self.edges:
            edge.x = c * edge.local_x - s * edge.local_y
            edge.y = s * edge.local_x + c * edge.local_y


@cython.final
@cython.cclass
class Body:
    """A robot or prop. SI units; "now" is within the present substep, unless it says otherwise."""

    # what it is
    number: cython.int
    is_robot: cython.bint
    is_disc: cython.bint  # a single one, about the pose
    laid: cython.bint  # whether faces go on in other bodies
    mass: cython.double
    moment: cython.double  # about the centre of mass
    lead: cython.double  # m, from the pose ahead to the centre of mass
    radius: cython.double  # of a circle round it
    offset_x: cython.double  # from the pose to the circle's centre, in its frame
    offset_y: cython.double
    offset: cython.double
    reach: cython.double  # from the pose to its farthest point
    surface: object
    pieces: list[Piece]
    # how it moves
    x: cython.double
    y: cython.double
    angle: cython.double
    vx: cython.double
    vy: cython.double
    spin: cython.double
    slips: cython.bint  # whether it was thrown off its command, and has not come back to it
    solved: cython.bint  # whether the solver decides how it moves in this substep
    # where the circle's centre is
    center_x: cython.double
    center_y: cython.double
    # the robot's command, as a twist; and its drive
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
    tread_ahead: cython.double  # N, what they have borne in the last substep
    tread_across: cython.double
    limited: cython.bint  # whether its force and torque bound its acceleration in the open, too
    gathers: cython.bint  # whether it has yet to reach its command, and nothing touches it
    since: cython.int  # substeps since it slipped
    holds: cython.bint  # whether the drive is to act in the next substep
    engaged: cython.bint  # whether it does
    effort: cython.double
    # the floor under a prop
    grip: cython.double  # N, its friction against sliding
    twist_grip: cython.double  # N m, and against spinning
    rest_grip: cython.double  # the same while it rests
    rest_twist_grip: cython.double
    lever: cython.double
    slows: cython.double  # m/s^2 and rad/s^2, how it slows
    stops: cython.double
    allowed: cython.double  # N and N m that the floor may use now
    twist_allowed: cython.double
    held: cython.double  # N and N m that it has used in the last substep
    twist_held: cython.double
    # a pull from outside
    pulled: cython.bint
    pull_x: cython.double
    pull_y: cython.double
    pull_torque: cython.double
    pull_turn: cython.double  # N m, its torque about the centre of mass
    # what the next substep is worked out from
    touches: cython.bint
    stopped: cython.bint
    bend: cython.double  # m/s^2, how fast its velocity may change
    aim_x: cython.double  # the velocity that it is told
    aim_y: cython.double
    aim_spin: cython.double
    lead_x: cython.double  # from its pose to its centre of mass
    lead_y: cython.double
    end_x: cython.double  # a gliding prop's velocity at the end
    end_y: cython.double
    end_spin: cython.double
    back_x: cython.double  # where and how it was before a substep
    back_y: cython.double
    back_angle: cython.double
    back_vx: cython.double
    back_vy: cython.double
    back_spin: cython.double
    moved_x: cython.double  # where the engine has moved it
    moved_y: cython.double
    moved_angle: cython.double
    ahead: cython.bint  # whether it is elsewhere, by forces that acted meanwhile
    gone: cython.double  # m, its way in this control step
    # within a control step
    near: cython.bint  # whether it may touch something
    speed: cython.double  # how fast it may be
    way: cython.double  # how far it may go, at most
    strain: cython.double  # how many robots' pushes add up on it
    slack: cython.double  # how much further than at its speed it may be thrown, a factor
    home: object  # the body that stands for its island
    fastest: cython.double  # of the island that it stands for
    done: cython.bint  # whether its island has been stepped
    island: object
    start_x: cython.double  # where the circle's centre was at the beginning
    start_y: cython.double
    kept: cython.bint  # whether the state at the beginning was kept
    kept_x: cython.double
    kept_y: cython.double
    kept_angle: cython.double
    kept_vx: cython.double
    kept_vy: cython.double
    kept_spin: cython.double
    kept_slips: cython.bint
    kept_since: cython.int
    kept_effort: cython.double
    kept_energy: cython.double
    kept_by_holder: cython.double
    kept_by_push: cython.double
    kept_by_rub: cython.double
    kept_by_joint: cython.double
    kept_by_hand: cython.double
    # work since the beginning, J: of its drive, or of the floor under it; of pushes and of friction
    # of contacts that are counted for it; of its joints; of pulls from outside
    energy: cython.double  # J, its kinetic energy as far as it has been accounted for
    by_holder: cython.double
    by_push: cython.double
    by_rub: cython.double
    by_joint: cython.double
    by_hand: cython.double
    # velocities of the centre of mass before and after the solver's step, m/s and rad/s
    before_x: cython.double
    before_y: cython.double
    before_spin: cython.double
    after_x: cython.double
    after_y: cython.double
    # impulses of its drive, or of the floor under it, on the centre of mass
    drag_x: cython.double
    drag_y: cython.double
    drag_turn: cython.double
    # impulses of contacts in a substep, and for the group of bodies that touch: how they work
    tied: cython.bint  # whether a joint may have acted on it
    group: object  # another body on the way to that which stands for the group
    pressure: cython.double  # N s, the sum of their sizes
    hit_x: cython.double
    hit_y: cython.double
    hit_turn: cython.double
    hit_power: cython.double  # W s, of those between bodies that have come to touch
    hit_depth: cython.double  # J, the same times how deep these are
    held_by: cython.double  # N s, the impulses of drives, floors, joints and pulls
    lasting: cython.bint  # whether no more than these has acted
    eased: cython.bint  # whether a blow has put it back out of what it hit
    shift: cython.double  # s, since when the impulses have acted, in the mean
    push_work: cython.double
    rub_work: cython.double
    excess: cython.double
    push_power: cython.double
    rub_power: cython.double
    share: cython.double
    crowd: cython.int  # how many bodies are in the group
    driven: cython.bint  # whether a robot in it is told to move
    # and of all that holds it or touches it
    springy: cython.bint  # whether a spring is among the group's joints
    held_x: cython.double
    held_y: cython.double
    held_turn: cython.double
    hold_work: cython.double
    hold_energy: cython.double
    # since lists of what is near were made
    moved: cython.double
    wall_pairs: list[Any]
    wall_gap: cython.double  # a lower bound of that to the nearest wall
    wall_skin: cython.double  # how far it may move until the list of walls has to be made again
    cell: cython.int
    next: cython.int
    contacts: list[Any]  # with bodies of larger number, and obstacles
    first_touch: object  # of the pairs that touch now: one of which it is the first body
    # in the solver
    solver: object
    placed: cython.bint  # whether it is elsewhere than the solver thinks
    made: cython.bint
    handle: Handle
    control: Handle
    pivot: Handle  # of a robot with wheels, its motors
    side: Handle  # what holds its wheels across
    gear: Handle
    shapes: list[Any]

    def __init__(self, number: int, is_robot: bool, pieces: list[Piece], surface: Any) -> None:
        """Take its number, its pieces, its friction and restitution; `describe` does the rest."""
        self.number, self.is_robot, self.pieces, self.surface = number, is_robot, pieces, surface
        self.no_load_speed = self.grip_ahead = self.grip_across = 1e300
        self.since, self.slack, self.strain, self.share, self.crowd = 1 << 20, 1.0, 1.0, 1.0, 1
        self.wall_gap = self.wall_skin = -1.0
        self.wall_pairs, self.contacts, self.shapes = [], [], []

    def describe(self, what: dict[str, Any]) -> None:
        """Set the properties, by the names above; those that do not apply may be left out."""
        self.mass, self.moment = what["mass"], what["moment"]
        self.lead = what.get("lead", 0.0)
        self.radius, self.is_disc = what["radius"], what["is_disc"]
        self.offset_x, self.offset_y = what["offset_x"], what["offset_y"]
        self.offset = length(self.offset_x, self.offset_y)
        self.reach = self.radius + self.offset
        self.lever, self.grip = what.get("lever", 0.0), what.get("grip", 0.0)
        self.twist_grip = self.grip * self.lever
        self.rest_grip = what.get("rest_grip", self.grip)
        self.rest_twist_grip = self.rest_grip * self.lever
        self.slows, self.stops = self.grip / self.mass, self.twist_grip / self.moment
        self.force, self.torque = what.get("force", 0.0), what.get("torque", 0.0)
        self.rim, self.in_robot_frame = what.get("rim", 0.0), what.get("in_robot_frame", False)
        self.no_load_speed = what.get("no_load_speed", 1e300)
        self.grip_ahead, self.grip_across = what.get("grips", (1e300, 1e300))
        self.grips = min(self.no_load_speed, self.grip_ahead, self.grip_across) < 1e300
        self.strength = self.bound = self.force
        if self.grip_across < 1e300:
            self.strength = max(min(self.force, self.grip_ahead), self.grip_across)
            self.wheeled = self.in_robot_frame
        self.limited = what.get("limited", False)

    def move(self, state: list[float], slips: bool) -> None:
        """Take x, y, theta, x', y', theta', and whether it slips."""
        self.x, self.y, self.angle, self.vx, self.vy, self.spin = state
        self.slips = slips
        self.energy = 0.0
        self.account_now()
        self.by_holder = 0.0

    # -- where it is --------------------------------------------------------------------------

    @cython.cfunc
    def locate(self) -> cython.void:
        """Work out where its circle and its corners are."""
        if self.is_disc:
            self.center_x, self.center_y = self.x, self.y
            return
        c: cython.double
        s: cython.double
        c, s = cosine_sine(self.angle)
        self.center_x = self.x + (c * self.offset_x - s * self.offset_y)
        self.center_y = self.y + (s * self.offset_x + c * self.offset_y)
        piece: Piece
        for piece in self.pieces:
            piece.turn(c, s)

    @cython.cfunc
    def lift(self) -> cython.void:
        """Forget that its faces go on in other bodies."""
        piece: Piece
        corner: Corner
        self.laid = False
        for piece in self.pieces:
            for corner in piece.corners:
                corner.ends_in = self.number if corner.ends_in == self.number else -1
                corner.starts_in = self.number if corner.starts_in == self.number else -1

    # -- how it moves -------------------------------------------------------------------------

    @cython.cfunc
    def follow(self, angle: cython.double, h: cython.double) -> cython.void:
        """Aim a robot along its command's arc: at the velocity that leads to its end within h s.

        angle: its heading at the beginning. Source: the arc of radius v / omega seen as its chord,
        of length v h sinc(omega h / 2) in the direction theta + omega h / 2.
        """
        half: cython.double = self.turning * (h / 2) if self.in_robot_frame else 0.0
        turned: cython.double = angle + half if self.in_robot_frame else 0.0
        share: cython.double = chord_share(half)
        c: cython.double
        s: cython.double
        c, s = cosine_sine(turned)
        c, s = share * c, share * s
        self.aim_x = self.forward * c - self.left * s
        self.aim_y = self.forward * s + self.left * c
        self.aim_spin = self.turning

    @cython.cfunc
    def advance_half(self, h: cython.double) -> cython.void:
        """Go on for half of h s at the velocity that its centre of mass had before the step."""
        if self.lead != 0.0:
            self.lean(self.angle)
            self.x, self.y = self.x + self.lead_x, self.y + self.lead_y
        self.x += h / 2 * self.before_x
        self.y += h / 2 * self.before_y
        self.angle += h / 2 * self.before_spin
        if self.lead != 0.0:
            self.lean(self.angle)
            self.x, self.y = self.x - self.lead_x, self.y - self.lead_y

    @cython.cfunc
    def part(self, h: cython.double) -> cython.void:
        """Go as far as the engine moved it in h s to mend overlaps, beyond its velocity's way."""
        x: cython.double = self.moved_x - (self.back_x + h * self.back_vx)
        y: cython.double = self.moved_y - (self.back_y + h * self.back_vy)
        turn: cython.double = self.moved_angle - (self.back_angle + h * self.back_spin)
        if length(x, y) + self.reach * abs(turn) > 1e-12:  # no rounding error
            self.x, self.y, self.angle = self.x + x, self.y + y, self.angle + turn

    @cython.cfunc
    def remember(self) -> cython.void:
        """Note where and how it is before a substep."""
        self.back_x, self.back_y, self.back_angle = self.x, self.y, self.angle
        self.back_vx, self.back_vy, self.back_spin = self.vx, self.vy, self.spin

    @cython.cfunc
    def go_back(self) -> cython.void:
        """Go back to there."""
        self.x, self.y, self.angle = self.back_x, self.back_y, self.back_angle
        self.vx, self.vy, self.spin = self.back_vx, self.back_vy, self.back_spin

    @cython.cfunc
    def advance(self, h: cython.double) -> cython.void:
        """Move for h s as aimed, in closed form."""
        self.x += h * self.aim_x
        self.y += h * self.aim_y
        self.angle += h * self.aim_spin
        if self.aim_x != 0.0 or self.aim_y != 0.0 or self.aim_spin != 0.0:
            self.placed = True
        self.vx, self.vy, self.spin = self.end_x, self.end_y, self.end_spin

    @cython.cfunc
    def is_told(self) -> cython.bint:
        """Return whether it is a robot that is commanded to move."""
        told: cython.bint = self.forward != 0.0 or self.left != 0.0 or self.turning != 0.0
        return self.is_robot and told

    @cython.cfunc
    def follows(self) -> cython.bint:
        """Return whether it is a robot that moves as it is commanded at once."""
        return self.is_robot and not self.slips and not self.limited

    @cython.cfunc
    def obey(self) -> cython.void:
        """Let a robot that follows its command have the velocity that it is told now."""
        if self.follows():
            self.follow(self.angle, 0.0)
            self.vx, self.vy, self.spin = self.aim_x, self.aim_y, self.aim_spin

    @cython.cfunc
    def is_pushed(self) -> cython.bint:
        """Return whether anything but its drive and the floor acted on it in the solver's step.

        Impulses that are rounding errors do not count.
        """
        fast: cython.double = length(self.before_x, self.before_y) + self.reach * abs(
            self.before_spin
        )
        return self.tied or self.pulled or self.pressure > 1e-12 * self.mass * fast

    @cython.cfunc
    def go_along(self, h: cython.double) -> cython.void:
        """Aim a robot along its command's arc for h s, and work out its velocity at the end."""
        self.follow(self.angle + h * self.turning, 0.0)
        self.end_x, self.end_y, self.end_spin = self.aim_x, self.aim_y, self.aim_spin
        self.follow(self.angle, h)

    @cython.cfunc
    def look(self) -> cython.void:
        """Work out how fast its velocity may change."""
        self.gathers = False
        if self.solved:
            self.bend = self.spin * self.spin * abs(self.lead)  # its pose goes round its centre
        elif not self.is_robot:
            self.bend = 0.0
            if self.vx != 0.0 or self.vy != 0.0:
                self.bend = self.slows
            if self.spin != 0.0:
                self.bend += self.stops * self.reach
        elif self.limited or self.slips:
            self.look_ahead()
        else:
            self.obey()
            self.bend = self.pull_on_arc(self.turning) / self.mass

    @cython.cfunc
    def fall_back(self) -> cython.void:
        """Go back to where the engine moved it."""
        if self.ahead:
            self.x, self.y, self.angle = self.moved_x, self.moved_y, self.moved_angle
            self.ahead, self.placed = False, True

    @cython.cfunc
    def top_speed(self) -> cython.double:
        """Return how fast its circle moves at most now."""
        arm: cython.double = self.offset
        if self.slips:
            arm += 2 * abs(self.lead)
        return length(self.vx, self.vy) + arm * abs(self.spin)

    # -- its energy ---------------------------------------------------------------------------

    @cython.cfunc
    def kinetic_at(
        self, vx: cython.double, vy: cython.double, spin: cython.double
    ) -> cython.double:
        """Return its kinetic energy at a velocity of its centre of mass, J."""
        return 0.5 * (self.mass * (vx * vx + vy * vy) + self.moment * spin * spin)

    @cython.cfunc
    def account(self, vx: cython.double, vy: cython.double, spin: cython.double) -> cython.void:
        """Count the momentum gained at a velocity as work of its drive, or of the floor."""
        energy: cython.double = self.kinetic_at(vx, vy, spin)
        self.by_holder += energy - self.energy
        self.energy = energy

    @cython.cfunc
    def account_now(self) -> cython.void:
        """Do the same at its present velocity."""
        if self.lead != 0.0:
            self.lean(self.angle)
        x: cython.double = self.vx - self.spin * self.lead_y
        self.account(x, self.vy + self.spin * self.lead_x, self.spin)

    # -- its drive ----------------------------------------------------------------------------

    @cython.cfunc
    def time_to_brake(self, turned: cython.double) -> cython.double:
        """Return when its drive stops the spin that a blow has given a robot: there a substep ends.

        It has a lower bound, in which its rim turns by `turned`, too little to be seen.
        """
        spin: cython.double = abs(self.spin - self.turning)
        moment: cython.double = self.moment + self.mass * self.lead * self.lead
        return max(spin * moment / self.torque, turned / max(spin * self.rim, 1e-300))

    @cython.cfunc
    def out_of_reach(self, h: cython.double) -> cython.bint:
        """Return whether its drive can't bring it back to its command within h seconds."""
        self.follow(self.angle, h)
        if self.lead != 0.0:
            return self.takes_more(h)
        off: cython.double = length(self.vx - self.aim_x, self.vy - self.aim_y)
        if self.grips:
            self.bear(self.aim_x - self.vx, self.aim_y - self.vy, self.angle, self.vx, self.vy)
        if off * self.mass > self.bound * h:
            return True
        return abs(self.spin - self.turning) * self.moment > self.torque * h

    @cython.cfunc
    def least_force(self) -> cython.double:
        """Return the force that its drive can bear at rest in any direction."""
        return min(self.force, self.grip_ahead, self.grip_across)

    @cython.cfunc
    def bear(
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
        c: cython.double
        s: cython.double
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

    @cython.cfunc
    def motors(self, ahead: cython.double, speed: cython.double) -> cython.double:
        """Return the force of its motors, N, at a speed ahead, in the direction of `ahead`."""
        if speed * ahead > 0.0:
            return self.force * max(1.0 - abs(speed) / self.no_load_speed, 0.0)
        return self.force

    @cython.cfunc
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

    @cython.cfunc
    def takes_more(self, h: cython.double) -> cython.bint:
        """Do `out_of_reach` for one whose drive acts beside its centre of mass.

        The impulse J and the angular impulse that its drive has to give change the velocity of the
        centre by J / m, and the spin by (angular impulse - r x J) / I, with r from pose to centre.
        """
        self.lean(self.angle)
        x: cython.double = self.lead_x
        y: cython.double = self.lead_y
        spin: cython.double = self.turning - self.spin
        push_x: cython.double = self.mass * (self.aim_x - self.vx - spin * y)
        push_y: cython.double = self.mass * (self.aim_y - self.vy + spin * x)
        if self.grip_across < 1e300:
            self.bear(push_x, push_y, self.angle, self.vx, self.vy)
        if length(push_x, push_y) > self.bound * h:
            return True
        return abs(self.moment * spin + x * push_y - y * push_x) > self.torque * h

    # -- its centre of mass, where that is not its pose ---------------------------------------

    @cython.cfunc
    def lean(self, angle: cython.double) -> cython.void:
        """Work out where its centre of mass lies from its pose at a heading."""
        c: cython.double
        s: cython.double
        c, s = cosine_sine(angle)
        self.lead_x, self.lead_y = self.lead * c, self.lead * s

    # -- where its force bounds its acceleration in the open, too ----------------------------

    @cython.cfunc
    def look_ahead(self) -> cython.void:
        """Do `look` for such a robot: it moves as it has come to, whatever it is commanded."""
        self.follow(self.angle, 0.0)
        self.gathers = self.vx != self.aim_x or self.vy != self.aim_y or self.lags(self.spin)
        if not self.gathers:
            self.bend = self.pull_on_arc(self.turning) / self.mass
            return
        self.bend = self.strength / self.mass
        if self.spin != self.turning:
            self.bend += self.torque / self.moment * self.reach

    @cython.cfunc
    def pull_on_arc(self, spin: cython.double) -> cython.double:
        """Return the force that holds it on its command's arc at a spin, N."""
        if not self.in_robot_frame:
            return 0.0
        return self.mass * abs(length(self.forward, self.left) * spin)

    @cython.cfunc
    def is_flung(self, spin: cython.double) -> cython.bint:
        """Return whether its force can't hold it on its command's arc."""
        most: cython.double = self.force_across()
        return self.pull_on_arc(max(abs(spin), abs(self.turning))) > most * (1 + 1e-9)

    @cython.cfunc
    def force_across(self) -> cython.double:
        """Return the largest force that it bears across its heading, N."""
        return self.force if self.grip_across >= 1e300 else self.grip_across

    @cython.cfunc
    def lags(self, spin: cython.double) -> cython.bint:
        """Return whether a robot of this spin, and of the speed commanded, can't keep it up."""
        return spin != self.turning or self.is_flung(spin)

    @cython.cfunc
    def time_to_turn(self, deep: cython.double) -> cython.double:
        """Return for how long its corners stay within `deep` metres of its present spin."""
        if self.is_disc or not self.gathers or self.spin == self.turning:
            return 1e300
        return sqrt(2 * deep * self.moment / (self.torque * self.reach))

    # -- a control step that is done again ----------------------------------------------------

    @cython.cfunc
    def keep(self) -> cython.void:
        """Keep the state, to begin with it again."""
        self.kept = True
        self.kept_x, self.kept_y, self.kept_angle = self.x, self.y, self.angle
        self.kept_vx, self.kept_vy, self.kept_spin = self.vx, self.vy, self.spin
        self.kept_slips, self.kept_since, self.kept_effort = self.slips, self.since, self.effort
        self.kept_energy, self.kept_by_holder = self.energy, self.by_holder
        self.kept_by_push, self.kept_by_rub = self.by_push, self.by_rub
        self.kept_by_joint, self.kept_by_hand = self.by_joint, self.by_hand

    @cython.cfunc
    def begin_again(self) -> cython.void:
        """Go back to the state that was kept."""
        self.x, self.y, self.angle = self.kept_x, self.kept_y, self.kept_angle
        self.vx, self.vy, self.spin = self.kept_vx, self.kept_vy, self.kept_spin
        self.slips, self.since, self.effort = self.kept_slips, self.kept_since, self.kept_effort
        self.energy, self.by_holder = self.kept_energy, self.kept_by_holder
        self.by_push, self.by_rub = self.kept_by_push, self.kept_by_rub
        self.by_joint, self.by_hand = self.kept_by_joint, self.kept_by_hand
        self.done = False
