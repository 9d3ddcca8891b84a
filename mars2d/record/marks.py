"""The rows of a run at which something happened, as a time bar marks them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from mars2d.record.contact import met

if TYPE_CHECKING:
    from mars2d.record.rows import Rows

MarkKind = Literal["collision", "hand", "branch", "error"]
"""Bodies came to touch; a person intervened; a branch begins; a law, sensor or add-on failed."""


def marks_of(record: Rows) -> dict[MarkKind, list[int]]:
    """Return the rows of a record that have marks, ascending.

    It does not know of branches, nor whether an end was an error.
    """
    return {
        "collision": meetings(record.contacts, record.scenario.sampling_time),
        "hand": sorted({each.row for each in record.interventions}),
    }


def meets(contacts: NDArray[np.void], body: int | None) -> NDArray[np.bool_]:
    """Return with which contacts a body came to touch another, or any body for None."""
    of = True if body is None else (contacts["a"] == body) | (contacts["b"] == body)
    return np.asarray(met(contacts) & of)


def meetings(contacts: NDArray[np.void], sampling_time: float) -> list[int]:
    """Return the rows at the ends of the control steps in which bodies came to touch, ascending."""
    steps = contacts["time"][met(contacts)] / sampling_time
    rows: list[int] = np.unique(np.ceil(steps - 1e-6).astype(int)).tolist()
    return rows
