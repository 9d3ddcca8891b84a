"""Solver: a space of pymunk's engine, in which one island is stepped."""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import chipmunk, library, settings
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, decay_base, exponential, length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.chipmunk import Held
from mars2d.physics.islands.floor import hold
from mars2d.physics.islands.flush import Flush, lay, straighten_contact
from mars2d.physics.islands.library import Arbiters, Handle, Vector
from mars2d.physics.islands.pair import Wall
from mars2d.physics.islands.seams import correct_contact
from mars2d.physics.islands.surfaces import settle_contact
from mars2d.physics.islands.tie import Tie

ENDS = ((0.0, 0.0), (0.0, 0.0))

SMALL = 4
"""Up to this number of bodies' shapes, and of walls, the engine's tables are as in a new space."""

STILL = 1e-6
"""The speed up to which a body is at rest, m/s."""


@cython.cclass
class Solver:
    """A space of the engine: its bodies, the walls near them, and their joints."""

    space: Handle
    bodies: list[Body]
    walls: dict[int, Held]
    ties: list[Tie]
    arbiters: Arbiters
    last_step: cython.double
    used: cython.bint  # in this control step
    idle: cython.bint  # whether it waits for an island
    large: cython.bint  # whether the engine's tables have grown
    stale: cython.bint  # whether bodies have moved without it since its last step
    bias_base: cython.double  # e to the power of minus the rate
    joint_bias_base: cython.double
    hurries: cython.bint  # whether overlaps are to go as fast as what joints are off by
    hurried: cython.bint
    bias: cython.double  # what the engine is told for steps as long as the last one
    joint_bias: cython.double
    surfaces: object  # kept for the space, which knows its address
    room: cython.double

    def __init__(self, slop: float, room: float, surfaces: Any) -> None:
        """Make an empty one.

        slop: the overlap that is left in steady contact, metres. room: up to which a step
        between faces is not felt. surfaces: what settles friction and restitution; None: they are
        products.
        """
        self.space, self.room = chipmunk.new_space(slop), room
        library.handle_contacts(self.space, library.SEWN, correct_contact)
        library.handle_contacts(self.space, library.JOINED, straighten_contact)
        self.bias_base = exponential(-settings.BIAS_RATE)
        self.joint_bias_base = exponential(-settings.JOINT_BIAS_RATE)
        self.surfaces = surfaces
        if surfaces is not None:
            library.watch_contacts(self.space, settle_contact, surfaces)
        self.bodies, self.walls, self.ties = [], {}, []
        self.arbiters = Arbiters()
        self.last_step = 1e300

    # -- who is in it -------------------------------------------------------------------------

    def enter(self, body: Body) -> cython.void:
        """Put a body in."""
        if not body.made:
            self.make(body)
        chipmunk.add_body(self.space, body.handle)
        for shape in body.shapes:
            chipmunk.add_shape(self.space, shape.handle)
        body.solver, body.placed = self, True
        self.bodies.append(body)
        if not self.large:
            self.large = sum([len(other.shapes) for other in self.bodies]) > SMALL
        if not body.is_robot and body.rest_grip > 0.0:  # the floor's impulses begin anew
            body.allowed = body.twist_allowed = 0.0
            body.applied_x = body.applied_y = body.applied_turn = 0.0
            body.known = False
            self.attach(body)
            self.engage(body)

    def make(self, body: Body) -> cython.void:
        """Make a body, its shapes, and the joints that hold it."""
        body.made = True
        body.handle = chipmunk.new_body(body.mass, body.moment, body.number)
        if body.com != 0.0:
            chipmunk.weight_at(body.handle, body.com)
        for piece in body.pieces:
            points = [(corner.local_x, corner.local_y) for corner in piece.corners]
            shape = Held()
            body.shapes.append(shape)
            if len(points) == 1:
                x, y = points[0]
                shape.handle = chipmunk.new_disc(body.handle, piece.radius, x, y, body.surface)
            else:
                shape.handle = chipmunk.new_polygon(body.handle, points, body.surface)
            piece.shape, piece.flush = shape.handle, Flush(piece, self.room)
            chipmunk.set_data(piece.shape, library.address_of(piece.flush))
            for other in body.pieces:
                if other is not piece and lay(piece, other, 0.0, 0.0, body.number, self.room / 8):
                    chipmunk.set_type(piece.shape, library.JOINED)
        if body.is_robot or body.rest_grip > 0.0:
            body.control = chipmunk.new_control()
        if body.is_robot:
            self.attach(body)

    def attach(self, body: Body) -> cython.void:
        """Make the joints of a body start again: to what drives it, or to the floor."""
        if body.wheeled:  # grooves are free along
            body.pivot = chipmunk.make_joint(
                library.GROOVE, body.pivot, body.control, body.handle, ENDS, 0.0, 1.0, 0.0
            )
            body.side = chipmunk.make_joint(
                library.GROOVE, body.side, body.control, body.handle, ENDS, 1.0, 0.0, 0.0
            )
            chipmunk.set_joint(body.side, 0.0, True)
            chipmunk.set_max_bias(body.side, 0.0)
            body.traction_ahead = body.traction_across = 0.0
        else:
            body.pivot = chipmunk.make_joint(
                library.PIVOT, body.pivot, body.control, body.handle, ENDS, 0.0, 0.0, 0.0
            )
        body.gear = chipmunk.make_joint(
            library.GEAR, body.gear, body.control, body.handle, ENDS, 0.0, 1.0, 0.0
        )
        chipmunk.set_joint(body.pivot, 0.0, True)  # powers of 0 are the same everywhere
        chipmunk.set_joint(body.gear, 0.0, True)
        chipmunk.set_max_bias(body.pivot, 0.0)  # they never draw bodies together
        chipmunk.set_max_bias(body.gear, 0.0)
        chipmunk.set_max_force(body.pivot, body.bound if body.is_robot else body.allowed)
        chipmunk.set_max_force(body.gear, body.torque if body.is_robot else body.twist_allowed)

    def engage(self, body: Body) -> cython.void:
        """Let its joints act."""
        chipmunk.add_joint(self.space, body.pivot)
        if body.wheeled:
            chipmunk.add_joint(self.space, body.side)
        chipmunk.add_joint(self.space, body.gear)
        body.engaged = True

    def disengage(self, body: Body) -> cython.void:
        """Take its joints out."""
        chipmunk.remove_joint(self.space, body.pivot)
        if body.wheeled:
            chipmunk.remove_joint(self.space, body.side)
        chipmunk.remove_joint(self.space, body.gear)
        body.engaged = False

    def leave(self, body: Body) -> cython.void:
        """Remove a body with its ties."""
        for tie in self.ties[:]:
            if tie.a is body or tie.b is body:
                self.remove_parts(tie)
                self.ties.remove(tie)
        if body.engaged:
            self.disengage(body)
        for shape in body.shapes:
            chipmunk.remove_shape(self.space, shape.handle)
        chipmunk.remove_body(self.space, body.handle)
        body.solver = None
        self.bodies.remove(body)

    def empty(self) -> cython.void:
        """Take all bodies out."""
        for body in self.bodies[::-1]:
            self.leave(body)
        if len(self.walls) > 8:
            self.take_walls_down()
        self.arbiters.clear()
        self.last_step, self.stale = 1e300, False

    def begin_again(self) -> cython.void:
        """Be as a new one, which a `large` one can't be; the engine keeps its memory."""
        self.empty()
        self.take_walls_down()
        library.number_shapes_again(self.space)
        self.joint_bias, self.idle = 0.0, True

    def take_walls_down(self) -> cython.void:
        """Take all walls out."""
        for held in self.walls.values():
            chipmunk.remove_shape(self.space, held.handle)
            chipmunk.remove_body(self.space, held.ground)
            chipmunk.free_shape(held.handle)
            chipmunk.free_body(held.ground)
        self.walls = {}

    def wall_off(self, wall: Wall) -> cython.void:
        """Put a wall in."""
        if wall.number in self.walls:
            return
        held = Held()
        self.walls[wall.number] = held
        held.ground = chipmunk.new_ground(wall.other)
        ends = ((wall.x, wall.y), (wall.x + wall.edge_x, wall.y + wall.edge_y))
        held.handle = chipmunk.new_segment(held.ground, ends, wall.surface)
        if wall.seams is not None:
            wall.seams.reach = self.room
            chipmunk.set_data(held.handle, library.address_of(wall.seams))
            chipmunk.set_type(held.handle, library.SEWN)
        chipmunk.add_body(self.space, held.ground)
        chipmunk.add_shape(self.space, held.handle)
        self.large = self.large or len(self.walls) > SMALL

    # -- joints -------------------------------------------------------------------------------

    def tie(self, tie: Tie) -> cython.void:
        """Put a joint in."""
        if tie in self.ties:
            return
        self.ties.append(tie)
        self.make_parts(tie)
        self.add_parts(tie)

    def make_parts(self, tie: Tie) -> cython.void:
        """Make the parts of a joint start again."""
        if self.joint_bias == 0.0 and self.last_step < 1e300:
            self.joint_bias = decay_base(
                settings.JOINT_BIAS_RATE, self.joint_bias_base, self.last_step
            )
        a: Handle = tie.a.handle
        b: Handle = chipmunk.ground_of(self.space) if tie.to_world else tie.b.handle
        ends = ((tie.anchor_ax, tie.anchor_ay), (tie.anchor_bx, tie.anchor_by))
        for k in range(len(tie.parts)):
            kind, turned, numbers = tie.parts[k]
            if len(tie.joints) <= k:
                tie.joints.append(Held())
            part = tie.joints[k]
            p, q, r = numbers
            first: Handle = b if turned else a
            second: Handle = a if turned else b
            part.handle = chipmunk.make_joint(kind, part.handle, first, second, ends, p, q, r)
            chipmunk.set_joint(
                part.handle,
                0.0 if kind == library.ROTARY_LIMIT else self.joint_bias,
                not tie.pinned,
            )
            if tie.is_rope and k == 0:
                chipmunk.set_max_bias(part.handle, 0.0)

    def add_parts(self, tie: Tie) -> cython.void:
        """Put the parts of a joint in."""
        for part in tie.joints:
            chipmunk.add_joint(self.space, part.handle)

    def remove_parts(self, tie: Tie) -> cython.void:
        """Take the parts of a joint out."""
        for part in tie.joints:
            chipmunk.remove_joint(self.space, part.handle)

    def pull_of(self, tie: Tie) -> cython.double:
        """Return the impulse of a joint along its line in the last step, N s."""
        most: cython.double = 0.0
        for k in range(len(tie.parts)):
            if tie.parts[k][0] != library.ROTARY_LIMIT and tie.parts[k][0] != library.ROTARY_SPRING:
                part = tie.joints[k]
                most = max(most, abs(chipmunk.used_of(part.handle)))
        return most

    def rebound(self, tie: Tie, h: cython.double) -> cython.void:
        """Let a limit that a joint reaches within h s turn it back at its restitution.

        The engine turns back what is beyond a limit, at a bounded speed, and at none does nothing.
        """
        speed: cython.double = max(tie.rebound * abs(tie.turning), 1e-9)
        beyond: cython.double = (2 * speed + abs(tie.turning)) * h
        least: cython.double = tie.least
        largest: cython.double = tie.largest
        tie.hits = True
        if tie.angle + tie.turning * h >= largest:
            largest -= beyond
        elif tie.angle + tie.turning * h <= least:
            least += beyond
        else:
            tie.hits = False
        for k in range(len(tie.parts)):
            if tie.parts[k][0] == library.ROTARY_LIMIT:
                part = tie.joints[k]
                chipmunk.set_limits(part.handle, least, largest)
                chipmunk.set_max_bias(part.handle, speed)

    # -- a step -------------------------------------------------------------------------------

    def forget(self, h: cython.double) -> cython.void:
        """Scale the remembered impulses to a step of h seconds.

        The solver begins with the impulses of the step before, scaled by the ratio of the steps'
        lengths, but takes back the unscaled ones: a drive at its bound would push with
        F (2 h - h before), and impacts would be undone by half. So the impulses of contacts are
        scaled where they are kept, and the solver is told that both steps are equally long. Joints
        of bodies start again.
        """
        ratio: cython.double = 0.0 if self.stale else h / self.last_step
        self.stale = False
        if h != self.last_step or self.hurries != self.hurried:
            self.last_step, self.hurried, self.joint_bias = h, self.hurries, 0.0
            if self.hurries:
                self.bias = decay_base(settings.JOINT_BIAS_RATE, self.joint_bias_base, h)
            else:
                self.bias = decay_base(settings.BIAS_RATE, self.bias_base, h)
        if ratio != 1.0:
            for k in range(self.arbiters.count()):  # those of the last step
                chipmunk.scale(self.arbiters.at(k), ratio)
            for tie in self.ties:
                self.remove_parts(tie)
                self.make_parts(tie)
                self.add_parts(tie)

    def find_contacts(self) -> cython.int:
        """Find all contacts that the engine knows, and return how many there are."""
        self.arbiters.clear()
        for body in self.bodies:
            self.arbiters.add_those_of(body.handle)
        return self.arbiters.count()

    def renew(self, body: Body) -> cython.void:
        """Let the joints of a body start again."""
        self.disengage(body)
        self.attach(body)
        self.engage(body)

    def relax(self) -> cython.void:
        """Let bodies that rest press each other no longer: rigid ones keep no tension.

        They do not if any moves, or is told or pulled or tied to.
        """
        for body in self.bodies:
            if self.ties or body.pulled or body.is_told() or body.top_speed() > STILL:
                return
        self.stale = True
        for body in self.bodies:
            if body.engaged and (self.used_by(body) > 0.0 or chipmunk.used_of(body.gear) > 0.0):
                self.renew(body)

    def go(self, h: cython.double) -> cython.void:
        """Step by h seconds, with all bodies moving as they are aimed, and read the result.

        `settle` and `share_out` do the rest.
        """
        solved: cython.bint = False
        for body in self.bodies:
            solved = solved or body.solved
            if body.is_robot and body.holds and not body.engaged:
                self.attach(body)
                self.engage(body)
        for body in self.bodies:
            if body.is_robot and body.engaged and not body.holds:
                self.disengage(body)
        if solved and settings.GROWTH * h < self.last_step:
            for body in self.bodies:
                if body.solved and body.engaged:
                    self.renew(body)
        self.relax()
        self.forget(h)
        for tie in self.ties:
            if tie.is_rope:  # what one that is too long draws in fast would go on, and slacken it
                rope: Held = tie.joints[0]
                chipmunk.set_max_bias(rope.handle, tie.turn * h)
            tie.hits = tie.is_rope and tie.slack > 0.0
            if tie.largest < 1e300:
                self.rebound(tie, h)
        for body in self.bodies:
            self.prepare(body, h)
        chipmunk.step(self.space, h, self.bias)
        self.used = True
        for body in self.bodies:
            where: Vector = chipmunk.position_of(body.handle)
            fast: Vector = chipmunk.velocity_of(body.handle)
            body.x, body.y, body.angle = where.x, where.y, chipmunk.angle_of(body.handle)
            if self.ties:  # it began half a step behind: see `set_off`
                half: cython.double = h / 2
                body.displace(half * body.before_x, half * body.before_y, half * body.before_spin)
            body.moved_x, body.moved_y, body.moved_angle = body.x, body.y, body.angle
            body.after_x, body.after_y, body.spin = fast.x, fast.y, chipmunk.spin_of(body.handle)
            if body.is_robot and body.engaged and body.grip_across < 1e300:
                angle: cython.double = body.back.angle + self.lag(h) * body.back.spin
                c, s = cosine_sine(angle)
                self.take_reaction(body)
                body.traction_ahead = (c * body.reaction_x + s * body.reaction_y) / h
                body.traction_across = (c * body.reaction_y - s * body.reaction_x) / h
                body.set_bound(body.reaction_x, body.reaction_y, angle, body.vx, body.vy)
            if body.is_robot and body.solved:
                share: cython.double = self.used_by(body) / max(body.bound * h, 1e-300)
                body.effort = max(body.effort, share)
                share = chipmunk.used_of(body.gear) / (body.torque * h)
                body.effort = max(body.effort, share)

    def take_reaction(self, body: Body) -> cython.void:
        """Find the impulse on a body of its drive, or of the floor under it."""
        reaction: Vector = chipmunk.reaction_of(
            body.pivot, library.GROOVE if body.wheeled else library.PIVOT
        )
        body.reaction_x, body.reaction_y = reaction.x, reaction.y
        if body.wheeled:
            reaction = chipmunk.reaction_of(body.side, library.GROOVE)
            body.reaction_x, body.reaction_y = (
                body.reaction_x + reaction.x,
                body.reaction_y + reaction.y,
            )
        if body.com != 0.0:
            body.place_com(body.angle)
        turn: cython.double = chipmunk.twist_of(body.gear)
        body.reaction_turn = turn - body.com_x * body.reaction_y + body.com_y * body.reaction_x

    def used_by(self, body: Body) -> cython.double:
        """Return how large the impulse on a body of its drive, or of the floor, was, N s."""
        used: cython.double = chipmunk.used_of(body.pivot)
        return length(used, chipmunk.used_of(body.side)) if body.wheeled else used

    def lag(self, h: cython.double) -> cython.double:
        """Return how long after a step of h s begins joints find bodies where they are."""
        return h / 2 if self.ties else h

    def share_out(self, body: Body, h: cython.double, shift: cython.double) -> cython.void:
        """Take over a body's motion, and the change of its kinetic energy in the step.

        shift: s, since when its impulses have acted, in the mean: it has gone as much further as
        they have changed its velocity. What a blow has so put back out need not be corrected.

        An impulse works on a body as on one that moves at the mean of its velocities before and
        after. On bodies that joints may hold, drives and floors work by the impulses of theirs.
        """
        body.displace(
            shift * (body.after_x - body.before_x), shift * (body.after_y - body.before_y),
            shift * (body.spin - body.before_spin),
        )  # fmt: skip
        body.vx, body.vy, body.placed = body.after_x, body.after_y, True
        if body.eased:
            chipmunk.settle_down(body.handle)
        if body.com != 0.0:
            body.vx += body.spin * body.com_y
            body.vy -= body.spin * body.com_x
        x: cython.double = (body.before_x + body.after_x) / 2
        y: cython.double = (body.before_y + body.after_y) / 2
        spin: cython.double = (body.before_spin + body.spin) / 2
        gained: cython.double = body.kinetic_at(body.after_x, body.after_y, body.spin)
        gained -= body.energy
        body.energy += gained
        gained -= body.hit_x * x + body.hit_y * y + body.hit_turn * spin
        if body.pulled:
            by_hand: cython.double = (body.pull_x * x + body.pull_y * y + body.pull_turn * spin) * h
            body.by_hand += by_hand
            gained -= by_hand
        if body.tied:
            by_holder: cython.double = 0.0
            if body.engaged:
                self.take_reaction(body)
                by_holder = body.reaction_x * x + body.reaction_y * y + body.reaction_turn * spin
            body.by_holder += by_holder
            body.by_joint += gained - by_holder
        elif body.engaged:
            body.by_holder += gained
        else:  # a rounding error
            body.by_push += gained

    def prepare(self, body: Body, h: cython.double) -> cython.void:
        """Tell the engine of a body all that it needs for a step of h seconds."""
        vx: cython.double = body.vx
        vy: cython.double = body.vy
        spin: cython.double = body.spin
        if not body.solved:
            vx, vy, spin = body.end_x, body.end_y, body.end_spin
        if body.is_robot and body.engaged:
            x: cython.double = body.aim_x
            y: cython.double = body.aim_y
            turning: cython.double = body.aim_spin
            if body.wheeled:
                self.place_wheels(body, vx, vy, h)
            else:
                body.follow(body.angle + h * (body.spin if body.solved else body.turning), 0.0)
                chipmunk.aim(body.control, body.aim_x, body.aim_y, body.aim_spin)
                if body.grips:
                    self.limit_force(body, h)
            body.aim_x, body.aim_y, body.aim_spin = x, y, turning
        if not body.is_robot and body.rest_grip > 0.0:
            self.brake(body, h)
        body.pull_turn = body.pull_torque
        if body.com != 0.0:  # the engine's velocities and forces are those at the centre of mass
            if not body.solved:
                body.place_com(body.angle + h * body.aim_spin)
            vx, vy = vx - spin * body.com_y, vy + spin * body.com_x
            body.place_com(body.angle)
            body.pull_turn -= body.com_x * body.pull_y - body.com_y * body.pull_x
        self.set_off(body, vx, vy, spin, h)
        body.placed = False
        if body.pulled:
            chipmunk.push(body.handle, body.pull_x, body.pull_y, body.pull_turn)
        chipmunk.aim(body.handle, vx, vy, spin)
        body.before_x, body.before_y, body.before_spin = vx, vy, spin
        body.account(vx, vy, spin)

    def set_off(
        self,
        body: Body,
        vx: cython.double,
        vy: cython.double,
        spin: cython.double,
        h: cython.double,
    ) -> cython.void:
        """Put a body where the engine begins with it, which then moves it at a velocity for h s.

        One that moves in closed form gets to its place at the velocity that it has there, so what
        it hits meets it as fast as it is then. In the solver with joints each begins half a step
        behind, since these are to act on it in the middle. vx, vy: of its centre of mass.
        """
        goes: cython.bint = vx != 0.0 or vy != 0.0 or spin != 0.0
        x: cython.double = body.x + body.com_x
        y: cython.double = body.y + body.com_y
        angle: cython.double = body.angle
        if not body.solved and (body.aim_x != vx or body.aim_y != vy or body.aim_spin != spin):
            if body.com != 0.0:
                body.place_com(angle + h * body.aim_spin)
                x, y = body.x + body.com_x, body.y + body.com_y
            x, y = x + h * (body.aim_x - vx), y + h * (body.aim_y - vy)
            angle += h * (body.aim_spin - spin)
        elif not body.placed and not (goes and self.ties):
            return
        if self.ties:
            x, y, angle = x - h / 2 * vx, y - h / 2 * vy, angle - h / 2 * spin
        if body.com != 0.0:
            body.place_com(angle)
            x, y = x - body.com_x, y - body.com_y
        chipmunk.put(body.handle, x, y, angle)

    def limit_force(self, body: Body, h: cython.double) -> cython.void:
        """Bound the force of a robot's drive in the direction in which it will push.

        That is where it has pushed in the step before, or where its command is.
        """
        reaction: Vector = chipmunk.reaction_of(body.pivot, library.PIVOT)
        if length(reaction.x, reaction.y) > 1e-9 * body.strength * h:
            body.set_bound(reaction.x, reaction.y, body.angle, body.vx, body.vy)
        else:
            x: cython.double = body.aim_x - body.vx
            y: cython.double = body.aim_y - body.vy
            body.set_bound(x, y, body.angle, body.vx, body.vy)
        chipmunk.set_max_force(body.pivot, body.bound)

    def place_wheels(
        self, body: Body, vx: cython.double, vy: cython.double, h: cython.double
    ) -> cython.void:
        """Put the joints of a robot's wheels where it will be, and bound their forces.

        vx, vy: its velocity. What it takes to move as commanded is what the wheels bore in the step
        before, and what was lacking then.
        """
        late: cython.double = self.lag(h)
        angle: cython.double = body.angle + late * (body.spin if body.solved else body.turning)
        c, s = cosine_sine(angle)
        x: cython.double = body.x + late * vx
        y: cython.double = body.y + late * vy
        if not body.solved:
            x, y = x + h * (body.aim_x - vx), y + h * (body.aim_y - vy)
        if body.solved and body.com != 0.0:  # it goes round its centre of mass
            body.place_com(body.angle)
            x += body.com_x - late * body.spin * body.com_y - body.com * c
            y += body.com_y + late * body.spin * body.com_x - body.com * s
        chipmunk.put(body.control, x, y, angle)
        body.follow(angle, 0.0)
        if late < h:  # it is to roll along its heading at the end, as fast as it does
            turned: cython.double = (h - late) * (body.spin if body.solved else body.turning)
            body.follow(angle + turned, 0.0)
            x, y = cosine_sine(body.angle)
            speed: cython.double = x * vx + y * vy if body.solved else body.forward
            x, y = cosine_sine(turned)
            body.aim_x -= s * y * (speed - body.forward)
            body.aim_y += c * y * (speed - body.forward)
        chipmunk.aim(body.control, body.aim_x, body.aim_y, body.aim_spin)
        x, y = body.aim_x - vx, body.aim_y - vy
        rate: cython.double = body.mass / h
        ahead: cython.double = body.traction_ahead + rate * (c * x + s * y)
        body.divide(ahead, body.traction_across + rate * (c * y - s * x), c * vx + s * vy)
        chipmunk.set_max_force(body.pivot, body.bound_ahead)
        chipmunk.set_max_force(body.side, body.bound_across)

    def brake(self, body: Body, h: cython.double) -> cython.void:
        """Let the floor hold a prop that slips; a prop at rest is free until it is hit."""
        force: cython.double = body.allowed
        torque: cython.double = body.twist_allowed
        if body.solved:
            hold(body, h)
            chipmunk.aim(body.control, body.drift_x, body.drift_y, 0.0)
        else:
            body.allowed = body.twist_allowed = 0.0
        if body.allowed != force or body.twist_allowed != torque:
            chipmunk.set_max_force(body.pivot, body.allowed)
            chipmunk.set_max_force(body.gear, body.twist_allowed)

    # -- freeing ------------------------------------------------------------------------------

    def free(self) -> cython.void:
        """Free the space; nothing of it is used after that."""
        self.empty()
        self.take_walls_down()
        chipmunk.free_space(self.space)


def free_tie(tie: Tie) -> cython.void:
    """Free the joints of a tie that is in no space."""
    for part in tie.joints:
        chipmunk.free_joint(part.handle)
    tie.joints = []


def free_things_of(body: Body) -> cython.void:
    """Free the engine's objects of a body that is in no space."""
    if not body.made:
        return
    body.made = False
    for shape in body.shapes:
        chipmunk.free_shape(shape.handle)
    body.shapes = []
    if body.is_robot or body.rest_grip > 0.0:
        chipmunk.free_joint(body.pivot)
        if body.wheeled:
            chipmunk.free_joint(body.side)
        chipmunk.free_joint(body.gear)
        chipmunk.free_body(body.control)
    chipmunk.free_body(body.handle)
    body.pivot = body.side = body.gear = cython.NULL
