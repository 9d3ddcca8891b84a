"""Neighbours: pairs of bodies that may touch soon: a Verlet list, so that few gaps are measured.

A pair that is not listed was so far apart when the list was made that both bodies would have to
move by the `skin` first. Walls are listed for each body by itself, since they stand still.

Source of the list: L. Verlet, Physical Review 159, 98 (1967).
"""

from __future__ import annotations

from math import floor
from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.pair import Pair, PiecePair, Wall

FEW = 32
"""Up to this number of bodies, all pairs are listed once and for all."""

FEW_WALLS = 8
"""And up to this number of walls, those of each body."""


@cython.cclass
class Neighbours:
    """The pairs of some bodies and walls that may touch soon."""

    bodies: list[Body]
    walls: list[Wall]
    passing: set[Any]  # pairs (i, j) that pass through each other
    pairs: list[Pair]
    skin: cython.double
    largest: cython.double  # radius
    # cells of a torus, so that there are few however far apart bodies are
    wide: cython.int
    size: cython.double
    first: list[int]

    def __init__(self, bodies: list[Body], walls: list[Wall], passing: set[Any]) -> None:
        """Take bodies, walls, and pairs of bodies that pass through each other."""
        self.bodies, self.walls, self.passing = bodies, walls, passing
        self.pairs, self.first = [], []
        self.largest = max([body.radius for body in bodies])
        self.size = 1.0
        self.wide = 3 + int((4.0 * len(bodies)) ** 0.5)
        self.skin = -1.0
        for a in bodies:
            a.wall_gap, a.wall_skin = -1.0 if walls else 1e300, -1.0
        if len(bodies) <= FEW:
            self.skin = 1e300
            for a in self.bodies:
                for b in self.bodies[a.number + 1 :]:
                    self.add(a, b)

    def rest(self) -> cython.void:
        """Forget the pairs, whose order follows from when they were listed, unless they are all."""
        if self.skin < 1e300:
            self.pairs, self.skin = [], -1.0

    def add(self, a: Body, b: Body) -> cython.void:
        """List a pair of bodies, a before b."""
        if self.passing and (a.number, b.number) in self.passing:
            return
        if a.is_disc and b.is_disc:
            self.pairs.append(Pair(a, b, None))
            return
        for p in a.pieces:
            for q in b.pieces:
                self.pairs.append(PiecePair(a, b, None, p, q))

    def refresh(self) -> cython.void:
        """List pairs again, and measure them, if a body may move farther than the skin."""
        for body in self.bodies:
            if body.moved + body.way > self.skin:
                self.list_pairs()
                self.measure()
                return

    def measure(self) -> cython.void:
        """Measure how far apart the circles of all listed pairs are."""
        for pair in self.pairs:
            pair.start_gap = pair.apart()

    def advance(self) -> cython.void:
        """Note that bodies may have moved by their ways."""
        for body in self.bodies:
            body.moved += body.way
            body.wall_gap -= body.way
            body.wall_skin -= body.way

    # -- walls --------------------------------------------------------------------------------

    def at_wall(self, body: Body) -> cython.bint:
        """Return whether a body may touch a wall within its way."""
        if body.wall_gap > body.way:
            return False
        if body.way > body.wall_skin:
            self.list_walls(body)
        least: cython.double = body.wall_skin
        for pair in body.wall_pairs:
            least = min(least, pair.apart())
        body.wall_gap = least
        return least <= body.way

    def list_walls(self, body: Body) -> cython.void:
        """List the walls near a body, with a skin that lasts for many control steps."""
        body.wall_pairs = []
        body.wall_skin = 1e300
        if len(self.walls) > FEW_WALLS:
            body.wall_skin = max(32 * body.way, 4 * body.radius)
        for wall in self.walls:
            x, y = wall.way(body.start_x, body.start_y)
            if length(x, y) - body.radius > body.wall_skin:
                continue
            if body.is_disc:
                body.wall_pairs.append(Pair(body, body, wall))
            else:
                for piece in body.pieces:
                    body.wall_pairs.append(PiecePair(body, body, wall, piece, wall.piece))

    # -- pairs --------------------------------------------------------------------------------

    def list_pairs(self) -> cython.void:
        """List the pairs again, with a skin that lasts for several control steps."""
        furthest: cython.double = 0.0
        for body in self.bodies:
            furthest = max(furthest, body.way)
            body.moved = 0.0
        self.skin = 2 * max(4 * furthest, self.largest)
        cutoff: cython.double = 2 * self.largest + 2 * self.skin
        self.fill_cells(cutoff * (1 + 1e-6))  # columns within it differ by 1, however rounded
        self.pairs = []
        for body in self.bodies:
            self.list_near(body, cutoff)

    def column(self, x: cython.double) -> cython.int:
        """Return the column, or row, of cells that a coordinate is in."""
        at: cython.double = floor(x / self.size)
        at = at - self.wide * floor(at / self.wide)
        return int(at) if 0 < at < self.wide else 0

    def fill_cells(self, size: cython.double) -> cython.void:
        """Sort the bodies into cells of this size, so that each cell's list ascends."""
        self.size = size
        self.first = [-1] * (self.wide * self.wide)
        for body in self.bodies[::-1]:
            body.cell = self.column(body.start_y) * self.wide + self.column(body.start_x)
            body.next = self.first[body.cell]
            self.first[body.cell] = body.number

    def list_near(self, a: Body, cutoff: cython.double) -> cython.void:
        """List a body's pairs with others of larger numbers."""
        wide: cython.int = self.wide
        row: cython.int = a.cell // wide
        column: cython.int = a.cell - row * wide
        for v in range(-1, 2):
            for u in range(-1, 2):
                cell: cython.int = ((row + v + wide) % wide) * wide + (column + u + wide) % wide
                j: cython.int = self.first[cell]
                while j >= 0:
                    b = self.bodies[j]
                    if j > a.number and length(a.start_x - b.start_x, a.start_y - b.start_y) <= (
                        cutoff
                    ):
                        self.add(a, b)
                    j = b.next
