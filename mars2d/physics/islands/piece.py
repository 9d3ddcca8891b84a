"""A piece: a convex part of a body or wall, with its corners and edges."""

from __future__ import annotations

from typing import Any

from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import length
from mars2d.physics.islands.library import Handle


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

    def front(self, x: cython.double, y: cython.double) -> cython.double:
        """Return how far its corners reach from the body's pose in a direction, metres."""
        front: cython.double = -1e300
        for corner in self.corners:
            front = max(front, x * corner.x + y * corner.y)
        return front

    def turn(self, c: cython.double, s: cython.double) -> cython.void:
        """Turn it by an angle of this cosine and sine from its body's frame."""
        for corner in self.corners:
            corner.x = c * corner.local_x - s * corner.local_y
            corner.y = s * corner.local_x + c * corner.local_y
        for edge in self.edges:
            edge.x = c * edge.local_x - s * edge.local_y
            edge.y = s * edge.local_x + c * edge.local_y
