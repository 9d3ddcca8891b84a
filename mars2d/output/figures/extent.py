"""The rows of a record and the part of the plane that a figure shows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError, shown

if TYPE_CHECKING:
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


RATIO = 8.0
"""The largest ratio of a view's sides; a longer corridor gets margins."""


class View(NamedTuple):
    """The part of the plane that is drawn, metres."""

    xmin: float
    xmax: float
    ymin: float
    ymax: float

    @classmethod
    def of(cls, record: Rows, row: int) -> Self:
        """Return the view of the workspace, and of all paths until `row`, with a margin."""
        check_rows(record)
        paths = record.pose[: row + 1], record.prop_pose[: row + 1]
        return cls.around(record.scenario, *paths)

    @classmethod
    def around(cls, scenario: Scenario, pose: Float, prop_pose: Float) -> Self:
        """Return the view of the workspace and of poses (T, 3, n) and (T, 3, p), with a margin."""
        paths = [path[:, :2] for path in (pose, prop_pose)]
        reach = np.array([body.shape.reach for body in scenario.bodies])
        low = np.hstack([path.min(axis=0) for path in paths]) - reach  # (2, n + p)
        high = np.hstack([path.max(axis=0) for path in paths]) + reach
        xmin, xmax, ymin, ymax = scenario.bounds
        low = np.minimum(low.min(axis=1), (xmin, ymin))
        high = np.maximum(high.max(axis=1), (xmax, ymax))
        size = high - low + 0.04 * (high - low).max()
        size = np.maximum(size, size[::-1] / RATIO)
        low, high = (low + high - size) / 2, (low + high + size) / 2
        return cls(*np.stack([low, high], axis=1).ravel().tolist())

    @property
    def width(self) -> float:
        """From left to right, metres."""
        return self.xmax - self.xmin

    @property
    def height(self) -> float:
        """From bottom to top, metres."""
        return self.ymax - self.ymin

    def union(self, other: Sequence[float]) -> Self:
        """Return the view extended to hold another, or (xmin, xmax, ymin, ymax), metres."""
        pick = (min, max, min, max)
        return type(self)(*(f(a, b) for f, a, b in zip(pick, self, other, strict=True)))

    def inches(self, width: float, height: float) -> tuple[float, float]:
        """Return the largest (width, height) in the view's proportions that fits, inches."""
        scale = min(width / self.width, height / self.height)
        return scale * self.width, scale * self.height


PANEL_LIMIT = 64
"""The most panels in a figure."""


def check_rows(record: Rows, what: str = "draw") -> None:
    """Raise InputError for a record without rows; what: the verb of the message."""
    if len(record) == 0:
        raise InputError(f"the record has no rows: nothing ran, so there is nothing to {what}")


def rows_at(record: Rows, times: ArrayLike) -> list[int]:
    """Return the last row of a record at or before each of the times [s], or "end".

    Raises InputError for a time outside the record, and for no times or too many.
    """
    check_rows(record)
    first, last = float(record.time[0]), float(record.time[-1])
    hair = 1e-6 * record.scenario.sampling_time  # 3 * 0.1 is a little more than 0.3
    given: Any = [times] if isinstance(times, str | float | int) else times
    try:
        wanted = np.array([last if time == "end" else float(time) for time in given])
    except (TypeError, ValueError):
        expected = 'expected times in seconds, such as [0, 2.5, "end"]'
        raise InputError(f"times = {shown(times)}: {expected}") from None
    if not 1 <= len(wanted) <= PANEL_LIMIT:
        raise InputError(f"times: {len(wanted)} of them; a figure has 1 to {PANEL_LIMIT} panels")
    for time in wanted.tolist():
        if not first - hair <= time <= last + hair:  # true for NaN as well
            raise InputError(
                f"times: {time:.10g} s is outside of the record, "
                f"which goes from {first:.10g} to {last:.10g} s"
            )
    rows = np.searchsorted(record.time, wanted + hair, side="right") - 1
    return [max(0, row) for row in rows.tolist()]
