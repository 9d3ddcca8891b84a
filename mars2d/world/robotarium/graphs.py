"""Graphs and neighbours: the Robotarium's `graph`."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

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


def randomGL(v: int, e: int) -> Float:
    """Return the Laplacian (v, v) of a random graph with e edges, or all if there are fewer."""
    return _laplacian(_with_edges(np.zeros((v, v)), e))


def random_connectedGL(v: int, e: int) -> Float:
    """Return the Laplacian (v, v) of a random connected graph: a tree, and e more edges."""
    tree = np.zeros((v, v))
    for i in range(1, v):
        j = np.random.randint(i)
        tree[i, j] = tree[j, i] = 1
    return _laplacian(_with_edges(tree, e))


def _with_edges(adjacency: Float, more: int) -> Float:
    """Return an adjacency matrix with so many more edges, at random places."""
    free = np.argwhere(np.triu(1 - adjacency, 1))
    for i, j in np.random.permutation(free)[:more]:
        adjacency[i, j] = adjacency[j, i] = 1
    return adjacency


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
