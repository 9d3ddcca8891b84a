"""What passes between a match and its laws' processes: frames of bytes.

A frame is a head, which says how long its body is and what it holds, and the body. Whatever comes
from a law is numbers and JSON: reading it runs no code.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "ANSWER",
    "BRIEFING",
    "COMMANDS",
    "FAULT",
    "HEAD",
    "LINE",
    "READY",
    "STEP",
    "STEP_HEAD",
    "VELOCITIES",
    "WANTED",
    "Layout",
    "Reader",
    "framed",
]

Float = NDArray[np.float64]

HEAD = struct.Struct("<Ic3x")
"""The length of the body in bytes, and its kind."""

BRIEFING, STEP, VELOCITIES = b"b", b"s", b"v"
"""To a law: all that it is told once, pickled; a control step; the same with velocities."""

READY, COMMANDS, FAULT, LINE, WANTED = b"r", b"c", b"f", b"l", b"w"
"""From a law: it is loaded; its commands; what went wrong, and the line where it is now, as JSON;
that velocities are wanted, at this control step and from now on."""

STEP_HEAD = struct.Struct("<qII")
"""Of a control step: its iteration, the bytes of its contacts and of its news, after its Layout."""

ANSWER = struct.Struct("<q")
"""Of commands: the iteration that they are for; then 2 numbers a robot, then messages as JSON."""


def framed(kind: bytes, body: bytes) -> bytes:
    """Return a frame."""
    return HEAD.pack(len(body), kind) + body


class Reader:
    """Frames out of the pieces in which bytes arrive. Raises ValueError for too long a one."""

    def __init__(self, longest: int) -> None:
        """Take how long a body may be, bytes."""
        self._longest = longest
        self._rest = b""

    @property
    def empty(self) -> bool:
        """Whether no frame has come in part."""
        return not self._rest

    def read(self, piece: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Yield the kind and body of each frame that this piece makes complete."""
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
    """Where the numbers of a control step lie in a frame's body, as arrays one behind the other.

    pose (3, n), command (2, n), effort (n,) of robots, prop_pose (3, p); then, if a law wants them,
    velocity (3, n), prop_velocity (3, p). What a law may not see is NaN.
    """

    def __init__(self, robots: int, props: int) -> None:
        """Take how many robots and props there are."""
        self._parts: dict[str, tuple[int, int, tuple[int, ...]]] = {}
        self._end = STEP_HEAD.size
        self._add("pose", 3, robots)
        self._add("command", 2, robots)
        self._add("effort", robots)
        self._add("prop_pose", 3, props)
        self.still = self._end
        """How long it is without velocities, bytes, from the beginning of the body."""
        self._add("velocity", 3, robots)
        self._add("prop_velocity", 3, props)
        self.moving = self._end
        """How long it is with velocities."""

    def _add(self, name: str, *shape: int) -> None:
        count = int(np.prod(shape))
        self._parts[name] = self._end, count, shape
        self._end += 8 * count

    def part(self, body: bytes | memoryview, name: str) -> Float:
        """Return one of the arrays, in place."""
        offset, count, shape = self._parts[name]
        return np.frombuffer(body, float, count, offset).reshape(shape)
