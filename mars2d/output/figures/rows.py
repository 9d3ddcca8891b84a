"""Which rows of a record are drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from mars2d.core.errors import InputError, shown

if TYPE_CHECKING:
    from mars2d.record.record import Record

__all__ = ["PANEL_LIMIT", "check_rows", "rows_at"]

PANEL_LIMIT = 64
"""The most panels of a figure."""


def check_rows(record: Record, what: str = "draw") -> None:
    """Raise InputError for a record without rows; what: what can't be done with it."""
    if len(record) == 0:
        raise InputError(f"the record has no rows: nothing ran, so there is nothing to {what}")


def rows_at(record: Record, times: ArrayLike) -> list[int]:
    """Return the last rows of a record that are not after the times [s].

    Raises InputError for a time outside of the record, and for none or too many of them.
    """
    check_rows(record)
    expected = "expected times in seconds, as [0, 2.5, 10]"
    try:
        wanted = np.atleast_1d(np.asarray(times))
    except ValueError:
        raise InputError(f"times = {shown(times)}: {expected}") from None
    if wanted.ndim != 1 or wanted.dtype.kind not in "iuf":
        raise InputError(f"times = {shown(times)}: {expected}")
    if not 1 <= len(wanted) <= PANEL_LIMIT:
        raise InputError(f"times: {len(wanted)} of them; a figure has 1 to {PANEL_LIMIT} panels")
    first, last = float(record.time[0]), float(record.time[-1])
    hair = 1e-6 * record.scenario.sampling_time  # 3 * 0.1 is a little more than 0.3
    for time in wanted.tolist():
        if not first - hair <= time <= last + hair:  # true for NaN as well
            raise InputError(
                f"times: {time:.10g} s is outside of the record, "
                f"which goes from {first:.10g} to {last:.10g} s"
            )
    rows = np.searchsorted(record.time, wanted.astype(float) + hair, side="right") - 1
    return [max(0, row) for row in rows.tolist()]
