"""Seams: where walls meet, so that nothing trips over their ends.

A contact at an end is real only if its normal points to where none of the walls that meet there is
nearer: it lies between the normals of both if their corner bulges, and else is that of the wall's
face. Another one is made that of the face, with the body's corner that is deepest in the wall. If
no corner is in it, the contact is left out: the other wall has one.

Source of the normals that are real: the Voronoi regions of a polygon's corner and edges, as in C.
Ericson, Real-Time Collision Detection, section 9.5.1 (2005).
"""

from __future__ import annotations

from mars2d.physics.islands import chipmunk, library
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.library import Arbiter, Handle, Vector

STRAIGHT = 1e-9
"""The sine up to which a contact's normal stands upright on a wall."""

NEARLY = 0.999
"""The cosine from which on it counts as that of the wall's face in a corner."""

FREE = 0.0
BULGES = 1.0
"""What there is at an end of a wall on one side: nothing, a corner that bulges; 2 is any other."""


@cython.cclass
class Seams:
    """What contacts with a wall must know of its ends, and one of these that is looked at.

    reach: how deep in the wall a corner may be that is put back out of it, metres. met: three
    numbers each for the start, to the left and to the right, and for the end: what is there, 0 for
    nothing, 1 for a corner that bulges, else 2; and the direction of the wall that is met there.
    """

    x: cython.double
    y: cython.double
    ux: cython.double
    uy: cython.double
    far: cython.double
    reach: cython.double
    met: list[float]
    handle: object  # by which the engine finds it, in Python
    # of a contact: how many corners the body has, or 0, the way to its middle from the start, or
    # where that is unknown the normal; and from where to where it is on the wall's line
    corners: cython.int
    dx: cython.double
    dy: cython.double
    low: cython.double
    high: cython.double

    def __init__(self, numbers: list[float]) -> None:
        """Take x, y of the start, the direction, the length, and the twelve of `met`."""
        self.x, self.y, self.ux, self.uy, self.far = numbers[:5]
        self.met = numbers[5:]

    def correct(self, arbiter: Arbiter, is_first: cython.bint) -> cython.void:
        """Look at a contact before it is solved. is_first: whether the wall is its first shape."""
        shape: Handle = chipmunk.shape_of(arbiter, True)
        normal: Vector = arbiter.n
        nx: cython.double = normal.x if is_first else -normal.x
        ny: cython.double = normal.y if is_first else -normal.y
        self.corners = chipmunk.corners_of(shape) if is_first else 0
        self.dx, self.dy, self.low, self.high = nx, ny, 1e300, -1e300
        if self.corners > 0:
            self.pass_round(shape)
        along: cython.double = nx * self.ux + ny * self.uy
        upright: cython.bint = -STRAIGHT <= along <= STRAIGHT
        at_start: cython.bint = self.low < self.high < self.reach
        at_end: cython.bint = self.far - self.reach < self.low < self.high
        if at_start and at_end and upright:
            at_end = self.dx * self.ux + self.dy * self.uy > self.far / 2
        elif at_start == at_end:
            if upright:
                return
            at_end = along > 0.0
        if self.corners > 0 and at_end:  # as seen from the end where they touch
            self.dx, self.dy = self.dx - self.far * self.ux, self.dy - self.far * self.uy
        end: cython.int = 6 if at_end else 0
        turn: cython.double = -1.0 if at_end else 1.0
        if self.met[end] == FREE:
            return
        right: cython.bint = not self.holds(end, turn, turn)
        if right and not self.holds(end + 3, -turn, turn):  # it is beyond what is met there
            arbiter.count = 0
            return
        fx: cython.double = self.uy if right else -self.uy
        fy: cython.double = -self.ux if right else self.ux
        if right:
            end += 3
        bulges: cython.bint = self.met[end] == BULGES
        if upright:
            if nx * fx + ny * fy > 0.0:
                return
        elif bulges and nx * self.met[end + 1] + ny * self.met[end + 2] <= STRAIGHT:
            return
        elif not bulges and nx * fx + ny * fy > NEARLY and self.corners > 0:
            arbiter.n.x, arbiter.n.y = fx, fy
            return
        self.put_out(arbiter, shape, 3 if right else 0, fx, fy)

    def pass_round(self, shape: Handle) -> cython.void:
        """Find the middle of a polygon as seen from the start, and where the line is in it."""
        corner: Vector = chipmunk.corner_of(shape, self.corners - 1)
        above: cython.double = (corner.y - self.y) * self.ux - (corner.x - self.x) * self.uy
        at: cython.double = (corner.x - self.x) * self.ux + (corner.y - self.y) * self.uy
        self.dx = self.dy = 0.0
        for k in range(self.corners):
            before: cython.double = above
            last_at: cython.double = at
            corner = chipmunk.corner_of(shape, k)
            self.dx += (corner.x - self.x) / self.corners
            self.dy += (corner.y - self.y) / self.corners
            above = (corner.y - self.y) * self.ux - (corner.x - self.x) * self.uy
            at = (corner.x - self.x) * self.ux + (corner.y - self.y) * self.uy
            if (before < 0.0) != (above < 0.0):
                crossed: cython.double = last_at + before / (before - above) * (at - last_at)
                self.low, self.high = min(self.low, crossed), max(self.high, crossed)

    def holds(self, end: cython.int, turn: cython.double, own: cython.double) -> cython.bint:
        """Return whether the body lies between the wall and its neighbour on one side of an end.

        own: 1 if the wall leads from that end in its direction, else -1.
        """
        own_x: cython.double = own * self.ux
        own_y: cython.double = own * self.uy
        past: cython.bint = turn * (own_x * self.dy - own_y * self.dx) >= 0.0
        other: cython.double = self.dx * self.met[end + 2] - self.dy * self.met[end + 1]
        before: cython.bint = turn * other >= 0.0
        return past or before if self.met[end] == BULGES else past and before

    def put_out(
        self,
        arbiter: Arbiter,
        shape: Handle,
        side: cython.int,
        fx: cython.double,
        fy: cython.double,
    ) -> cython.void:
        """Let the wall's face push the corner that is deepest in it, or nothing.

        In a corner that does not bulge, what is behind the wall that is met there counts as well.
        side: 0 left, 3 right.
        """
        least: cython.double = -self.reach if self.met[side] > BULGES else 0.0
        most: cython.double = self.far
        if self.met[6 + side] > BULGES:
            most = self.far + self.reach
        deepest: cython.double = -1.0
        px: cython.double = 0.0
        py: cython.double = 0.0
        for k in range(self.corners):
            corner: Vector = chipmunk.corner_of(shape, k)
            at: cython.double = (corner.x - self.x) * self.ux + (corner.y - self.y) * self.uy
            depth: cython.double = (self.x - corner.x) * fx + (self.y - corner.y) * fy
            if least <= at <= most and deepest < depth <= self.reach and depth >= 0.0:
                deepest, px, py = depth, corner.x, corner.y
        if deepest < 0.0:
            arbiter.count = 0
            return
        arbiter.n.x, arbiter.n.y = fx, fy
        chipmunk.put_point(arbiter, px + deepest * fx, py + deepest * fy, px, py)


@library.callback("void(cpArbiter *, cpSpace *, void *)")
def correct_contact(arbiter: Arbiter, _space: Handle, _data: Handle) -> cython.void:
    """Let the seams of a wall correct a contact with it before it is solved."""
    is_first: cython.bint = chipmunk.first_of(arbiter) < 0
    seams: Seams = library.thing_at(chipmunk.data_of(chipmunk.shape_of(arbiter, not is_first)))
    seams.correct(arbiter, is_first)
