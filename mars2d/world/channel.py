"""The channel: carries the messages of one world, by the rules of its add-on Communication."""

from __future__ import annotations

import json
from collections import defaultdict
from math import inf, nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.communication import Burst, Communication
from mars2d.core.arithmetic import ROUNDING, steps_until
from mars2d.core.errors import InputError, LawError, shown
from mars2d.record.message import (
    LOST,
    MESSAGE,
    ON_ITS_WAY,
    OUT_OF_REACH,
    OVER_BANDWIDTH,
    Message,
    as_text,
)
from mars2d.scenario.neighbours import Everyone, within
from mars2d.scenario.scenario import index_among
from mars2d.world.state import State

Int = NDArray[np.int64]

BUFFER = 1.0
"""How long a message may take until it has been sent at the bandwidth, s; others are dropped."""

WHO = "a robot's index or name, a list of these, or None for all in reach"


class _Letter(NamedTuple):
    """A message for all its receivers."""

    sender: int
    name: str
    time: float
    text: str

    def opened(self) -> Message:
        """Return the message, with content of its own, which no other receiver can change."""
        return Message(self.sender, self.name, self.time, json.loads(self.text))


class Channel:
    """Carries messages from robot to robot.

    In a control step, `deliver` comes first, then anybody may `send`, and `transmit` ends it. Only
    `transmit` draws random numbers, sender by sender, so the fate of a message does not depend on
    the order in which laws are asked.
    """

    def __init__(self, world: State, model: Communication) -> None:
        """Take the world, and the live add-on, whose random stream is used."""
        self._world, self._model = world, model
        self._names = [str(robot.name) for robot in world.scenario.robots]
        # Those of the present control step: when they arrive, an iteration, and rows of MESSAGE.
        self._sent: list[tuple[_Letter, int, NDArray[np.void]]] = []
        self._free: dict[int, float] = defaultdict(float)  # when a sender has sent all, s
        self._coming: dict[int, list[tuple[_Letter, Int]]] = {}  # by the iteration of arrival
        self._letters: dict[int, list[_Letter]] = {}  # that have arrived, by receiver
        self._inbox: dict[int, tuple[Message, ...]] = {}  # as far as it was asked for
        self._links: dict[tuple[int, int], tuple[float, bool]] = {}  # when known as bad, s
        self._hearers: tuple[int, list[Int]] = (-1, [])

    def inbox(self, robot: int) -> tuple[Message, ...]:
        """Return the messages that have arrived for a robot at the present control step."""
        if robot not in self._inbox:
            letters = self._letters.get(robot, ())
            self._inbox[robot] = tuple([letter.opened() for letter in letters])
        return self._inbox[robot]

    def deliver(self) -> None:
        """Fill the inboxes with the messages that arrive now; empty all others."""
        coming = self._coming.pop(self._world.iteration, [])
        self._letters, self._inbox = defaultdict(list), {}
        for letter, receivers in sorted(coming, key=lambda item: item[0].sender):
            for receiver in receivers.tolist():
                self._letters[receiver].append(letter)

    def send(self, sender: int, content: Any, to: Any) -> None:
        """Take a message of a robot. Raises LawError if it can't be recorded, or for a wrong `to`.

        to: an index or a name, a list of these, or None for all in reach.
        """
        world, text = self._world, as_text(content)
        size = len(text.encode())
        receivers = self._receivers(sender, to)
        reached = self._reached(sender, receivers)
        if to is None:
            receivers, reached = receivers[reached], reached[reached]
        takes = size / (self._model.bandwidth or inf)
        sent = max(world.time, self._free[sender]) + takes
        fits = sent - world.time <= BUFFER + ROUNDING
        if fits:
            self._free[sender] = sent
        going = ON_ITS_WAY if fits else OVER_BANDWIDTH
        delay = sent - world.time + self._model.delay
        arrival = world.iteration + max(1, steps_until(delay, world.sampling_time))
        rows = np.empty(len(receivers), dtype=MESSAGE)
        rows["time"], rows["sender"], rows["size"] = world.time, sender, size
        rows["receiver"], rows["arrival"] = receivers, arrival * world.sampling_time
        rows["status"] = np.where(reached, going, OUT_OF_REACH)
        self._sent.append((_Letter(sender, self._names[sender], world.time, text), arrival, rows))

    def transmit(self) -> None:
        """Send off the messages of the present control step, and record them."""
        sent, self._sent = sorted(self._sent, key=lambda item: item[0].sender), []
        for letter, arrival, rows in sent:
            if not len(rows):
                continue
            receivers, status = rows["receiver"], rows["status"]
            going = np.flatnonzero(status == ON_ITS_WAY)
            status[going[self._lost(letter.sender, receivers[going], letter.time)]] = LOST
            arrives = status == ON_ITS_WAY
            rows["arrival"][~arrives] = nan
            if arrives.any():
                self._coming.setdefault(arrival, []).append((letter, receivers[arrives]))
            self._world.recorder.write_messages(letter.text, rows)

    def _lost(self, sender: int, receivers: Int, time: float) -> NDArray[np.bool_]:
        """Return the receivers that lose a message, as a mask (k,). Perfect links draw nothing."""
        model = self._model
        if model.burst is not None:
            burst, links = model.burst, [(sender, receiver) for receiver in receivers.tolist()]
            lost = [burst.loses(self._is_bad(burst, link, time), model.rng) for link in links]
            return np.array(lost, dtype=bool)
        if model.loss:
            return np.asarray(model.rng.random(len(receivers)) < model.loss)
        return np.zeros(len(receivers), dtype=bool)

    def _is_bad(self, burst: Burst, link: tuple[int, int], time: float) -> bool:
        """Return whether a link is bad during the control step at a time [s]."""
        known, bad = self._links.get(link, (time, None))
        if bad is None or time > known:
            bad = burst.turns(bad, time - known, self._model.rng)
            self._links[link] = time, bad
        return bad

    # -- to whom -------------------------------------------------------------------------------

    def _receivers(self, sender: int, to: Any) -> Int:
        """Return the receivers of a message by index (k,), each once."""
        if to is None:
            return np.delete(np.arange(len(self._names)), sender)
        where = f"robot.send(to={shown(to)})"
        listed = to if isinstance(to, (list, tuple, set, frozenset, np.ndarray)) else [to]
        try:
            found = sorted({index_among(where, "robot", one, self._names) for one in listed})
        except TypeError:
            raise LawError(f"{where}: expected {WHO}") from None
        except InputError as error:
            raise LawError(str(error)) from None
        if sender in found:
            raise LawError(f"{where}: {self._names[sender]} can't send to itself")
        return np.array(found, dtype=np.int64)

    def _reached(self, sender: int, others: Int) -> NDArray[np.bool_]:
        """Return a mask (k,) of the others that the channel reaches from the sender's position."""
        world, model = self._world, self._model
        reached = np.ones(len(others), dtype=bool)
        if model.neighbours_only and type(world.scenario.neighbours) is not Everyone:
            reached = np.isin(others, self._hearers_of(sender))
        x, y = world.pose[:2]
        if model.range is not None:
            reached &= within(x[others] - x[sender], y[others] - y[sender], model.range)
        return reached

    def _hearers_of(self, sender: int) -> Int:
        """Return the robots whose neighbour a robot is, by index; computed once a control step."""
        world, (asked, hearers) = self._world, self._hearers
        if asked < 0 or (asked != world.iteration and not world.scenario.neighbours.fixed):
            found: list[list[int]] = [[] for _ in self._names]
            for i in range(len(found)):
                for j in world.neighbour_indices(i):
                    found[j].append(i)
            hearers = [np.array(row, dtype=np.int64) for row in found]
            self._hearers = world.iteration, hearers
        return hearers[sender]
