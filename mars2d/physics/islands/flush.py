"""Flush: pieces that lie side by side with their faces in one plane, and what slides over them.

A piece that slides over one of them overlaps it a little. So it meets the next one from the side,
less deep than from above, and the engine would throw it back. But if an axis parts it from both by
less than bodies may overlap, it slides over both: then that axis is the normal of both contacts. A
disc only has the contact with the piece under its middle.
"""

from __future__ import annotations

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, length
from mars2d.physics.islands.body import Body, Corner, Edge, Piece
from mars2d.physics.islands.chipmunk import (
    Arbiters,
    Handle,
    Vector,
    angle_of,
    arm_of,
    count_of,
    end_of,
    first_of,
    leave_out,
    normal_of,
    piece_of,
    position_of,
    restitution_of,
    second_of,
    set_normal,
    set_point,
    shape_of,
    spin_of,
    velocity_of,
)

__all__ = ["Flush"]

ALIKE = 1e-7
"""The sine of the angle up to which normals are the same."""

RESTS = 1e-3
"""The speed up to which bodies do not approach each other, m/s."""

ROUGHLY = 0.1
"""That up to which two that are asked for do not contradict each other."""


@cython.final
@cython.cclass
class Side:
    """A piece of a body, or a wall, where it is when the engine looks for contacts."""

    body: Body
    is_wall: cython.bint
    piece: Piece
    # of a body: where its pose is, and its centre of mass
    c: cython.double
    s: cython.double
    x: cython.double
    y: cython.double
    center_x: cython.double
    center_y: cython.double
    # of a wall: its end
    end_x: cython.double
    end_y: cython.double
    # of a body: the corner that was found
    corner_x: cython.double
    corner_y: cython.double

    def __init__(self) -> None:
        """Stand for nothing yet."""
        self.is_wall = True
        self.c = self.s = self.x = self.y = 0.0
        self.center_x = self.center_y = self.end_x = self.end_y = 0.0
        self.corner_x = self.corner_y = 0.0

    @cython.cfunc
    def take(self, body: Body, piece: cython.int) -> cython.void:
        """Stand for a piece of a body."""
        where: Vector = position_of(body.handle)
        self.body, self.piece, self.is_wall = body, body.pieces[piece], False
        self.c, self.s = cosine_sine(angle_of(body.handle))
        self.x, self.y = where.x, where.y
        self.center_x = where.x + self.c * body.lead
        self.center_y = where.y + self.s * body.lead

    @cython.cfunc
    def take_wall(self, wall: Handle) -> cython.void:
        """Stand for a wall."""
        where: Vector = end_of(wall, False)
        self.is_wall, self.x, self.y = True, where.x, where.y
        self.center_x = self.center_y = 0.0
        where = end_of(wall, True)
        self.end_x, self.end_y = where.x, where.y

    @cython.cfunc
    def is_disc(self) -> cython.bint:
        """Return whether it is a disc."""
        return not self.is_wall and self.piece.radius > 0.0

    @cython.cfunc
    def reach(self, nx: cython.double, ny: cython.double) -> cython.double:
        """Return how far it extends in a direction, as seen from the origin."""
        if self.is_wall:
            return max(self.x * nx + self.y * ny, self.end_x * nx + self.end_y * ny)
        far: cython.double = -1e300
        x: cython.double = self.c * nx + self.s * ny
        y: cython.double = self.c * ny - self.s * nx
        corner: Corner
        for corner in self.piece.corners:
            far = max(far, corner.local_x * x + corner.local_y * y)
        far += self.piece.radius
        return far + self.x * nx + self.y * ny

    @cython.cfunc
    def find_corner(self, x: cython.double, y: cython.double, room: cython.double) -> cython.bint:
        """Find the nearest corner to a point, within some room; return whether there is one."""
        corner: Corner
        nearest: cython.double = room
        if self.is_wall:
            return False
        for corner in self.piece.corners:
            at_x: cython.double = self.c * corner.local_x - self.s * corner.local_y + self.x
            at_y: cython.double = self.s * corner.local_x + self.c * corner.local_y + self.y
            far: cython.double = length(at_x - x, at_y - y)
            if far < nearest:
                nearest, self.corner_x, self.corner_y = far, at_x, at_y
        return nearest < room

    @cython.cfunc
    def give(
        self, x: cython.double, y: cython.double, nx: cython.double, ny: cython.double
    ) -> cython.double:
        """Return by how much an impulse of 1 N s there makes it faster in its direction, 1/kg."""
        if self.is_wall:
            return 0.0
        turn: cython.double = x * ny - y * nx
        return 1.0 / self.body.mass + turn * turn / self.body.moment


