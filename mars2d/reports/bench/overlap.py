"""How deep the robots of a scene were in each other and in what stands there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mars2d.reports.bench.scenes import Scene

__all__ = ["deepest"]

Float = NDArray[np.float64]


def deepest(scene: Scene, pose: Float) -> float:
    """Return the deepest overlap at any of the poses (T, 3, n), metres; 0 if there is none.

    Of robots with each other, with the walls and with the boxes.
    """
    import shapely
    from scipy.spatial import cKDTree

    r = scene.radius
    x, y = pose[:, 0].ravel(), pose[:, 1].ravel()
    wall = float(np.maximum(np.abs(x), np.abs(y)).max()) + r - scene.side / 2
    # Rows lie in planes further apart than robots that touch: one tree finds all pairs.
    plane = np.repeat(np.arange(len(pose)) * 4 * r, pose.shape[2])
    space = np.column_stack([x, y, plane])
    i, j = cKDTree(space).query_pairs(2 * r, output_type="ndarray").T
    pairs = 2 * r - np.hypot(x[i] - x[j], y[i] - y[j])
    boxes = np.array([shapely.Polygon(box) for box in scene.boxes], dtype=object)
    centers = shapely.points(x, y)
    k, box = shapely.STRtree(boxes).query(centers, "dwithin", r)
    inside = r - shapely.distance(centers[k], boxes[box])
    return float(max(0.0, wall, pairs.max(initial=0.0), inside.max(initial=0.0)))
