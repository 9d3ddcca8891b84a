"""Pairs: two bodies, or a body and a wall, that may touch; how far apart they are, and until when.

Of bodies with several pieces each pair of pieces is a pair. A normal leads from the first to the
second; gaps of what overlaps are negative: how far one has to be moved to part them.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from mars2d.physics.islands import chipmunk, library
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.flush import lay
from mars2d.physics.islands.piece import Corner, Piece
from mars2d.physics.islands.seams import Seams


@cython.cclass
class Wall:
    """A straight wall: an edge of an obstacle, or edges of several in one line.

    other: what contacts with it are found by: the obstacle's number, -1, -2, ..., or if there are
    several a number of its own. owners: which obstacle it is from where on, metres from its start.
    """

    number: cython.int
    other: cython.int
    owners: list[Any]
    surface: object
    seams: Seams | None  # what contacts must know of its ends
    shades: list[Any]
    x: cython.double
    y: cython.double
    edge_x: cython.double
    edge_y: cython.double
    share_x: cython.double
    share_y: cython.double
    piece: Piece

    def __init__(
        self,
        number: int,
        owners: list[Any],
        shared: int,
        ends: list[float],
        surface: tuple[float, ...],
        seams: Any,
        shades: list[Any],
    ) -> None:
        """Take its ends x1, y1, x2, y2 [m], and its friction and restitution.

        shared: the number that contacts with it have if it is of several obstacles. shades: x, y
        of an end that lies at another wall [m], the direction off both, metres to that wall's end.
        """
        x1, y1, x2, y2 = ends
        dx, dy = x2 - x1, y2 - y1
        far = sqrt(dx * dx + dy * dy)
        u, v = dx / far, dy / far
        self.number, self.owners, self.surface, self.seams = number, owners, surface, seams
        self.shades = shades
        self.other = owners[0][1] if len(owners) == 1 else shared
        self.x, self.y, self.edge_x, self.edge_y = x1, y1, dx, dy
        self.share_x, self.share_y = dx / (far * far), dy / (far * far)
        sides = [(v, -u), (-v, u), (u, v), (-u, -v)]
        self.piece = Piece([(x1, y1), (x2, y2)], sides, 0.0)

    def owner(self, x: cython.double, y: cython.double) -> cython.int:
        """Return the number of the obstacle that it is of at a point."""
        found: cython.int = self.owners[0][1]
        if len(self.owners) == 1:
            return found
        along: cython.double = (x - self.x) * self.share_x + (y - self.y) * self.share_y
        along = along * length(self.edge_x, self.edge_y)
        for far, number in self.owners:
            if along >= far:
                found = number
        return found

    def hidden(self, body: Body) -> cython.bint:
        """Return whether a wall that it ends at keeps a body from it in the control step."""
        room: cython.double = body.radius + body.way
        for end_x, end_y, away_x, away_y, far in self.shades:
            x: cython.double = body.start_x - end_x
            y: cython.double = body.start_y - end_y
            if x * away_x + y * away_y > 0.0 and length(x, y) + room < far:
                return True
        return False

    def way(self, x: cython.double, y: cython.double) -> tuple[cython.double, cython.double]:
        """Return the shortest way from a point to it."""
        from_x: cython.double = x - self.x
        from_y: cython.double = y - self.y
        along: cython.double = from_x * self.share_x + from_y * self.share_y
        along = min(max(along, 0.0), 1.0)
        return along * self.edge_x - from_x, along * self.edge_y - from_y


@cython.cclass
class Pair:
    """A pair of discs, or of a disc and a wall, and the base of `PiecePair`.

    b: the second body; where there is none, the first one again, and a wall stands still.
    """

    a: Body
    b: Body
    is_wall: cython.bint
    wall: Wall
    other: cython.int  # the number of what the second is
    radii: cython.double  # of the circles round both
    gap: cython.double
    normal_x: cython.double
    normal_y: cython.double
    walled_in: object  # the walls of the solver in which the wall is
    start_gap: cython.double  # between the circles at the beginning of the control step
    next_touch: Pair | None  # the next pair that touches now with the same first body
    # where bodies that no forces act on touch
    point_x: cython.double
    point_y: cython.double
    into_a: cython.double
    into_b: cython.double

    def __init__(self, a: Body, b: Body, wall: Wall | None) -> None:
        """Take two bodies, or one twice and a wall."""
        self.a, self.b = a, b
        self.is_wall = wall is not None
        if wall is None:
            self.other, self.radii = b.number, a.radius + b.radius
        else:
            self.wall, self.other, self.radii = wall, wall.other, a.radius

    def apart(self) -> cython.double:
        """Return how far apart the circles were at the beginning of the control step."""
        x: cython.double = self.b.start_x - self.a.start_x
        y: cython.double = self.b.start_y - self.a.start_y
        if self.is_wall:
            x, y = self.wall.way(self.a.start_x, self.a.start_y)
        return length(x, y) - self.radii

    def parts(self) -> cython.bint:
        """Return whether its bodies move apart, but for what they turn."""
        apart: cython.double = -(self.a.vx * self.normal_x + self.a.vy * self.normal_y)
        if not self.is_wall:
            apart += self.b.vx * self.normal_x + self.b.vy * self.normal_y
        return apart > 1e-9

    def measure(self) -> cython.bint:
        """Measure the gap and the normal; return whether they touch."""
        if self.is_wall:
            x, y = self.wall.way(self.a.x, self.a.y)
        else:
            x, y = self.b.x - self.a.x, self.b.y - self.a.y
        far: cython.double = length(x, y)
        scale: cython.double = 1.0 / max(far, 1e-12)
        self.gap = far - self.radii
        self.normal_x, self.normal_y = x * scale, y * scale
        return self.gap <= 0

    def time_to_touch(self, h: cython.double, depth: cython.double) -> cython.double:
        """Return for how long they get no deeper than `depth`, or h if that is shorter.

        Along straight lines, the distance to a convex shape is a convex function of time, so it
        never falls faster than it does now. A pair that is already that deep may get a little
        deeper, so that the solver is called again soon after an impact that it could not stop.
        """
        x: cython.double = self.a.vx
        y: cython.double = self.a.vy
        turn: cython.double = self.a.acceleration
        if not self.is_wall:
            x = x - self.b.vx
            y = y - self.b.vy
            turn = turn + self.b.acceleration
        closing: cython.double = max(x * self.normal_x + y * self.normal_y, 0.0)
        room: cython.double = max(self.gap + depth, depth / 64)
        if closing * h + 0.5 * turn * h * h <= room:
            return h
        return min(h, time_to_close(room, closing, turn))

    def turns(self) -> cython.double:
        """Return how fast the normal turns, rad/s: as the line between the middles of discs."""
        x: cython.double = self.b.vx - self.a.vx
        y: cython.double = self.b.vy - self.a.vy
        return 0.0 if self.is_wall else abs(x * self.normal_y - y * self.normal_x) / self.radii

    def lay(self, room: cython.double) -> cython.void:
        """Note at corners which faces of two pieces go on in each other, but for this room."""

    def meet(self) -> cython.void:
        """Find the point where they touch, and how fast each moves into the other there."""
        self.point_x = self.a.x + self.a.radius * self.normal_x
        self.point_y = self.a.y + self.a.radius * self.normal_y
        self.into_b = self.a.vx * self.normal_x + self.a.vy * self.normal_y
        self.into_a = -(self.b.vx * self.normal_x + self.b.vy * self.normal_y)


def time_to_close(
    room: cython.double, closing: cython.double, turn: cython.double
) -> cython.double:
    """Return the time until closing t + turn t^2 / 2 = room; closing [m/s] may be negative."""
    bent: cython.double = 2 * turn * room
    quick: cython.double = abs(closing)
    total: cython.double = sqrt(closing * closing + bent) + quick
    if closing < 0:
        total = bent / max(total, 1e-24)  # root - |closing|, without cancellation
    return 2 * room / (total + 1e-12)


@cython.cclass
class PiecePair(Pair):
    """Two convex pieces.

    Source of the gap of pieces that overlap: the separating axis theorem, as in C. Ericson,
    Real-Time Collision Detection, section 5.2.1 (2005).
    """

    p: Piece
    q: Piece
    rounding: cython.double  # both radii
    # from the first body's pose to that of the second, or for a wall to the origin
    between_x: cython.double
    between_y: cython.double
    # the edge that parts them best: whose it is, its outward normal, how far it parts them
    of_second: cython.bint
    edge_x: cython.double
    edge_y: cython.double
    reach: cython.double
    parted: cython.double
    # the shortest way, and its square
    way_x: cython.double
    way_y: cython.double
    square: cython.double

    def __init__(self, a: Body, b: Body, wall: Wall | None, p: Piece, q: Piece) -> None:
        """Take the bodies or the wall, and a piece of each."""
        Pair.__init__(self, a, b, wall)
        self.p, self.q = p, q
        self.rounding = p.radius + q.radius

    def measure(self) -> cython.bint:
        """Measure the gap and the normal; return whether they touch."""
        self.between_x, self.between_y = -self.a.x, -self.a.y
        if not self.is_wall:
            self.between_x = self.b.x - self.a.x
            self.between_y = self.b.y - self.a.y
        self.parted = -1e300
        self.part(self.p, self.q, False)
        self.part(self.q, self.p, True)
        self.normal_x = -self.edge_x if self.of_second else self.edge_x
        self.normal_y = -self.edge_y if self.of_second else self.edge_y
        if self.parted <= 0.0 and self.parted > -1e300:
            self.gap = self.parted - self.rounding
            return self.gap <= 0
        self.square = 1e300
        self.approach(self.p, self.q, 1.0)
        self.approach(self.q, self.p, -1.0)
        far: cython.double = sqrt(self.square)
        # Between points that almost coincide, the axis is the more accurate direction.
        if far > 1e-7:
            self.normal_x, self.normal_y = self.way_x / far, self.way_y / far
        elif self.parted == -1e300:
            self.normal_x, self.normal_y = 1.0, 0.0
        self.gap = far - self.rounding
        return self.gap <= 0

    def part(self, p: Piece, q: Piece, second: cython.bint) -> cython.void:
        """Find out whether an edge of one piece parts it better from another than those before.

        second: whether p is the second piece of the pair.
        """
        x: cython.double = -self.between_x if second else self.between_x
        y: cython.double = -self.between_y if second else self.between_y
        for edge in p.edges:
            least: cython.double = 1e300
            for corner in q.corners:
                along: cython.double = (
                    edge.x * (corner.x + x) + edge.y * (corner.y + y) - edge.reach
                )
                if along < least:
                    least = along
                    if least <= self.parted:
                        break
            if least > self.parted:
                self.parted, self.of_second = least, second
                self.edge_x, self.edge_y, self.reach = edge.x, edge.y, edge.reach

    def approach(self, p: Piece, q: Piece, sign: cython.double) -> cython.void:
        """Find the shortest way from an edge of one piece to a corner of another.

        sign: 1 where p is the first piece, else -1.
        """
        x: cython.double = sign * self.between_x
        y: cython.double = sign * self.between_y
        last: Corner = p.corners[len(p.corners) - 1]
        for corner in p.corners:
            edge_x: cython.double = corner.x - last.x
            edge_y: cython.double = corner.y - last.y
            square: cython.double = edge_x * edge_x + edge_y * edge_y
            for other in q.corners:
                way_x: cython.double = other.x + x - last.x
                way_y: cython.double = other.y + y - last.y
                share: cython.double = 0.0
                if square > 0.0:
                    share = (way_x * edge_x + way_y * edge_y) / square
                    share = min(max(share, 0.0), 1.0)
                way_x = way_x - share * edge_x
                way_y = way_y - share * edge_y
                far: cython.double = way_x * way_x + way_y * way_y
                if far < self.square:
                    self.square = far
                    self.way_x, self.way_y = sign * way_x, sign * way_y
            last = corner

    def time_to_touch(self, h: cython.double, depth: cython.double) -> cython.double:
        """Return for how long they get no deeper than `depth`."""
        turning: cython.double = self.time_along_edge(h, depth)
        if turning >= h:
            return h
        return max(turning, self.time_along_normal(h, depth))

    def time_along_edge(self, h: cython.double, depth: cython.double) -> cython.double:
        """Return the time, at most h, that follows from the edge which parts them now.

        How far it parts them, turning with its body, is a lower bound of the gap at any time. As
        seen from there, a corner at d from the body's pose moves with d' and turns by at most both
        bends + spin^2 |d| + 2 |spin| |d'| + the corner's own spin^2 |r|.
        """
        # An edge that parts them less than they are apart says nothing once they would be too deep.
        floor: cython.double = depth / 256
        along: cython.double = self.parted - self.rounding
        if self.parted == -1e300 or (along + depth < floor and self.gap > along + 1e-9):
            return 0.0
        still: cython.bint = self.is_wall and self.of_second
        body: Body = self.b if self.of_second else self.a
        other: Body = self.a if self.of_second else self.b
        piece: Piece = self.p if self.of_second else self.q
        stands: cython.bint = self.is_wall and not self.of_second
        x: cython.double = -self.between_x if self.of_second else self.between_x
        y: cython.double = -self.between_y if self.of_second else self.between_y
        spin: cython.double = 0.0 if still else body.spin
        vx: cython.double = 0.0 if still else -body.vx
        vy: cython.double = 0.0 if still else -body.vy
        bends: cython.double = 0.0 if still else body.acceleration
        own: cython.double = 0.0
        if not stands:
            own = other.spin
            vx = vx + other.vx
            vy = vy + other.vy
            bends = bends + other.acceleration
        nx: cython.double = self.edge_x
        ny: cython.double = self.edge_y
        for corner in piece.corners:
            dx: cython.double = corner.x + x
            dy: cython.double = corner.y + y
            ux: cython.double = vx - own * corner.y
            uy: cython.double = vy + own * corner.x
            room: cython.double = max(nx * dx + ny * dy - self.reach - self.rounding + depth, floor)
            closing: cython.double = -(nx * ux + ny * uy) - spin * (nx * dy - ny * dx)
            turn: cython.double = bends + own * own * corner.lever
            if spin != 0.0:
                turn += spin * spin * length(dx, dy) + 2 * abs(spin) * length(ux, uy)
            if closing * h + 0.5 * turn * h * h > room:
                h = min(h, time_to_close(room, closing, turn))
        return h

    def time_along_normal(self, h: cython.double, depth: cython.double) -> cython.double:
        """Return the time, at most h, that follows from the present normal.

        The distance along it is a lower bound of the gap at any time. A corner at r from its body's
        pose moves with velocity + i spin r, which turns by at most its acceleration + spin^2 |r|.
        """
        floor: cython.double = depth / 256
        base: cython.double = (
            self.normal_x * self.between_x + self.normal_y * self.between_y - self.rounding
        )
        nx: cython.double = self.normal_x
        ny: cython.double = self.normal_y
        a: Body = self.a
        b: Body = self.b
        for corner in self.p.corners:
            place: cython.double = nx * corner.x + ny * corner.y
            speed: cython.double = nx * a.vx + ny * a.vy + a.spin * (ny * corner.x - nx * corner.y)
            turn: cython.double = a.acceleration + a.spin * a.spin * corner.lever
            for other in self.q.corners:
                room: cython.double = nx * other.x + ny * other.y - place + base + depth
                closing: cython.double = speed
                turns: cython.double = turn
                if not self.is_wall:
                    closing = closing - (
                        nx * b.vx + ny * b.vy + b.spin * (ny * other.x - nx * other.y)
                    )
                    turns = turns + b.acceleration + b.spin * b.spin * other.lever
                room = max(room, floor)
                if closing * h + 0.5 * turns * h * h > room:
                    h = min(h, time_to_close(room, closing, turns))
        return h

    def turns(self) -> cython.double:
        """Return how fast the normal turns, rad/s: with the body whose edge parts them."""
        if self.is_wall and self.of_second:
            return 0.0
        return abs(self.b.spin if self.of_second else self.a.spin)

    def lay(self, room: cython.double) -> cython.void:
        """Note at corners which faces of two pieces go on in each other, but for this room."""
        x: cython.double = self.between_x
        y: cython.double = self.between_y
        if lay(self.p, self.q, x, y, self.b.number, room):
            chipmunk.set_type(self.p.shape, library.JOINED)
            self.a.laid = True
        if lay(self.q, self.p, -x, -y, self.a.number, room):
            chipmunk.set_type(self.q.shape, library.JOINED)
            self.b.laid = True

    def meet(self) -> cython.void:
        """Find the middle of their common face, and how fast each moves into the other there.

        Corners within 1 mm of a surface belong to the face.
        """
        nx: cython.double = self.normal_x
        ny: cython.double = self.normal_y
        front: cython.double = self.p.front(nx, ny)
        back: cython.double = -self.q.front(-nx, -ny)
        low: cython.double = 1e300
        high: cython.double = -1e300
        self.into_b = self.into_a = -1e300
        for corner in self.p.corners:
            if nx * corner.x + ny * corner.y < front - 1e-3:
                continue
            along = nx * corner.y - ny * corner.x
            low, high = min(low, along), max(high, along)
            speed = nx * self.a.vx + ny * self.a.vy
            speed += self.a.spin * (ny * corner.x - nx * corner.y)
            self.into_b = max(self.into_b, speed)
        other_low: cython.double = 1e300
        other_high: cython.double = -1e300
        for corner in self.q.corners:
            if nx * corner.x + ny * corner.y > back + 1e-3:
                continue
            along = nx * (corner.y + self.between_y) - ny * (corner.x + self.between_x)
            other_low, other_high = min(other_low, along), max(other_high, along)
            speed = nx * self.b.vx + ny * self.b.vy
            speed += self.b.spin * (ny * corner.x - nx * corner.y)
            self.into_a = max(self.into_a, -speed)
        out: cython.double = front + self.p.radius
        along = (max(low, other_low) + min(high, other_high)) / 2
        self.point_x = self.a.x + nx * out - ny * along
        self.point_y = self.a.y + ny * out + nx * along
