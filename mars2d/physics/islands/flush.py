"""Flush: pieces that lie side by side with their faces in one plane, and what slides over them.

What slides over a piece overlaps it a little. So it meets the next one from the side, less deep
than from above, and the engine would throw it back. Where a face goes on in that of another piece,
a contact that leans over its end is not real: the face pushes the corner that is deepest in it, or
if none is, nothing. What overlaps the face by more than a step that is not felt meets its side.
"""

from __future__ import annotations

from mars2d.physics.islands import chipmunk, library
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.library import Arbiter, Handle, Vector
from mars2d.physics.islands.piece import Corner, Edge, Piece

PARALLEL = 0.9999
"""The cosine from which on two faces are parallel."""

UPRIGHT = 0.999
"""The cosine from which on a normal counts as that of a face."""

ACROSS = 0.1
"""The sine from which on two faces ask for different normals."""

LEANS = 1e-9
"""The sine from which on a normal leans over the end of a face."""


def lay(
    p: Piece, q: Piece, x: cython.double, y: cython.double, number: cython.int, room: cython.double
) -> cython.bint:
    """Note which faces of a piece go on in another; return whether there are any.

    x, y: from the pose of p's body to that of q's. number: that of q's. room: up to which the faces
    may be off.
    """
    found: cython.bint = False
    for k in range(len(p.edges)):
        face: Edge = p.edges[k]
        start: Corner = p.corners[k]
        end: Corner = p.corners[(k + 1) % len(p.corners)]
        for i in range(len(q.edges)):
            other: Edge = q.edges[i]
            if face.x * other.x + face.y * other.y < PARALLEL:
                continue
            first: Corner = q.corners[i]
            last: Corner = q.corners[(i + 1) % len(q.corners)]
            far: cython.double = face.x * (end.y - start.y) - face.y * (end.x - start.x)
            to_x: cython.double = first.x + x - start.x
            to_y: cython.double = first.y + y - start.y
            low: cython.double = face.x * to_y - face.y * to_x
            first_above: cython.double = face.x * to_x + face.y * to_y
            to_x, to_y = last.x + x - start.x, last.y + y - start.y
            high: cython.double = face.x * to_y - face.y * to_x
            last_above: cython.double = face.x * to_x + face.y * to_y
            if abs(first_above) <= room and low <= far + room < high:
                end.ends_in, found = number, True
            if abs(last_above) <= room and low < -room <= high:
                start.starts_in, found = number, True
    return found


