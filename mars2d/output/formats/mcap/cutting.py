"""A record cut into rows, each with what happened in the control step that began there."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from mars2d.output.formats.mcap.row import Row
from mars2d.record import interventions
from mars2d.record.interventions import Intervention
from mars2d.record.record import Record

__all__ = ["changes_at", "cut"]

Int = NDArray[np.intp]


def cut(record: Record, start: int = 0) -> Iterator[Row]:
    """Yield the rows of a record from `start` on."""
    contacts = _ends(record.contact_rows - 1, len(record))
    rounding = 1e-6 * record.scenario.sampling_time
    sent = np.searchsorted(record.time, record.messages["time"] + rounding, side="left") - 1
    messages = _ends(sent, len(record))
    # A text comes with the first message that has it, which are in the order of texts.
    contents = np.zeros(len(record) + 1, dtype=int)
    last = np.maximum.accumulate(np.concatenate([[-1], record.messages["content"]]))
    contents[1:] = 1 + last[messages[1:]]
    contents[-1] = len(record.contents)
    for k in range(start, len(record)):
        yield Row(
            row=k,
            time=float(record.time[k]),
            command_time=float(record.command_time[k]),
            pose=record.pose[k],
            command=record.command[k],
            prop_pose=record.prop_pose[k],
            effort=record.effort[k],
            readings={name: values[k] for name, values in record.sensors.items()},
            contacts=record.contacts[contacts[k] : contacts[k + 1]],
            messages=record.messages[messages[k] : messages[k + 1]],
            contents=record.contents[contents[k] : contents[k + 1]],
            changes=changes_at(record.interventions, k),
        )


def changes_at(done: Sequence[Intervention], row: int) -> list[str]:
    """Return what was done to the world at a row, as texts of JSON."""
    found = []
    for each in reversed(done):
        if each.row < row:
            break
        if each.row == row:
            found.append(json.dumps(interventions.to_plain(each)))
    return found[::-1]


def _ends(rows: Int, count: int) -> Int:
    """Return where in things of these rows, in order, those of row k begin, and at k + 1 end.

    Returns (count + 1,). The last row has all that came after it.
    """
    rows = np.maximum.accumulate(np.clip(rows, 0, None), dtype=np.intp)
    ends = np.searchsorted(rows, np.arange(count + 1), side="left")
    ends[-1] = len(rows)
    return ends
