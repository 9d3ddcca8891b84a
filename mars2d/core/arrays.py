"""Arrays that can't be written, and bounds of values; quick for arrays of few numbers, too."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray


def locked(array: NDArray[Any]) -> NDArray[Any]:
    """Return the same array, which can't be written any more."""
    # By position it takes half the time that it takes by name; numpy's stubs know no position.
    array.setflags(False)  # type: ignore[call-arg]
    return array


def sealed(array: NDArray[Any]) -> NDArray[Any]:
    """Return a view of an array that can't be written, nor made writable again by its flags."""
    if array.dtype.names:  # a view by the buffer's own format would take 30 us
        whole = np.ascontiguousarray(array)
        return np.frombuffer(whole.data.toreadonly(), whole.dtype).reshape(whole.shape)
    return np.asarray(array.data.toreadonly())


def is_masked(value: object) -> bool:
    """Return whether a value is an array of which numbers are masked: they would count as they are.

    >>> is_masked(np.ma.array([1.0, 2.0], mask=[True, False]))
    True
    """
    ma = sys.modules.get("numpy.ma")  # numpy imports it when asked: without it nothing is masked
    return ma is not None and isinstance(value, ma.MaskedArray) and bool(ma.is_masked(value))


def within(most: float, values: NDArray[np.float64]) -> bool:
    """Return whether all values lie within +-most; NaN does not."""
    # The sum of squares is found in one call, and mostly tells; both sides may be infinite.
    if np.vdot(values, values) < 0.5 * most * most:
        return True
    return bool((np.abs(values) <= most).all())