@cython.cclass
class Flush:
    """A piece of a body, and what straightens its contacts.

    room: how deep a corner may be in a face that is put back out of it, metres.
    """

    piece: Piece
    room: cython.double
    handle: object  # by which the engine finds it, in Python
    # what a face asks for: its normal, how deep the deepest corner is in it, and where that is
    x: cython.double
    y: cython.double
    leans: cython.bint  # whether the contact is not its own
    deepest: cython.double
    px: cython.double
    py: cython.double

    def __init__(self, piece: Piece, room: float) -> None:
        """Take the piece, and `room`."""
        self.piece, self.room = piece, room

    def straighten(self, arbiter: Arbiter) -> cython.void:
        """Look at a contact of two bodies before it is solved. It is that of the first shape.

        Where three corners meet, faces of both may ask for it. Then it is left out, since both
        bodies are held by the third.
        """
        other: Flush = flush_of(arbiter, True)
        if arbiter.count == 0:
            return
        asks: cython.bint = self.look(arbiter, other.piece, False)
        if not other.look(arbiter, self.piece, True):
            if asks:
                self.correct(arbiter, other.piece, False)
        elif not asks:
            other.correct(arbiter, self.piece, True)
        elif abs(self.x * other.y - self.y * other.x) > ACROSS:
            arbiter.count = 0
        else:
            self.correct(arbiter, other.piece, False)

    def look(self, arbiter: Arbiter, slider: Piece, second: cython.bint) -> cython.bint:
        """Return whether a face that goes on elsewhere asks for a contact.

        second: whether it is the second shape.
        """
        by: cython.int = chipmunk.first_of(arbiter) if second else chipmunk.second_of(arbiter)
        found: cython.bint = False
        for k in range(len(self.piece.corners)):
            corner: Corner = self.piece.corners[k]
            if corner.ends_in >= 0 and corner.ends_in != by:
                found = self.asks(arbiter, slider, second, k, False) or found
            if corner.starts_in >= 0 and corner.starts_in != by and not (found and self.leans):
                found = self.asks(arbiter, slider, second, k, True) or found
            if found and self.leans:
                return True
        return found

    def asks(
        self,
        arbiter: Arbiter,
        slider: Piece,
        second: cython.bint,
        k: cython.int,
        starts: cython.bint,
    ) -> cython.bint:
        """Return whether a contact leans over a face's end, or is its own.

        k: the number of the corner at its end. starts: whether it starts there.
        """
        count: cython.int = len(self.piece.corners)
        turn: cython.double = -1.0 if starts else 1.0
        end: Corner = self.piece.corners[k]
        start: Corner = self.piece.corners[(k + 1 if starts else k + count - 1) % count]
        shape: Handle = chipmunk.shape_of(arbiter, second)
        a: Vector = chipmunk.place_of(shape, start.local_x, start.local_y)
        b: Vector = chipmunk.place_of(shape, end.local_x, end.local_y)
        far: cython.double = length(b.x - a.x, b.y - a.y)
        ux: cython.double = (b.x - a.x) / far
        uy: cython.double = (b.y - a.y) / far
        normal: Vector = arbiter.n
        sign: cython.double = -1.0 if second else 1.0
        fx: cython.double = turn * uy
        fy: cython.double = -turn * ux
        leans: cython.bint = sign * (normal.x * ux + normal.y * uy) > LEANS
        if not leans and sign * (normal.x * fx + normal.y * fy) < UPRIGHT:
            return False
        shape = chipmunk.shape_of(arbiter, not second)
        lowest: cython.double = -1e300
        deepest: cython.double = -1.0
        px: cython.double = 0.0
        py: cython.double = 0.0
        for corner in slider.corners:
            at: Vector = chipmunk.place_of(shape, corner.local_x, corner.local_y)
            x: cython.double = at.x - slider.radius * fx
            y: cython.double = at.y - slider.radius * fy
            depth: cython.double = (b.x - x) * fx + (b.y - y) * fy
            along: cython.double = (x - a.x) * ux + (y - a.y) * uy
            lowest = max(lowest, depth)
            if depth > deepest and depth >= 0.0 and 0.0 <= along <= far + self.room / 8:
                deepest, px, py = depth, x, y
        if lowest > self.room:
            return False
        self.leans, self.x, self.y = leans, fx, fy
        self.deepest, self.px, self.py = deepest, px, py
        return True

    def correct(self, arbiter: Arbiter, slider: Piece, second: cython.bint) -> cython.void:
        """Let the face that has asked for a contact push, or leave it out."""
        if not self.leans:
            return
        normal: Vector = arbiter.n
        sign: cython.double = -1.0 if second else 1.0
        nx: cython.double = sign * self.x
        ny: cython.double = sign * self.y
        upright: cython.bint = normal.x * nx + normal.y * ny > UPRIGHT and slider.radius == 0.0
        if self.deepest < 0.0 and not upright:
            arbiter.count = 0
            return
        arbiter.n.x, arbiter.n.y = nx, ny
        if upright:
            return
        x: cython.double = self.px + self.deepest * self.x
        y: cython.double = self.py + self.deepest * self.y
        if second:
            chipmunk.put_point(arbiter, self.px, self.py, x, y)
        else:
            chipmunk.put_point(arbiter, x, y, self.px, self.py)


def flush_of(arbiter: Arbiter, second: cython.bint) -> Flush:
    """Return what was shown of a contact's first or second shape."""
    flush: Flush = library.thing_at(chipmunk.data_of(chipmunk.shape_of(arbiter, second)))
    return flush


@library.callback("void(cpArbiter *, cpSpace *, void *)")
def straighten_contact(arbiter: Arbiter, _space: Handle, _data: Handle) -> cython.void:
    """Let the pieces of two bodies straighten a contact before it is solved."""
    if chipmunk.first_of(arbiter) >= 0 and chipmunk.second_of(arbiter) >= 0:
        flush: Flush = flush_of(arbiter, False)
        flush.straighten(arbiter)
