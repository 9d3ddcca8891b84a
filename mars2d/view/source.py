"""Where a window's frames come from: a live experiment or a recorded one."""

from __future__ import annotations

from typing import Protocol

from mars2d.frame import Frame
from mars2d.scenario import Scenario

__all__ = ["Source"]


class Source(Protocol):
    """What the window plays: a sequence of frames, one a sampling time."""

    @property
    def scenario(self) -> Scenario:
        """What is played."""

    @property
    def frame(self) -> Frame:
        """The present instant."""

    @property
    def over(self) -> bool:
        """Whether there is no further frame."""

    def advance(self) -> None:
        """Go on by one sampling time. Raises Mars2dError when a law fails; nothing when over."""

    def restart(self) -> None:
        """Go back to the start."""
