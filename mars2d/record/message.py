"""Messages as data: who sent what to whom, when, and whether it arrived."""

from __future__ import annotations

import json
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.core.errors import LawError, shown

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

MAX_DEPTH = 32
"""How deep lists and dicts may be nested."""

ALLOWED = (
    "a message holds None, True and False, numbers, text, arrays of these, and lists, tuples and "
    "dicts (with text as keys) of these"
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
    plain = _plain(content, "content", ())
    try:
        text = json.dumps(plain, ensure_ascii=False, separators=(",", ":"))
        size = len(text.encode())
    except UnicodeEncodeError:
        raise _unfit("content", content, "half a character, which no file can hold") from None
    except ValueError:  # so that it can't be shown, either
        raise LawError("robot.send: content has a whole number of too many digits") from None
    if size > MAX_BYTES:
        raise _unfit("content", content, f"{size} bytes, of at most {MAX_BYTES}")
    return text


def _plain(value: Any, where: str, within: tuple[Any, ...]) -> Any:
    """Return a content, or the part of it at `where`, as None, bools, numbers, text, lists, dicts.

    within: the lists and dicts around it.
    """
    if isinstance(value, np.generic):
        value = float(value) if isinstance(value, np.floating) else value.item()
    if value is None or isinstance(value, bool):
        return value
    for kind in (int, float, str):
        if isinstance(value, kind):
            return kind(value)
    if isinstance(value, np.ndarray) and value.dtype.kind in "biufU":
        return value.astype(float).tolist() if value.dtype.kind == "f" else value.tolist()
    if not isinstance(value, (list, tuple, dict)):
        raise _unfit(where, value, ALLOWED)
    if any(value is outer for outer in within):
        raise _unfit(where, value, "it holds itself")
    if len(within) == MAX_DEPTH:
        raise _unfit(where, value, f"more than {MAX_DEPTH} lists and dicts in each other")
    within = (*within, value)
    if not isinstance(value, dict):
        return [_plain(item, f"{where}[{i}]", within) for i, item in enumerate(value)]
    for key in value:
        if not isinstance(key, str):
            raise _unfit(f"a key of {where}", key, ALLOWED)
    return {str(k): _plain(item, f"{where}[{k!r}]", within) for k, item in value.items()}


def _unfit(where: str, value: Any, why: str) -> LawError:
    return LawError(f"robot.send: {where} = {shown(value)} can't be recorded: {why}")


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
