"""Pairs of discs and walls that may touch soon: a Verlet list, so that few gaps are measured.

Points are complex numbers x + i y, in metres.
"""

from __future__ import annotations

from collections.abc import Collection
from copy import copy
from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.plane import TINY, dot, length

__all__ = ["Clearance", "Close", "DiscPairs", "Walls"]

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

MAX_DISCS_ALL_PAIRS = 32
"""Up to this number of discs, all pairs are kept; else those within a skin, found by a k-d tree."""


class Walls:
    """Line segments that stand still."""

    def __init__(self, start: Complex, edge: Complex) -> None:
        """Take the segments' starting points and the vectors to their ends, (S,) each."""
        per_length = edge / length(edge) ** 2
        self._lines = np.array(
            [part for z in (start, edge, per_length) for part in (z.real, z.imag)]
        )

    def __len__(self) -> int:
        return int(self._lines.shape[1])

    def take(self, which: Index) -> Walls:
        """Return some of the segments."""
        some = copy(self)
        some._lines = self._lines[:, which]
        return some

    def shared(self) -> tuple[Float, Float, Float]:
        """Return starts, edges, and edges divided by their squared lengths, (S, 2) each."""
        start, edge, per_length = (
            np.ascontiguousarray(self._lines[k : k + 2].T) for k in (0, 2, 4)
        )
        return start, edge, per_length

    def towards(self, point: Complex) -> Complex:
        """Return the vectors from points to the nearest points of the segments, broadcast."""
        x, y = self._way(point)
        return np.asarray(x + 1j * y)

    def distance(self, point: Complex) -> Float:
        """Return the distances from points to the segments, broadcast, metres."""
        return np.asarray(np.hypot(*self._way(point)))

    def _way(self, point: Complex) -> tuple[Float, Float]:
        x, y, edge_x, edge_y, per_x, per_y = self._lines
        from_x, from_y = point.real - x, point.imag - y
        along = from_x * per_x + from_y * per_y
        along = np.minimum(np.maximum(along, 0.0, out=along), 1.0, out=along)
        return along * edge_x - from_x, along * edge_y - from_y


class Close(NamedTuple):
    """Pairs that may touch, as indices: discs i and j; a disc and a segment."""

    i: Index
    j: Index
    disc: Index
    segment: Index


class Clearance:
    """Tells which of n discs may soon touch each other, or one of S segments.

    Gaps are not measured each time. Pairs of discs are kept in a Verlet list: a pair that is not in
    the list was so far apart when the list was made that both discs would have to move by the
    `skin` first. Likewise, the measured gap of each disc to its nearest segment is kept, less the
    way that the disc may have moved since. Both are lower bounds, so a disc reported as free is
    free.

    Source of the list: L. Verlet, Physical Review 159, 98 (1967).
    """

    def __init__(
        self, radii: Float, walls: Walls, passing: Collection[tuple[int, int]] = ()
    ) -> None:
        """Take the discs' radii (n,), metres, the walls, and pairs that pass through each other."""
        n = len(radii)
        self._radii = radii
        self._walls = walls
        self._passing = np.array([i * n + j for i, j in sorted(passing)], dtype=np.intp)
        self._wall_gap = np.full(n, -inf if len(self._walls) else inf)  # a lower bound
        self._moved = np.zeros(n)  # since the pairs were listed
        self._measured = np.zeros(n, dtype=bool)  # whether the gap to segments is exact now
        all_pairs = n <= MAX_DISCS_ALL_PAIRS
        self._skin = inf if all_pairs else -1.0  # negative: list the pairs at the first query
        self._keep_pairs(*np.triu_indices(n if all_pairs else 0, 1))

    def shared(self) -> tuple[dict[str, NDArray[Any]], dict[str, float]]:
        """Return arrays and numbers for the kernel, by its names; see ``kernel/team.h``."""
        start, edge, per_length = self._walls.shared()
        arrays = {
            "radius": self._radii, "wall_gap": self._wall_gap, "moved": self._moved,
            "start": start, "edge": edge, "per_length": per_length,
        }  # fmt: skip
        return arrays, {"segments": len(start), "few": MAX_DISCS_ALL_PAIRS, "tiny": TINY}

    def measure(self, center: Complex) -> None:
        """Take the discs' centres (n,), from which they move in the following queries."""
        self._center = center
        self._gaps: Float | None = None
        self._measured[:] = False

    def may_touch(self, reach: Float) -> Mask:
        """Return which discs may touch something, or be touched, within a motion.

        reach: (n,) the largest way of each disc, metres.
        """
        if (self._moved + reach).max() > self._skin:
            self._list_pairs(reach)
        near = np.zeros(len(reach), dtype=bool)
        if len(self._i):
            close = self._pair_gaps() <= reach[self._i] + reach[self._j]
            if close.any():
                near[self._i[close]] = True
                near[self._j[close]] = True
        unsure = np.flatnonzero((self._wall_gap <= reach) & ~self._measured)
        if len(unsure):
            self._wall_gap[unsure] = self._wall_gaps(unsure).min(axis=1)
            self._measured[unsure] = True
        near |= self._wall_gap <= reach
        return near

    def moved(self, distance: Float) -> None:
        """Note that the discs may have moved by these distances (n,), metres."""
        self._moved += distance
        self._wall_gap -= distance

    def close(self, who: Index, reach: float) -> Close:
        """Return the pairs among the discs `who` that may touch, each moving by at most `reach`.

        The result's indices of discs are positions in `who`.
        """
        local = np.full(len(self._radii), -1)
        local[who] = np.arange(len(who))
        i, j = local[self._i], local[self._j]
        pair = np.flatnonzero((i >= 0) & (j >= 0))
        pair = pair[self._pair_gaps()[pair] <= 2 * reach]
        # `moved` was called before: the bound of whatever is within reach is zero or less.
        some = np.flatnonzero(self._wall_gap[who] <= 0)
        row, segment = np.nonzero(self._wall_gaps(who[some]) <= reach)
        return Close(i[pair], j[pair], some[row], segment)

    def _pair_gaps(self) -> Float:
        if self._gaps is None:
            i, j, center = self._i, self._j, self._center
            self._gaps = length(center[i] - center[j]) - self._radii[i] - self._radii[j]
        return self._gaps

    def _wall_gaps(self, which: Index) -> Float:
        """Return the gaps (k, S) between some discs and all segments."""
        distance = self._walls.distance(self._center[which, None])
        return np.asarray(distance - self._radii[which, None])

    def _list_pairs(self, reach: Float) -> None:
        """Rebuild the Verlet list, with a skin that lasts for several queries."""
        from scipy.spatial import cKDTree

        self._skin = float(2 * max(4 * reach.max(), self._radii.max()))
        cutoff = 2 * self._radii.max() + 2 * self._skin
        tree = cKDTree(np.column_stack([self._center.real, self._center.imag]))
        pairs = tree.query_pairs(cutoff, output_type="ndarray")
        i, j = pairs.T.astype(np.intp)
        order = np.lexsort((j, i))
        self._keep_pairs(i[order], j[order])
        self._moved[:] = 0.0

    def _keep_pairs(self, i: Index, j: Index) -> None:
        """Keep a list of pairs, i < j, without those that pass through each other."""
        if len(self._passing):
            kept = ~np.isin(i * len(self._radii) + j, self._passing)
            i, j = i[kept], j[kept]
        self._i, self._j, self._gaps = i, j, None


