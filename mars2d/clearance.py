"""How near things are to touching, asked as seldom as can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.geometry import point_segment_distance

__all__ = ["Clearance"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

FEW = 32
"""Up to this many discs all pairs are kept; above, those within a skin, found by a k-d tree."""


class Clearance:
    """Which of n discs may touch each other, or one of S segments, within the next while.

    Gaps are not measured anew each time. Pairs of discs are kept in a Verlet list: a pair that is
    not in it was so far apart when the list was made that both would have to move by the `skin`
    first. Likewise each disc keeps the gap to the nearest segment that it once had, less what it
    may have moved since. Both are bounds, so a disc that is said to be free is free.
    Source of the list: L. Verlet, Physical Review 159, 98 (1967).
    """

    def __init__(self, radii: Float, segments: Float) -> None:
        """Take the discs' radii (n,) and the segments (S, 4) = x1, y1, x2, y2, in metres."""
        n = len(radii)
        self._radii = radii
        self._segments = segments
        self._moved = np.zeros(n)  # since the pairs were listed
        self._skin = np.inf
        self._wall_gap = np.full(n, -np.inf if len(segments) else np.inf)  # a bound from below
        i, j = np.triu_indices(n if n <= FEW else 0, 1)
        self._i, self._j = i, j
        self._contact_distance = radii[i] + radii[j]
        if n > FEW:
            self._skin = -1.0  # list the pairs at the first question

    def may_touch(self, centers: Float, reach: Float) -> Mask:
        """Return which discs may touch something while each moves by at most `reach`.

        centers: (n, 2) metres; reach: (n,) metres. A disc that may be touched counts as well.
        """
        if (self._moved + reach).max() > self._skin:
            self._list_pairs(centers, reach)
        near = np.zeros(len(reach), dtype=bool)
        if len(self._i):
            gap = self._pair_gaps(centers, self._i, self._j, self._contact_distance)
            close = gap <= reach[self._i] + reach[self._j]
            if close.any():
                near[self._i[close]] = True
                near[self._j[close]] = True
        unsure = self._wall_gap <= reach
        if unsure.any():
            which = np.flatnonzero(unsure)
            self._wall_gap[which] = self.wall_gaps(centers, which).min(axis=1)
            near |= self._wall_gap <= reach
        return near

    def moved(self, distance: Float) -> None:
        """Note that the discs may have moved by these distances (n,), metres."""
        self._moved += distance
        self._wall_gap -= distance

    def close_pairs(self, centers: Float, near: Mask, reach: float) -> tuple[Index, Index]:
        """Return the pairs (i, j) among the discs in `near` with a gap of at most `reach`."""
        both = np.flatnonzero(near[self._i] & near[self._j])
        i, j = self._i[both], self._j[both]
        kept = self._pair_gaps(centers, i, j, self._contact_distance[both]) <= reach
        return i[kept], j[kept]

    def close_walls(self, centers: Float, near: Mask, reach: float) -> tuple[Index, Index]:
        """Return the pairs (disc, segment) with a gap of at most `reach`, for the discs in `near`."""
        which = np.flatnonzero(near & (self._wall_gap <= reach))
        row, segment = np.nonzero(self.wall_gaps(centers, which) <= reach)
        return which[row], segment

    def wall_gaps(self, centers: Float, which: Index) -> Float:
        """Return the gaps (k, S) between some discs and all segments, metres."""
        x, y = centers[which, 0, None], centers[which, 1, None]
        return point_segment_distance(x, y, self._segments) - self._radii[which, None]

    @staticmethod
    def _pair_gaps(centers: Float, i: Index, j: Index, contact_distance: Float) -> Float:
        apart = centers[i] - centers[j]
        return np.asarray(np.hypot(apart[:, 0], apart[:, 1]) - contact_distance)

    def _list_pairs(self, centers: Float, reach: Float) -> None:
        """Make the Verlet list anew, with a skin that lasts for several questions."""
        from scipy.spatial import cKDTree

        self._skin = float(max(4 * reach.max(), self._radii.max()))
        cutoff = 2 * self._radii.max() + 2 * self._skin
        pairs = cKDTree(centers).query_pairs(cutoff, output_type="ndarray")
        self._i, self._j = pairs[:, 0].astype(np.intp), pairs[:, 1].astype(np.intp)
        self._contact_distance = self._radii[self._i] + self._radii[self._j]
        self._moved[:] = 0.0
