"""Messages as data: who sent what to whom, when, and whether it arrived."""

from __future__ import annotations

import json
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, one_line, shown

STATUS = ("on its way", "delivered", "lost", "out of reach", "over the bandwidth")
"""The states of a message, by the number in the field `status`."""

ON_ITS_WAY, DELIVERED, LOST, OUT_OF_REACH, OVER_BANDWIDTH = range(len(STATUS))

MESSAGE = np.dtype(
    [
        ("time", "f8"),  # s, when it was sent
        ("arrival", "f8"),  # s, of the control step that has it in the inbox; nan if none will
        ("sender", "i4"),  # index of a robot
        ("receiver", "i4"),  # index of another one
        ("size", "i4"),  # bytes
        ("content", "i4"),  # index of its text in the record's contents
        ("status", "u1"),  # index of a word of STATUS
    ]
)
"""A row for each message and receiver."""

MAX_BYTES = 65_536
"""The largest content, as JSON."""

ALLOWED = (
    "a message holds None, True and False, numbers, text, arrays of these, and lists, tuples and "
    "dicts of these"
)


class Message(NamedTuple):
    """A message as its receiver gets it.

    sender: the index of the robot that sent it; name: its name. time: when it was sent, s. content:
    the receiver's own copy of the content; arrays and tuples arrive as lists.
    """

    sender: int
    name: str
    time: float
    content: Any


def as_text(content: Any) -> str:
    """Return a message's content as compact JSON, which is recorded and whose length is its size.

    NaN and infinities are written ``NaN``, ``Infinity`` and ``-Infinity``, which Python's json can
    read. Raises LawError for content that can't be recorded, or of more than `MAX_BYTES`.

    >>> as_text({"goal": (1.5, 2), "free": True})
    '{"goal":[1.5,2],"free":true}'
    """
    try:
        text = json.dumps(content, ensure_ascii=False, separators=(",", ":"), default=_of_numpy)
        size = len(text.encode())
    except (TypeError, ValueError, RecursionError) as error:
        raise LawError(
            f"robot.send: {shown(content)} can't be recorded: {one_line(error)}; {ALLOWED}"
        ) from error
    if size > MAX_BYTES:
        raise LawError(f"robot.send: the content has {size} bytes, of at most {MAX_BYTES}")
    return text


def _of_numpy(value: Any) -> Any:
    """Return an array as lists, or a number of numpy as one of Python."""
    if isinstance(value, np.ndarray | np.generic) and value.dtype.kind in "biufU":
        return value.astype(float).tolist() if value.dtype.kind == "f" else value.tolist()
    raise TypeError(f"it holds {shown(value)}")


def packed(contents: Sequence[str]) -> dict[str, NDArray[Any]]:
    """Return the texts of messages as two columns: all bytes in turn, and how many each has."""
    texts = [text.encode() for text in contents]
    return {
        "contents": np.frombuffer(b"".join(texts), dtype=np.uint8),
        "content_sizes": np.array([len(text) for text in texts], dtype=np.int64),
    }


def as_of(messages: NDArray[np.void], time: float) -> NDArray[np.void]:
    """Return a copy of messages (m,) with their `status` at a time, s."""
    result = messages.copy()
    sent = messages["status"] <= DELIVERED
    arrived = messages["arrival"] <= time  # never for nan
    result["status"][sent & arrived] = DELIVERED
    result["status"][sent & ~arrived] = ON_ITS_WAY
    return result


def in_flight(
    messages: NDArray[np.void], time: float, sampling_time: float, delay: float
) -> NDArray[np.void]:
    """Return the messages that were under way in the control step that led to a time, s.

    messages: (m,), by time sent. delay: the longest time that a message is under way, s. Messages
    that never arrive are under way in the step in which they were sent.
    """
    rounding = 1e-6 * sampling_time
    oldest = time - max(delay, sampling_time) - sampling_time
    first, end = (bisect_left(messages["time"], t - rounding) for t in (oldest, time))
    near = messages[first:end]
    fresh = near["time"] > time - sampling_time - rounding
    return as_of(near[fresh | (near["arrival"] > time - rounding)], time)
