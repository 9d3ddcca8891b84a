"""The rows of a record and the part of the plane that a figure shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core.errors import InputError, shown

if TYPE_CHECKING:
    from mars2d.record.rows import Rows
    from mars2d.scenario.scenario import Scenario

Float = NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """The part of the plane that is drawn, metres."""

    xmin: float
    xmax: float
    ymin: float
    ymax: float

    FARTHEST = 1e100
    """The greatest coordinate that is drawn, metres: squares of larger numbers overflow."""

    RATIO = 8.0
    """The largest ratio of the sides; a longer corridor gets margins."""

    @classmethod
    def of(cls, record: Rows, row: int) -> Self:
        """Return the view of the workspace, and of all paths until `row`, with a margin."""
        check_rows(record)
        paths = record.pose[: row + 1], record.prop_pose[: row + 1]
        farthest = max(float(np.abs(path[:, :2]).max(initial=0.0)) for path in paths)
        if farthest > cls.FARTHEST:
            raise InputError(f"bodies are up to {farthest:.2g} m away: too far to be drawn")
        return cls.around(record.scenario, *paths)

    @classmethod
    def around(cls, scenario: Scenario, pose: Float, prop_pose: Float) -> Self:
        """Return the view of the workspace and of poses (T, 3, n) and (T, 3, p), with a margin."""
        xy = pose[:, :2]
        low, high = xy.min(axis=0), xy.max(axis=0)  # (2, n)
        reach = np.array([robot.radius + abs(robot.center_offset) for robot in scenario.robots])
        if scenario.props:
            props = prop_pose[:, :2]
            low = np.hstack([low, props.min(axis=0)])
            high = np.hstack([high, props.max(axis=0)])
            reach = np.append(reach, [prop.shape.reach for prop in scenario.props])
        xmin, xmax, ymin, ymax = scenario.bounds
        xmin = min(xmin, float((low[0] - reach).min()))
        xmax = max(xmax, float((high[0] + reach).max()))
        ymin = min(ymin, float((low[1] - reach).min()))
        ymax = max(ymax, float((high[1] + reach).max()))
        margin = 0.02 * max(xmax - xmin, ymax - ymin)
        view = cls(xmin - margin, xmax + margin, ymin - margin, ymax + margin)
        more_x = max(0.0, view.height / cls.RATIO - view.width) / 2
        more_y = max(0.0, view.width / cls.RATIO - view.height) / 2
        return cls(view.xmin - more_x, view.xmax + more_x, view.ymin - more_y, view.ymax + more_y)

    @property
    def width(self) -> float:
        """From left to right, metres."""
        return self.xmax - self.xmin

    @property
    def height(self) -> float:
        """From bottom to top, metres."""
        return self.ymax - self.ymin

    def union(self, limits: tuple[float, float, float, float]) -> Self:
        """Return the view extended to hold (xmin, xmax, ymin, ymax), metres."""
        xmin, xmax, ymin, ymax = limits
        return replace(
            self,
            xmin=min(self.xmin, xmin), xmax=max(self.xmax, xmax),
            ymin=min(self.ymin, ymin), ymax=max(self.ymax, ymax),
        )  # fmt: skip

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
