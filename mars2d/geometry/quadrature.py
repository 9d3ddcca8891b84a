"""Points and weights for integrals over polygons."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import norms

Float = NDArray[np.float64]
Index = NDArray[np.intp]

MAX_DIVISIONS = 64
"""The largest number of parts into which each side of a triangle is divided."""


def nodes(pieces: NDArray[Any], resolution: float) -> tuple[Float, Float, Index]:
    """Return points (2, k), the area (k,) of each, and the index of its polygon (k,).

    pieces: polygons of shapely without holes. resolution: the largest side of the triangles into
    which they are divided, metres. On each triangle, the sum over its points is exact for
    polynomials of degree 5. All areas are positive.
    """
    triangles, owner = _triangles(pieces)
    a, b, c = np.moveaxis(triangles, 1, 0)
    ab, ac, bc = b - a, c - a, c - b
    area = np.abs(ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]) / 2
    longest = np.max([norms(*side.T) for side in (ab, ac, bc)], axis=0)
    parts = np.minimum(np.ceil(longest / resolution), MAX_DIVISIONS).astype(int)
    points, areas, of = [np.empty((2, 0))], [np.empty(0)], [np.empty(0, dtype=np.intp)]
    for count in np.unique(parts[area > 0]).tolist():
        k = np.flatnonzero((parts == count) & (area > 0))
        u, v, share = _rule(count)
        x, y = (a[k, axis, None] + u * ab[k, axis, None] + v * ac[k, axis, None] for axis in (0, 1))
        points.append(np.array([x.ravel(), y.ravel()]))
        areas.append((area[k, None] * share).ravel())
        of.append(np.repeat(owner[k], len(share)))
    return np.hstack(points), np.concatenate(areas), np.concatenate(of)


def _triangles(pieces: NDArray[Any]) -> tuple[Float, Index]:
    """Return the triangles (m, 3, 2) of polygons (k,), and the index of each one's polygon (m,)."""
    import shapely

    corners, piece = shapely.get_coordinates(pieces, return_index=True)
    side = np.flatnonzero(piece[1:] == piece[:-1])
    count = np.bincount(piece[side], minlength=len(pieces))
    middle = np.array([np.bincount(piece[side], axis[side], len(pieces)) for axis in corners.T])
    middle = (middle / np.maximum(count, 1)).T
    fan = np.stack([middle[piece[side]], corners[side], corners[side + 1]], axis=1)
    ab, ac = fan[:, 1] - fan[:, 0], fan[:, 2] - fan[:, 0]
    turn = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    right, left = (np.bincount(piece[side], s * turn > 0, len(pieces)) > 0 for s in (-1, 1))
    starry = ~(right & left)  # all corners are visible from the middle
    keep = starry[piece[side]]
    parts, of = fan[keep], piece[side][keep]
    if starry.all():
        return parts, of
    rest = np.flatnonzero(~starry)
    cut = shapely.constrained_delaunay_triangles(pieces[rest])
    cut, index = shapely.get_parts(cut, return_index=True)
    more = shapely.get_coordinates(cut).reshape(-1, 4, 2)[:, :3]
    return np.vstack([parts, more]), np.concatenate([of, rest[index]])


@lru_cache(maxsize=64)
def _rule(count: int) -> tuple[Float, Float, Float]:
    """Return nodes u, v (m,) and shares (m,) of a quadrature on a triangle a + u (b-a) + v (c-a).

    count: the number of parts of each side. Each of the count^2 triangles has seven nodes, exact
    for polynomials of degree 5. Source: Radon, Monatshefte fuer Mathematik 52, 1948.
    """
    root = sqrt(15)
    u, v, share = [1 / 3], [1 / 3], [9 / 40]
    for s in (-1, 1):
        near, weight = (6 + s * root) / 21, (155 + s * root) / 1200
        u += [near, near, 1 - 2 * near]
        v += [near, 1 - 2 * near, near]
        share += [weight] * 3
    nodes = np.array([u, v])
    up = [(i, j) for i in range(count) for j in range(count - i)]
    down = [(i + 1, j + 1) for i in range(count) for j in range(count - i - 1)]
    all_nodes = [(np.array([corner]).T + nodes) / count for corner in up]
    all_nodes += [(np.array([corner]).T - nodes) / count for corner in down]
    shares = np.tile(share, count * count) / (count * count)
    whole = np.hstack(all_nodes)
    return whole[0], whole[1], shares