class DiscPairs:
    """Discs that are close to each other or to segments, and their gaps as they move."""

    def __init__(self, radii: Float, pairs: Close, walls: Walls) -> None:
        """Take the discs' radii (k,), the pairs, and the walls with all segments."""
        self._i, self._j, self._disc, self._segment = pairs
        self._walls = walls.take(self._segment)
        self._radii = radii
        disc = self._disc
        self._radii_sum = np.concatenate([radii[self._i] + radii[self._j], radii[disc]])
        self._count = len(radii)
        self._first = np.concatenate([self._i, disc])

    def measure(self, center: Complex) -> None:
        """Take the discs' centres (k,) and measure all gaps."""
        self._center, pairs = center, len(self._i)
        first = center[self._first]
        between = np.empty(len(first), dtype=np.complex128)
        between[:pairs] = center[self._j] - first[:pairs]
        between[pairs:] = self._walls.towards(first[pairs:])
        distance = length(between)
        self._gap = distance - self._radii_sum
        self._normal = between * (1.0 / np.maximum(distance, TINY))
        self._touch = self._gap <= 0
        self.any_touch = bool(self._touch.any())

    def touching(self) -> Mask:
        """Return which discs touch something, (k,)."""
        touching = np.zeros(self._count, dtype=bool)
        if self.any_touch:
            touching[self._first[self._touch]] = True
            touching[self._j[self._touch[: len(self._j)]]] = True
        return touching

    def touching_pairs(self) -> Close:
        """Return the pairs that touch."""
        discs, walls = self._touch[: len(self._i)], self._touch[len(self._i) :]
        return Close(self._i[discs], self._j[discs], self._disc[walls], self._segment[walls])

    def gap_of_touching(self) -> Float:
        """Return the gaps of the pairs that touch, zero or negative, metres."""
        return np.asarray(self._gap[self._touch])

    def touching_points(self) -> tuple[Complex, Complex]:
        """Return points on the first disc of each touching pair, and the normals there."""
        normal, first = self.normal_of_touching(), self._first[self._touch]
        return self._center[first] + self._radii[first] * normal, normal

    def normal_of_touching(self) -> Complex:
        """Return the unit vectors from the first to the second of each touching pair."""
        return np.asarray(self._normal[self._touch])

    def inwards(self, velocity: Complex) -> tuple[Float, Float]:
        """Return the speeds at which the two of each touching pair move into each other, (m,) m/s.

        velocity: (k,) of the discs. Segments do not move.
        """
        normal = self._normal[self._touch]
        first = dot(velocity[self._first[self._touch]], normal)
        discs = self._touch[: len(self._j)]
        second = np.zeros(len(first))
        second[: int(discs.sum())] = -dot(velocity[self._j[discs]], normal[: int(discs.sum())])
        return first, second

    def time_to_touch(
        self, velocity: Complex, bend: Float, depth: float, *, again: bool = True
    ) -> float:
        """Return a time during which no pair gets deeper than `depth`, seconds.

        A pair that is already that deep may get a little deeper, so that the solver is called again
        soon after an impact that it could not stop at once. Without `again`, touching pairs are
        left out.

        velocity: (k,) of the discs. bend: (k,) m/s^2, a bound on the rate at which each velocity
        turns. Along straight lines, the distance to a convex shape is a convex function of time,
        so it never falls faster than it does now.
        """
        if not len(self._gap):
            return inf
        pairs = len(self._i)
        approach = velocity[self._first]
        approach[:pairs] -= velocity[self._j]
        turn = bend[self._first]
        turn[:pairs] += bend[self._j]
        closing = np.maximum(dot(approach, self._normal), 0.0)
        # room = closing h + turn h^2 / 2, solved for h in a form in which both may be zero
        room = np.maximum(self._gap + depth, depth / 64)
        h = 2 * room / (closing + np.sqrt(closing**2 + 2 * turn * room) + TINY)
        return float(h.min() if again else h[~self._touch].min(initial=inf))
