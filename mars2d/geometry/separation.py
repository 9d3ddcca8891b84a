"""The separation of convex pieces: polygons, walls and discs.

A piece is the hull of its vertices, enlarged by a radius: a disc has one vertex, a wall two, a
polygon three or more and radius 0. Points are complex numbers x + i y, in metres.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, inf, sin

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import TINY, dot, length

__all__ = ["ConvexPairs", "Pieces"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

MIN_SPAN = 1e-7
"""Two points nearer than this do not define a direction, metres."""


class Pieces:
    """P convex pieces, in the frames of their bodies, or in the world's if they stand still.

    Values that depend on the shapes alone are computed once: the vertices and edges of each piece,
    and its axes, the directions in which it may be separated from another piece.
    """

    def __init__(self, vertices: Sequence[Complex], radius: Float) -> None:
        """Take the vertices of each piece, convex and counter-clockwise, and the radii (P,)."""
        corners = [np.asarray(points, dtype=np.complex128) for points in vertices]
        edges = [np.roll(points, -1) - points for points in corners]
        axes = [_axes(edge) for edge in edges]
        self._radius = np.asarray(radius, dtype=np.float64)
        self._corners = np.array([len(points) for points in corners], dtype=np.intp)
        self._directions = np.array([len(axis) for axis in axes], dtype=np.intp)
        # Smaller pieces repeat their last vertex and axis, and have edges of length zero.
        self._vertex = _columns(corners, [points[-1] for points in corners])
        self._edge = _columns(edges, [0j] * len(edges))
        self._axis = _columns(axes, [axis[-1] for axis in axes])
        along = dot(self._axis[:, None], self._vertex[None])
        self._reach = np.asarray(along.max(axis=1))  # from the frame's origin, along each axis

    def local(self, which: Index) -> tuple[int, Complex, Float]:
        """Return the local vectors of some pieces (...), as K, (3 K + L, ...) and (L, ...).

        The first value is the largest number of vertices. The second holds the vertices, the edges,
        the edges divided by their squared lengths, and the axes. The third is the extent of the
        pieces along their axes.
        """
        k = int(self._corners[which].max(initial=1))
        edge = self._edge[:k, which]
        square = dot(edge, edge)
        per_length = edge / np.where(square > 0, square, 1.0)
        directions = int(self._directions[which].max(initial=1))
        axis = self._axis[:directions, which]
        parts = np.concatenate([self._vertex[:k, which], edge, per_length, axis])
        return k, parts, self._reach[:directions, which]

    def radius(self, which: Index) -> Float:
        """Return the radii of some pieces, metres."""
        return np.asarray(self._radius[which])


class ConvexPairs:
    """M pairs of convex pieces that are close to each other, and their gaps as they move.

    pairs: the indices of the pieces, (M,) and (M,), as given. `measure` sets

    - gap: (M,) metres, the distance between the two pieces; negative if they overlap: the
      distance by which one has to be moved to separate them;
    - normal: (M,) unit vectors from the first piece to the second, along the shortest way between
      them, or out of each other;
    - touch: (M,) whether the gap is zero or less; any_touch: whether any gap is.

    Source of the gap of pieces that overlap: the separating axis theorem, as in C. Ericson,
    Real-Time Collision Detection, section 5.2.1 (2005).
    """

    gap: Float
    normal: Complex
    touch: Mask
    any_touch: bool

    def __init__(self, pieces: Pieces, body: Index, pairs: tuple[Index, Index]) -> None:
        """Take pairs of pieces, (M,) and (M,), and the bodies (P,) to which all pieces belong.

        body: indices into the arrays given to `measure` and `time_to_touch`; negative for pieces
        that stand still.
        """
        self.pairs = pairs
        # An axis of length two holds the first pieces of the pairs, then the second ones.
        both = np.stack(pairs)
        self._bodies = body[both]
        self._mover = np.maximum(self._bodies, -1)
        self._k, local, self._reach = pieces.local(both)
        self._local_x, self._local_y = local.real.copy(), local.imag.copy()
        self._lever = length(local[: self._k])
        self._own_radius = pieces.radius(both)
        self._radii = self._own_radius.sum(axis=0)
        self._column = np.arange(len(self._radii))

    def __len__(self) -> int:
        return len(self._radii)

    def measure(self, position: Complex, angle: Float) -> None:
        """Take the bodies' positions (k,) in metres and angles (k,) in rad; measure all gaps."""
        # The last column, with the index -1, is for pieces that stand still.
        where = np.zeros((4, len(position) + 1))
        where[0, :-1], where[1, :-1] = position.real, position.imag
        angles = angle.tolist()
        where[2, :-1], where[2, -1] = [cos(a) for a in angles], 1.0
        where[3, :-1] = [sin(a) for a in angles]
        x, y, c, s = where.take(self._mover, axis=1)
        self._x = c * self._local_x - s * self._local_y
        self._y = s * self._local_x + c * self._local_y
        self._base_x, self._base_y = x[0], y[0]
        to_other_x, to_other_y = x[::-1] - x, y[::-1] - y
        self._between_x, self._between_y = to_other_x[0], to_other_y[0]
        k = self._k
        # the vertices of each piece, as seen from the body of the other
        seen_x, seen_y = self._x[:k, ::-1] + to_other_x, self._y[:k, ::-1] + to_other_y
        separation, axis_x, axis_y = self._separate(seen_x, seen_y)
        way_x, way_y = self._shortest_way(seen_x, seen_y)
        distance = np.hypot(way_x, way_y)
        apart = separation > 0
        self.gap = np.where(apart, distance, separation) - self._radii
        # Between points that almost coincide, the axis is the more accurate direction.
        use_way = apart & (distance > MIN_SPAN)
        scale = np.maximum(distance, MIN_SPAN)
        self.normal = np.empty(len(self), dtype=np.complex128)
        self.normal.real = np.where(use_way, way_x / scale, axis_x)
        self.normal.imag = np.where(use_way, way_y / scale, axis_y)
        self.touch = self.gap <= 0
        self.any_touch = bool(self.touch.any())

    def _separate(self, x: Float, y: Float) -> tuple[Float, Float, Float]:
        """Return the largest separation along an axis, and that axis, each (M,).

        x, y: (K, 2, M) the vertices of each piece as seen from the body of the other.
        """
        axis_x, axis_y = self._x[3 * self._k :], self._y[3 * self._k :]
        along = axis_x[:, None] * x + axis_y[:, None] * y
        separation = along.min(axis=1) - self._reach
        separation = separation.reshape(2 * len(self._reach), len(self))
        widest = separation.argmax(axis=0)
        sign = 1.0 - 2.0 * (widest & 1)  # the axes of the second piece point to the first
        picked = widest, self._column
        axis_x, axis_y = (axis_x.reshape(separation.shape), axis_y.reshape(separation.shape))
        return separation[picked], sign * axis_x[picked], sign * axis_y[picked]

    def _shortest_way(self, x: Float, y: Float) -> tuple[Float, Float]:
        """Return the shortest vectors from the first to the second piece if they are apart, (M,).

        They lead from an edge to a vertex. x, y: as in `_separate`.
        """
        k = self._k
        edge_x, edge_y = self._x[k : 2 * k, None], self._y[k : 2 * k, None]
        way_x, way_y = x - self._x[:k, None], y - self._y[:k, None]
        share = way_x * self._x[2 * k : 3 * k, None]
        share += way_y * self._y[2 * k : 3 * k, None]
        np.minimum(np.maximum(share, 0.0, out=share), 1.0, out=share)
        way_x -= share * edge_x
        way_y -= share * edge_y
        shape = 2 * k * k, len(self)
        way_x, way_y = way_x.reshape(shape), way_y.reshape(shape)
        shortest = (way_x * way_x + way_y * way_y).argmin(axis=0)
        sign = 1.0 - 2.0 * (shortest & 1)
        picked = shortest, self._column
        return sign * way_x[picked], sign * way_y[picked]

    def touching_bodies(self) -> tuple[Index, Index]:
        """Return the bodies of the pairs that touch."""
        first, second = self._bodies[:, self.touch]
        return first, second

    def touching_points(self, depth: float) -> Complex:
        """Return the points (m,) of touch of the touching pairs: the middles of common faces.

        depth: metres; vertices at most this far from the surface belong to the face.
        """
        touch = self.touch
        nx, ny = self.normal.real[touch], self.normal.imag[touch]
        x, y = self._x[: self._k, :, touch].copy(), self._y[: self._k, :, touch].copy()
        x[:, 1] += self._between_x[touch]
        y[:, 1] += self._between_y[touch]
        out, along = nx * x + ny * y, nx * y - ny * x
        front = out[:, 0].max(axis=0)
        on_first = out[:, 0] >= front - depth
        on_second = out[:, 1] <= out[:, 1].min(axis=0) + depth
        faces = np.stack([on_first, on_second], axis=1)
        low = np.where(faces, along, inf).min(axis=0).max(axis=0)
        high = np.where(faces, along, -inf).max(axis=0).min(axis=0)
        out, along = front + self._own_radius[0, touch], (low + high) / 2
        px, py = nx * out - ny * along, ny * out + nx * along
        return np.asarray(px + self._base_x[touch] + 1j * (py + self._base_y[touch]))

    def inwards(self, velocity: Complex, spin: Float, depth: float) -> tuple[Float, Float]:
        """Return the speeds at which the two of each touching pair move into each other, (m,) m/s.

        depth: metres; vertices at most this far from the surface belong to the face.
        """
        motion = np.zeros((3, len(velocity) + 1))
        motion[0, :-1], motion[1, :-1], motion[2, :-1] = (velocity.real, velocity.imag, spin)
        vx, vy, omega = motion.take(self._mover, axis=1)
        sign = np.array([[1.0], [-1.0]])
        nx, ny = sign * self.normal.real, sign * self.normal.imag
        x, y = self._x[: self._k], self._y[: self._k]
        out = nx * x + ny * y
        speed = nx * vx + ny * vy + omega * (ny * x - nx * y)
        fastest = np.where(out >= out.max(axis=0) - depth, speed, -inf).max(axis=0)
        first, second = fastest[:, self.touch]
        return first, second

    def time_to_touch(
        self, velocity: Complex, spin: Float, bend: Float, depth: float, *, again: bool = True
    ) -> float:
        """Return a time during which no pair gets deeper than `depth`, seconds: a lower bound.

        A pair that is already that deep may get a little deeper, like two discs. Without `again`,
        touching pairs are left out.

        velocity: (k,) of the bodies. spin: (k,) rad/s, constant. bend: (k,) m/s^2, a bound on the
        rate at which each velocity turns.

        The distance along the present normal is a lower bound of the gap at any time. A vertex at r
        from its body's position moves with velocity + i spin r, which turns by at most
        bend + spin^2 |r|.
        """
        if not len(self):
            return inf
        motion = np.zeros((4, len(velocity) + 1))
        motion[0, :-1], motion[1, :-1] = velocity.real, velocity.imag
        motion[2, :-1], motion[3, :-1] = spin, bend
        vx, vy, omega, bends = motion.take(self._mover, axis=1)
        nx, ny = self.normal.real, self.normal.imag
        x, y = self._x[: self._k], self._y[: self._k]
        place = nx * x + ny * y
        speed = nx * vx + ny * vy + omega * (ny * x - nx * y)
        turns = bends + omega * omega * self._lever
        # each vertex of the first piece against each of the second
        gap = place[None, :, 1] - place[:, None, 0]
        gap += nx * self._between_x + ny * self._between_y - self._radii
        closing = speed[:, None, 0] - speed[None, :, 1]
        turn = turns[:, None, 0] + turns[None, :, 1]
        room = np.maximum(gap + depth, depth / 64)
        h = _time_to_close(room, closing, turn)
        return float(h.min() if again else h[..., ~self.touch].min(initial=inf))


