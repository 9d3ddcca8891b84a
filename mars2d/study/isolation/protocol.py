"""The protocol between a match and its laws' processes: frames of bytes.

A frame is a head, with the length and kind of its body, and the body. Frames from a law hold only
numbers and JSON, so that reading them runs no code.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

HEAD = struct.Struct("<Ic3x")
"""The length of the body in bytes, and its kind."""

BRIEFING, STEP, VELOCITIES = b"b", b"s", b"v"
"""To a law: its briefing, pickled; a control step; a control step with velocities."""

READY, COMMANDS, FAULT, LINE, WANTED = b"r", b"c", b"f", b"l", b"w"
"""From a law: it is loaded; its commands; a fault, as JSON; the line where it is now, as JSON; a
request for velocities, at this control step and from now on."""

STEP_HEAD = struct.Struct("<qII")
"""The head of a control step: its iteration, and the sizes in bytes of its contacts and its news,
which follow the numbers of its `Layout`."""

ANSWER = struct.Struct("<q")
"""The head of commands: their iteration. Then follow 2 numbers a robot, and messages as JSON."""


def framed(kind: bytes, body: bytes) -> bytes:
    """Return a frame."""
    return HEAD.pack(len(body), kind) + body


class Reader:
    """Assembles frames from the pieces in which bytes arrive."""

    def __init__(self, longest: int) -> None:
        """Take the greatest length of a body, bytes."""
        self._longest = longest
        self._rest = b""

    @property
    def empty(self) -> bool:
        """Whether no part of a frame is waiting for its rest."""
        return not self._rest

    def read(self, piece: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Yield (kind, body) of each frame that a piece completes; ValueError if too long."""
        self._rest = self._rest + piece if self._rest else piece
        while len(self._rest) >= HEAD.size:
            length, kind = HEAD.unpack_from(self._rest)
            if length > self._longest:
                raise ValueError(f"a frame of {length} bytes")
            end = HEAD.size + length
            if len(self._rest) < end:
                return
            body, self._rest = self._rest[HEAD.size : end], self._rest[end:]
            yield kind, body


class Layout:
    """The layout of a control step's numbers in the body of a frame, as consecutive arrays.

    pose (3, n), command (2, n), effort (n,) of robots, prop_pose (3, p); then, on request, velocity
    (3, n), prop_velocity (3, p). Numbers that a law may not see are NaN.
    """

    def __init__(self, robots: int, props: int) -> None:
        """Take the numbers of robots and props."""
        self._parts: dict[str, tuple[int, int, tuple[int, ...]]] = {}
        self._end = STEP_HEAD.size
        self._add("pose", 3, robots)
        self._add("command", 2, robots)
        self._add("effort", robots)
        self._add("prop_pose", 3, props)
        self.still = self._end
        """The length without velocities, bytes, from the beginning of the body."""
        self._add("velocity", 3, robots)
        self._add("prop_velocity", 3, props)
        self.moving = self._end
        """The length with velocities."""

    def _add(self, name: str, *shape: int) -> None:
        count = int(np.prod(shape))
        self._parts[name] = self._end, count, shape
        self._end += 8 * count

    def part(self, body: bytes | memoryview, name: str) -> Float:
        """Return one of the arrays, as a view into the body."""
        offset, count, shape = self._parts[name]
        return np.frombuffer(body, float, count, offset).reshape(shape)
