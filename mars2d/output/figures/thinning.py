"""Long columns as short ones that look the same: what a figure has room for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["spans", "thinned"]

Float = NDArray[np.float64]
Index = NDArray[np.intp]


def thinned(values: Float, blocks: int) -> Index:
    """Return which of the values (T,) to draw so that the curve looks as that of all.

    The values are cut into that many blocks. Of each the first and the last are kept, the smallest
    and the largest, so that no peak is lost, and the first that is not finite, so that gaps stay.

    >>> thinned(np.array([0.0, 1, 0, 0, 9, 0, 0, 0, -5, 0]), 1).tolist()
    [0, 4, 8, 9]
    """
    count = len(values)
    size = -(-count // blocks)
    if count <= 5 * blocks:
        return np.arange(count)
    whole = count // size * size
    parts = [_kept(values[:whole].reshape(-1, size), 0)]
    if whole < count:
        parts.append(_kept(values[None, whole:], whole))
    return np.unique(np.concatenate(parts))


def _kept(blocks: Float, start: int) -> Index:
    """Return what is kept of blocks (k, size), as indices that count from `start`."""
    finite = np.isfinite(blocks)
    kept = [
        np.zeros(len(blocks), dtype=np.intp),
        np.where(finite, blocks, np.inf).argmin(axis=1),
        np.where(finite, blocks, -np.inf).argmax(axis=1),
        finite.argmin(axis=1),
        np.full(len(blocks), blocks.shape[1] - 1),
    ]
    first = start + np.arange(len(blocks)) * blocks.shape[1]
    return np.asarray(np.concatenate([first + each for each in kept]))


def spans(begin: Float, end: Float, least: float) -> tuple[Float, Float]:
    """Return intervals in order, those joined that are nearer than `least`, none shorter than it.

    begin, end: (k,), ordered by their begin.

    >>> [each.tolist() for each in spans(np.array([0.0, 1.05, 5]), np.array([1, 2, 5]), 0.1)]
    [[0.0, 5.0], [2.0, 5.1]]
    """
    end = np.maximum.accumulate(np.maximum(end, begin + least))
    apart = np.ones(len(begin), dtype=bool)
    apart[1:] = begin[1:] - end[:-1] > least
    last = np.append(apart[1:], np.ones(min(1, len(begin)), dtype=bool))
    return begin[apart], end[last]
