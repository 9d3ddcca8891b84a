"""Arrays that can't be written, and bounds of values; quick for arrays of few numbers, too."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def locked(array: NDArray[Any]) -> NDArray[Any]:
    """Return the same array, which can't be written any more."""
    # By position it takes half the time that it takes by name; numpy's stubs know no position.
    array.setflags(False)  # type: ignore[call-arg]
    return array


def sealed(array: NDArray[Any]) -> NDArray[Any]:
    """Return a view of an array that can't be written."""
    return locked(array.view())


def within(most: float, values: NDArray[np.float64]) -> bool:
    """Return whether all values lie within +-most; NaN does not."""
    # The sum of squares is found in one call, and mostly tells; both sides may be infinite. For
    # more numbers, BLAS would wake threads that spin.
    if values.size <= 10_000 and np.vdot(values, values) < 0.5 * most * most:
        return True
    return bool(-most <= values.min(initial=0.0) and values.max(initial=0.0) <= most)
