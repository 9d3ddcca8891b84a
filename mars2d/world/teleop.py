"""Driving by hand: from a stick to the command of a drive."""

from __future__ import annotations

from typing import NamedTuple

from mars2d.bodies.drives.base import Drive
from mars2d.core.arithmetic import norm

RISE, FALL = 4.0, 8.0
"""The speeds at which a stick follows the keys, outwards and back, full deflections per s."""


class Stick(NamedTuple):
    """The deflection of a stick: across, to the right, and ahead; each from -1 to 1.

    turn: of a second one, to the right.
    """

    across: float = 0.0
    ahead: float = 0.0
    turn: float = 0.0

    def within(self, most: float = 1.0) -> Stick:
        """Return the same direction with a deflection of at most `most`."""
        share = most / max(norm(self.across, self.ahead), most)
        return Stick(share * self.across, share * self.ahead, self.turn)


def command_of(drive: Drive, stick: Stick) -> tuple[float, ...]:
    """Return the command of a drive that a stick asks for.

    A drive that moves in the world's frame goes where the stick points to in the picture. Others
    go ahead or back by it, and turn: a robot of two wheels at 1.5 rad/s, or as quickly as its
    wheels allow, for which it goes slower as far as needed; a car steers.
    """
    return drive.steered(*stick)


def ramped(stick: Stick, wanted: Stick, duration: float) -> Stick:
    """Return the position of a stick that is on its way, `duration` seconds later."""
    return Stick(*(_towards(a, b, duration) for a, b in zip(stick, wanted, strict=True)))


def _towards(value: float, wanted: float, duration: float) -> float:
    outwards = abs(wanted) > abs(value) and wanted * value >= 0
    step = duration * (RISE if outwards else FALL)
    return min(max(wanted, value - step), value + step)