def _time_to_close(room: Float, closing: Float, turn: Float) -> Float:
    """Return the time h until closing h + turn h^2 / 2 = room, s; closing [m/s] may be negative."""
    twice = 2 * room
    bent = turn * twice
    quick = np.abs(closing)
    total = np.sqrt(closing * closing + bent) + quick
    # root - |closing|, without cancellation
    slow = bent / np.maximum(total, TINY * TINY)
    return np.asarray(twice / (np.where(closing >= 0, total, slow) + TINY))


def _axes(edge: Complex) -> Complex:
    """Return the unit vectors along which a piece with edges (K,) may be separated from another.

    They are the outward normals of the edges, and for a piece without area also its directions.
    """
    edge = edge[length(edge) > 0]
    if not len(edge):
        return np.array([1, 1j, -1, -1j])
    along = edge / length(edge)
    normal = along.imag - 1j * along.real
    if np.abs(dot(along, normal[0])).max() > TINY:
        return normal
    return np.array([normal[0], -normal[0], along[0], -along[0]])


def _columns(parts: Sequence[Complex], fill: Sequence[complex]) -> Complex:
    """Return arrays of different lengths as the columns of one, padded at their ends."""
    rows = max((len(part) for part in parts), default=1)
    columns = np.empty((rows, len(parts)), dtype=np.complex128)
    for column, (part, rest) in enumerate(zip(parts, fill, strict=True)):
        columns[: len(part), column] = part
        columns[len(part) :, column] = rest
    return columns
