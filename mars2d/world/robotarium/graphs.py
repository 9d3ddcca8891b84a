"""Graphs and neighbours: the Robotarium's `graph`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["completeGL", "cycle_GL", "delta_disk_neighbors", "lineGL", "topological_neighbors"]

Float = NDArray[np.float64]
Int = NDArray[np.int64]


def _laplacian(adjacency: Float) -> Float:
    return np.diag(adjacency.sum(axis=1)) - adjacency


def cycle_GL(N: int) -> Float:
    """Return the Laplacian (N, N) of a ring."""
    ring = np.roll(np.eye(N), 1, axis=1)
    return _laplacian(np.fmin(ring + ring.T, 1) * (1 - np.eye(N)))


def lineGL(N: int) -> Float:
    """Return the Laplacian (N, N) of a line."""
    return _laplacian(np.eye(N, k=1) + np.eye(N, k=-1))


def completeGL(N: int) -> Float:
    """Return the Laplacian (N, N) of the complete graph."""
    return _laplacian(np.ones((N, N)) - np.eye(N))


def topological_neighbors(L: Float, agent: int) -> Int:
    """Return the neighbours of a robot in the graph of a Laplacian."""
    row = np.array(L[agent], dtype=float)
    row[agent] = 0
    return np.flatnonzero(row)


def delta_disk_neighbors(poses: Float, agent: int, delta: float) -> Int:
    """Return the robots within `delta` metres of a robot."""
    apart = np.hypot(*(poses[:2] - poses[:2, [agent]]))
    apart[agent] = np.inf
    return np.flatnonzero(apart <= delta)