@cython.final
@cython.cclass
class Met:
    """A contact, and what is to become of it. First and second are its sides."""

    arbiter: Handle
    first: cython.int  # the numbers of both
    second: cython.int
    x: cython.double  # its normal, from first to second
    y: cython.double
    turned_by: cython.int  # 1: by the first, 2: by the second, 0: not
    stands_by: cython.int  # 1, 2 or 3: by whose side it is as another contact
    left_out: cython.bint
    doubted: cython.bint  # whether it was turned for two bodies, which may move past each other
    new_x: cython.double  # its new normal
    new_y: cython.double

    def __init__(self) -> None:
        """Begin without any; `take` follows."""
        self.first = self.second = self.turned_by = self.stands_by = 0
        self.x = self.y = self.new_x = self.new_y = 0.0
        self.left_out = self.doubted = False

    @cython.cfunc
    def take(self, arbiter: Handle) -> cython.void:
        """Stand for a contact that the engine has found."""
        normal: Vector = normal_of(arbiter)
        self.arbiter, self.first, self.second = arbiter, first_of(arbiter), second_of(arbiter)
        self.x, self.y = normal.x, normal.y

    @cython.cfunc
    def turn_to(self, nx: cython.double, ny: cython.double, side: cython.int) -> cython.void:
        """Ask for a normal, away from a side; for none if the other side asks for another."""
        if side == 2:
            nx, ny = -nx, -ny
        if self.turned_by > 0:
            across: cython.bint = not alike(nx, ny, self.new_x, self.new_y, ROUGHLY)
            self.left_out = self.left_out or (across and self.turned_by != side)
            return
        self.turned_by, self.new_x, self.new_y = side, nx, ny


