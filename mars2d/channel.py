"""The channel: carries the messages of one world, as its add-on Communication says."""

from __future__ import annotations

import json
from collections import defaultdict
from math import ceil, hypot, nan
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mars2d.addons.communication import Communication
from mars2d.burst import Burst
from mars2d.errors import LawError, nearest, shown
from mars2d.message import (
    LOST,
    ON_ITS_WAY,
    OUT_OF_REACH,
    OVER_BANDWIDTH,
    Message,
    as_text,
)

if TYPE_CHECKING:
    from mars2d.recorder import Recorder
    from mars2d.world import World

__all__ = ["Channel"]

ROUNDING = 1e-9
"""Delays that differ by less are the same, in sampling times."""

WHO = "a robot's index or name, a list of these, or None for all in reach"


class _Sent(NamedTuple):
    """What a robot has sent in the present control step: to whom, and whether it gets there."""

    sender: int
    step: int  # the iteration
    text: str
    size: int
    receivers: dict[int, int]  # to what becomes of it as far as that is known: a status


class Channel:
    """Carries messages from robot to robot.

    In a control step, `deliver` comes first, then anybody may `send`, and `transmit` ends it. All
    chance lies in `transmit`, which takes the senders in order: so what becomes of a message does
    not depend on the order in which laws are asked.
    """

    def __init__(self, world: World, model: Communication, recorder: Recorder) -> None:
        """Take the world, the live add-on, whose random stream is drawn from, and the recorder."""
        self._world, self._model, self._recorder = world, model, recorder
        self._names = [str(robot.name) for robot in world.scenario.robots]
        self._indices = {name: i for i, name in enumerate(self._names)}
        dt = world.scenario.sampling_time
        self._steps = max(1, ceil(model.delay / dt - ROUNDING))
        self.delay = self._steps * dt  # s, from sending to arrival
        self._sent: list[_Sent] = []
        self._used: dict[int, int] = defaultdict(int)  # bytes sent in this control step
        self._coming: dict[int, list[tuple[int, Message]]] = {}  # by the iteration of arrival
        self._inbox: dict[int, list[Message]] = {}
        self._links: dict[tuple[int, int], tuple[int, bool]] = {}  # when each was last known as bad

    def inbox(self, robot: int) -> tuple[Message, ...]:
        """Return the messages that have arrived for a robot at the present control step."""
        return tuple(self._inbox.get(robot, ()))

    def deliver(self) -> None:
        """Put into the inboxes what arrives at the present control step; empty all others."""
        self._inbox = {}
        for receiver, message in self._coming.pop(self._world.iteration, ()):
            self._inbox.setdefault(receiver, []).append(message)

    def send(self, sender: int, content: Any, to: Any) -> None:
        """Take a message of a robot. Raises LawError if it can't be recorded, or for a wrong `to`.

        to: an index or a name, a list of these, or None for all in reach.
        """
        text = as_text(content)
        size = len(text.encode())
        others = self._receivers(sender, to)
        reached = self._reached(sender, others)
        if to is None:
            others = [i for i in others if i in reached]
        fits = self._model.bandwidth is None or self._used[sender] + size <= self._model.bandwidth
        if fits:
            self._used[sender] += size
        going = ON_ITS_WAY if fits else OVER_BANDWIDTH
        receivers = {i: going if i in reached else OUT_OF_REACH for i in others}
        self._sent.append(_Sent(sender, self._world.iteration, text, size, receivers))

    def transmit(self) -> None:
        """Let all that was sent in the present control step go its way, and record it."""
        sent, self._sent = sorted(self._sent, key=lambda item: item.sender), []
        self._used.clear()
        dt = self._world.scenario.sampling_time
        for sender, step, text, _, receivers in sent:
            rows = []
            for receiver, known in receivers.items():
                status = known
                if known == ON_ITS_WAY and self._loses((sender, receiver), step):
                    status = LOST
                arrival = nan
                if status == ON_ITS_WAY:
                    arrival = (step + self._steps) * dt
                    letter = Message(sender, self._names[sender], step * dt, json.loads(text))
                    self._coming.setdefault(step + self._steps, []).append((receiver, letter))
                rows.append((arrival, receiver, status))
            if rows:
                self._recorder.write_messages(step * dt, sender, text, rows)

    def _loses(self, link: tuple[int, int], step: int) -> bool:
        """Return whether a link loses a message. A perfect one draws no random number."""
        rng = self._model.rng
        if self._model.burst is not None:
            bad = self._is_bad(self._model.burst, link, step)
            return self._model.burst.loses(bad, rng)
        return bool(self._model.loss) and bool(rng.random() < self._model.loss)

    def _is_bad(self, burst: Burst, link: tuple[int, int], step: int) -> bool:
        """Return whether a link is bad now; it stays so for the whole control step."""
        known, bad = self._links.get(link, (step, None))
        if bad is None or step > known:
            bad = burst.turns(bad, step - known, self._model.rng)
            self._links[link] = step, bad
        return bad

    # -- to whom -------------------------------------------------------------------------------

    def _receivers(self, sender: int, to: Any) -> list[int]:
        """Return to whom a message is sent, each robot once, by index."""
        if to is None:
            return [i for i in range(len(self._names)) if i != sender]
        if isinstance(to, np.ndarray):
            to = to.ravel().tolist()
        listed = to if isinstance(to, (list, tuple, set, frozenset)) else [to]
        return sorted({self._receiver(sender, one) for one in listed})

    def _receiver(self, sender: int, to: Any) -> int:
        where = f"robot.send(to={shown(to)})"
        if isinstance(to, str):
            if to not in self._indices:
                raise LawError(f"{where}: no robot is called so{nearest(to, self._names)}")
            found = self._indices[to]
        elif isinstance(to, (int, np.integer)) and not isinstance(to, bool):
            last = len(self._names) - 1
            if not 0 <= to <= last:
                raise LawError(f"{where}: no such robot; expected an index from 0 to {last}")
            found = int(to)
        else:
            raise LawError(f"{where}: expected {WHO}")
        if found == sender:
            raise LawError(f"{where}: {self._names[sender]} can't send to itself")
        return found

    def _reached(self, sender: int, others: list[int]) -> set[int]:
        """Return which of the others the channel reaches from where the sender is."""
        world, model = self._world, self._model
        if model.neighbours_only:
            others = [i for i in others if sender in world.neighbour_indices(i)]
        x, y = world.pose[:2].tolist()
        if model.range is not None:
            others = [i for i in others if hypot(x[i] - x[sender], y[i] - y[sender]) <= model.range]
        if model.line_of_sight and others:
            there = world.pose[:2, others].T
            hidden = world.surroundings.hidden((x[sender], y[sender]), there, others, sender)
            others = [i for i, behind in zip(others, hidden.tolist(), strict=True) if not behind]
        return set(others)
