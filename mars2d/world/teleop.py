"""Driving by hand: a stick that follows the keys; `Drive.steered` returns what it asks for."""

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

    def within(self) -> Stick:
        """Return the same direction with a deflection of at most 1."""
        share = 1.0 / max(norm(self.across, self.ahead), 1.0)
        return Stick(share * self.across, share * self.ahead, self.turn)

    def command(self, drive: Drive) -> tuple[float, ...]:
        """Return the command of a drive that it asks for; see `Drive.second_stick`."""
        stick = self.within() if drive.frame == "world" else self
        return drive.steered(*stick[: 3 if drive.second_stick else 2])


def ramped(stick: Stick, wanted: Stick, duration: float) -> Stick:
    """Return the position of a stick that is on its way, `duration` seconds later."""
    return Stick(*(_towards(a, b, duration) for a, b in zip(stick, wanted, strict=True)))


def _towards(value: float, wanted: float, duration: float) -> float:
    outwards = abs(wanted) > abs(value) and wanted * value >= 0
    step = duration * (RISE if outwards else FALL)
    return min(max(wanted, value - step), value + step)