@cython.final
@cython.cclass
class Flush:
    """What makes contacts of a solver one plane's where pieces lie flush.

    Where the corners of three bodies meet, a contact may be asked for along a seam and across it:
    then it is left out, since both bodies are held by the third.
    """

    bodies: list[Body]
    arbiters: Arbiters
    numbers: dict[int, Body]
    touched: dict[int, list[Met]]  # the contacts of each body
    depth: cython.double  # m, up to which pieces overlap where one slides over another
    middle: Side  # a piece that has two contacts, and what these are with
    one: Side
    other: Side
    x: cython.double  # the axis, away from the piece in the middle
    y: cython.double
    deepest: cython.double  # m, the overlap along it
    handle: object  # by which the engine finds it, in Python

    def __init__(self, bodies: list[Body], depth: float) -> None:
        """Take the solver's bodies, and `depth`."""
        self.bodies, self.depth = bodies, depth
        self.arbiters, self.numbers, self.touched = Arbiters(), {}, {}
        self.middle, self.one, self.other = Side(), Side(), Side()
        self.x = self.y = self.deepest = 0.0
        self.handle = None

    @cython.cfunc
    def straighten(self) -> cython.void:
        """Look at all contacts that were found in a step, before it is solved."""
        body: Body
        met: Met
        some: list[Met]
        every: list[Met] = []
        k: cython.int
        i: cython.int
        self.arbiters.clear()
        for body in self.bodies:
            self.arbiters.add_those_of(body.handle)
        if self.arbiters.count() == 0:
            return
        self.touched = {}
        for body in self.bodies:
            self.numbers[body.number] = body
            self.touched[body.number] = []
        for k in range(self.arbiters.count()):
            if count_of(self.arbiters.at(k)) > 0:
                met = Met()
                met.take(self.arbiters.at(k))
                every.append(met)
                if met.first >= 0:
                    self.touched[met.first].append(met)
                if met.second >= 0:
                    self.touched[met.second].append(met)
        for body in self.bodies:
            some = self.touched[body.number]
            for k in range(1, len(some)):
                for i in range(k):
                    self.compare(body, some[i], some[k])
        speed: cython.double
        for met in every:
            self.look_beside(met, 1)
            self.look_beside(met, 2)
        for met in every:
            if met.turned_by > 0 and met.stands_by & (3 - met.turned_by):
                met.turned_by = 0
                met.left_out = not alike(met.x, met.y, met.new_x, met.new_y, ROUGHLY)
            elif met.turned_by > 0 and met.doubted:  # they do not slide along it
                speed = max(self.closing(met, met.x, met.y), 0.0)
                if self.closing(met, met.new_x, met.new_y) > speed + RESTS:
                    met.turned_by = 0
            if met.left_out:
                leave_out(met.arbiter)
            elif met.turned_by > 0:
                self.turn(met)

    @cython.cfunc
    def compare(self, body: Body, a: Met, b: Met) -> cython.void:
        """Ask for one normal of two contacts if it is one piece of a body that slides over both."""
        by_a: cython.int = 1 if a.first == body.number else 2
        by_b: cython.int = 1 if b.first == body.number else 2
        piece: cython.int = piece_of(a.arbiter, by_a == 2)
        if piece_of(b.arbiter, by_b == 2) != piece:
            return
        ax: cython.double = a.x if by_a == 1 else -a.x
        ay: cython.double = a.y if by_a == 1 else -a.y
        bx: cython.double = b.x if by_b == 1 else -b.x
        by: cython.double = b.y if by_b == 1 else -b.y
        if alike(ax, ay, bx, by, ALIKE):
            a.stands_by |= by_a
            b.stands_by |= by_b
            return
        of_a: Vector = arm_of(a.arbiter, 0, by_a == 2)
        of_b: Vector = arm_of(b.arbiter, 0, by_b == 2)
        near: cython.bint = length(of_b.x - of_a.x, of_b.y - of_a.y) < 4 * self.depth
        if not near and not (
            self.is_level(b, by_b == 2, of_a.x * ax + of_a.y * ay, ax, ay)
            or self.is_level(a, by_a == 2, of_b.x * bx + of_b.y * by, bx, by)
        ):
            return
        self.put(self.middle, a, by_a)
        self.put(self.one, a, 3 - by_a)
        self.put(self.other, b, 3 - by_b)
        if self.one.is_wall and self.other.is_wall:
            return
        self.deepest = self.depth
        self.try_axis(ax, ay)
        self.try_axis(bx, by)
        if near and self.deepest >= self.depth:  # a corner on a seam may be pushed by no face
            self.try_sides(self.one)
            self.try_sides(self.other)
        if self.deepest >= self.depth:
            return
        a_stands: cython.bint = alike(ax, ay, self.x, self.y, ALIKE)
        b_stands: cython.bint = alike(bx, by, self.x, self.y, ALIKE)
        if a_stands:
            a.stands_by |= by_a
        else:
            self.ask(a, by_a, self.one, b_stands)
        if b_stands:
            b.stands_by |= by_b
        else:
            self.ask(b, by_b, self.other, a_stands)

    @cython.cfunc
    def is_level(
        self,
        met: Met,
        second: cython.bint,
        level: cython.double,
        nx: cython.double,
        ny: cython.double,
    ) -> cython.bint:
        """Return whether all points of a contact are about as far along a normal as said."""
        k: cython.int
        for k in range(count_of(met.arbiter)):
            arm: Vector = arm_of(met.arbiter, k, second)
            if abs(arm.x * nx + arm.y * ny - level) > 2 * self.depth:
                return False
        return True

    @cython.cfunc
    def look_beside(self, met: Met, by: cython.int) -> cython.void:
        """Ask for a face's normal where a corner meets a piece, at the seam with one beside it.

        by: which of both the piece is that slides over it, and need not touch the one beside.
        """
        which: cython.int = 3 - by
        number: cython.int = met.second if by == 1 else met.first
        if number < 0 or met.left_out:
            return
        body: Body = self.numbers[number]
        some: list[Met] = self.touched[number]
        if len(some) + len(body.pieces) < 3:
            return
        piece: cython.int = piece_of(met.arbiter, which == 2)
        nx: cython.double = met.x if by == 1 else -met.x
        ny: cython.double = met.y if by == 1 else -met.y
        if rests_on(body.pieces[piece], nx, ny) and self.closing(met, met.x, met.y) < RESTS:
            return
        self.put(self.middle, met, by)
        self.put(self.one, met, which)
        if self.middle.is_disc() or self.middle.is_wall or self.one.is_disc():
            return
        self.deepest = self.depth
        self.try_faces(self.one)
        if self.deepest >= self.depth or alike(nx, ny, self.x, self.y, ALIKE):
            return
        k: cython.int
        other: Met
        for k in range(len(body.pieces)):
            if k != piece:
                self.other.take(body, k)
                self.ask_beside(met, by)
        for other in some:
            if other is not met and piece_of(other.arbiter, other.second == number) == piece:
                self.put(self.other, other, 1 if other.second == number else 2)
                self.ask_beside(met, by)

    @cython.cfunc
    def ask_beside(self, met: Met, by: cython.int) -> cython.void:
        """Ask for the axis if the other piece is flush with that which is met, and at the contact.

        by: as in `look_beside`.
        """
        deep: cython.double = self.middle.reach(self.x, self.y) + self.other.reach(-self.x, -self.y)
        if abs(deep) > self.depth:
            return
        arm: Vector = arm_of(met.arbiter, 0, by == 2)
        x: cython.double = self.middle.center_x + arm.x
        y: cython.double = self.middle.center_y + arm.y
        along: cython.double = y * self.x - x * self.y
        most: cython.double = self.other.reach(-self.y, self.x) + self.depth
        least: cython.double = -self.other.reach(self.y, -self.x) - self.depth
        if least <= along <= most:
            met.turn_to(self.x, self.y, by)

    @cython.cfunc
    def try_faces(self, side: Side) -> cython.void:
        """See along which of the normals of the edges of the one side the overlap is least."""
        edge: Edge
        for edge in side.piece.edges:
            nx: cython.double = side.s * edge.local_y - side.c * edge.local_x
            ny: cython.double = -side.s * edge.local_x - side.c * edge.local_y
            deep: cython.double = self.middle.reach(nx, ny) + side.reach(-nx, -ny)
            if deep < self.deepest:
                self.x, self.y, self.deepest = nx, ny, deep

    @cython.cfunc
    def ask(self, met: Met, by: cython.int, side: Side, other_stands: cython.bint) -> cython.void:
        """Ask for the axis as normal. other_stands: whether it is that of the other contact."""
        if not (self.middle.is_disc() or side.is_disc()):
            met.doubted = self.one.is_wall or self.other.is_wall
            met.doubted = met.doubted or self.one.body is not self.other.body
            met.turn_to(self.x, self.y, by)
        elif other_stands:
            met.left_out = True

    @cython.cfunc
    def closing(self, met: Met, nx: cython.double, ny: cython.double) -> cython.double:
        """Return how fast both sides of a contact approach each other along a normal, m/s."""
        speed: cython.double = 0.0
        arm: Vector
        if met.first >= 0:
            arm = arm_of(met.arbiter, 0, False)
            speed = speed_of(self.numbers[met.first], arm.x, arm.y, nx, ny)
        if met.second >= 0:
            arm = arm_of(met.arbiter, 0, True)
            speed -= speed_of(self.numbers[met.second], arm.x, arm.y, nx, ny)
        return speed

    @cython.cfunc
    def put(self, side: Side, met: Met, which: cython.int) -> cython.void:
        """Let a side stand for what is first or second in a contact."""
        number: cython.int = met.first if which == 1 else met.second
        if number < 0:
            side.take_wall(shape_of(met.arbiter, which == 2))
        else:
            side.take(self.numbers[number], piece_of(met.arbiter, which == 2))

    @cython.cfunc
    def try_sides(self, side: Side) -> cython.void:
        """See whether the normal of one of its edges is an axis."""
        edge: Edge
        if side.is_wall:
            return
        for edge in side.piece.edges:
            self.try_axis(
                side.s * edge.local_y - side.c * edge.local_x,
                -side.s * edge.local_x - side.c * edge.local_y,
            )

    @cython.cfunc
    def try_axis(self, nx: cython.double, ny: cython.double) -> cython.void:
        """Take an axis if along none of those before the overlaps were as small."""
        far: cython.double = self.middle.reach(nx, ny)
        deep: cython.double = far + self.one.reach(-nx, -ny)
        if deep < self.deepest:
            deep = max(deep, far + self.other.reach(-nx, -ny))
            if deep < self.deepest:
                self.x, self.y, self.deepest = nx, ny, deep

    @cython.cfunc
    def turn(self, met: Met) -> cython.void:
        """Turn a contact's normal, and prepare its points as the engine does.

        Both sides get a point in one place, so that the impulse there turns them by as much.
        """
        a: Side = self.one
        b: Side = self.other
        slider: Side = a if met.turned_by == 1 else b
        nx: cython.double = met.new_x
        ny: cython.double = met.new_y
        self.put(a, met, 1)
        self.put(b, met, 2)
        set_normal(met.arbiter, nx, ny)
        k: cython.int
        for k in range(count_of(met.arbiter)):
            of_a: Vector = arm_of(met.arbiter, k, False)
            of_b: Vector = arm_of(met.arbiter, k, True)
            x: cython.double = (a.center_x + of_a.x + b.center_x + of_b.x) / 2
            y: cython.double = (a.center_y + of_a.y + b.center_y + of_b.y) / 2
            if count_of(met.arbiter) == 1 and slider.find_corner(x, y, self.depth):
                x, y = slider.corner_x, slider.corner_y
            ax: cython.double = x - a.center_x
            ay: cython.double = y - a.center_y
            bx: cython.double = x - b.center_x
            by: cython.double = y - b.center_y
            bounce: cython.double = 0.0
            if not b.is_wall:
                bounce = speed_of(b.body, bx, by, nx, ny)
            if not a.is_wall:
                bounce -= speed_of(a.body, ax, ay, nx, ny)
            set_point(
                met.arbiter, k, ax, ay, bx, by,
                1.0 / (a.give(ax, ay, nx, ny) + b.give(bx, by, nx, ny)),
                1.0 / (a.give(ax, ay, -ny, nx) + b.give(bx, by, -ny, nx)),
                bounce * restitution_of(met.arbiter),
            )  # fmt: skip


@cython.cfunc
def speed_of(
    body: Body, x: cython.double, y: cython.double, nx: cython.double, ny: cython.double
) -> cython.double:
    """Return how fast a point at x, y from a body's centre of mass moves in a direction, m/s."""
    fast: Vector = velocity_of(body.handle)
    spin: cython.double = spin_of(body.handle)
    along: cython.double = (fast.x - spin * y) * nx + (fast.y + spin * x) * ny
    return along


@cython.cfunc
def rests_on(piece: Piece, nx: cython.double, ny: cython.double) -> cython.bint:
    """Return whether something that is pushed along a normal may rest on an edge of a piece."""
    edge: Edge
    rests: cython.bint = False
    for edge in piece.edges:  # as it was before the step
        rests = rests or alike(-nx, -ny, edge.x, edge.y, ROUGHLY)
    return rests


@cython.cfunc
def alike(
    ax: cython.double,
    ay: cython.double,
    bx: cython.double,
    by: cython.double,
    sine: cython.double,
) -> cython.bint:
    """Return whether two directions are the same, but for an angle with this sine."""
    return ax * bx + ay * by > 0.0 and abs(ax * by - ay * bx) <= sine
