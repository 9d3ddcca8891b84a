"""The clock of a window: how far the source goes as wall time passes."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from typing import Literal

from mars2d.core.errors import Mars2dError
from mars2d.record.frame import Frame, between
from mars2d.record.marks import meetings, meets
from mars2d.scenario.animation import playback_speed
from mars2d.window.screen.source import Playback, Source
from mars2d.window.widgets.slider import BEHIND, times

Kind = Literal["running", "waiting", "past", "error"]
Status = tuple[str, Kind]
"""The state of the clock in words, and its kind."""

SPEEDS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
"""The rungs of + and -; above them is "max"."""

MAX_GAP = 0.1
"""The longest wall time between two pictures that is caught up with, seconds."""

SHARE_AT_MAX = 9.0
"""At speed max, the time of the simulation as a multiple of the last picture's drawing time..."""
MAX_TIME_AT_MAX = 0.1
"""... and the longest such time, seconds."""


class Player:
    """Plays a source at a factor of real time, as fast as possible, paused, or in single steps.

    speed: a factor, 0 for manual mode (one step a key press), or "max". budget: the time that the
    simulation may take for each picture, seconds.
    """

    def __init__(
        self,
        source: Source,
        speed: float | str,
        budget: float = 0.014,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        """Start at the source's present frame, playing unless in manual mode."""
        checked = playback_speed("speed", speed)
        self.source = source
        self.speed = inf if checked == "max" else float(checked)
        self.paused = False
        self.stops = False  # where a contact begins
        self.body: int | None = None  # whose contacts count; None for all
        self.error: Mars2dError | None = None
        self.drawing = 0.0  # the time of the last picture, seconds
        self._goal: float | None = None  # the row to go on to; inf: until a contact begins
        self._met = False  # whether a contact has just begun at which it stops
        self._budget, self._clock = budget, clock
        self._present = source.frame
        self._previous: Frame | None = None
        self._time = self._present.time
        self._seen: tuple[Frame, float, Frame] | None = None  # next frame, time, interpolated
        self._moments: Sequence[Frame] = ()  # within a control step, from the row on
        self._moment = 0  # the one that is shown
        self._pace: deque[tuple[float, float]] = deque()

    @property
    def manual(self) -> bool:
        """Whether each step waits for a key."""
        return self.speed == 0

    @property
    def playing(self) -> bool:
        """Whether time passes."""
        return not (self.paused or self.manual or self.over)

    @property
    def busy(self) -> bool:
        """Whether steps are still to be done."""
        return self._goal is not None

    @property
    def past(self) -> bool:
        """Whether an earlier row than the newest is shown, of a run that goes on from it."""
        return self._behind and not isinstance(self.source, Playback)

    @property
    def _behind(self) -> bool:
        return self.source.row < self.source.newest

    @property
    def failed(self) -> bool:
        """Whether the row is shown at which a law, sensor or add-on has failed."""
        return self.error is not None and not self._behind

    @property
    def over(self) -> bool:
        """Whether the last frame is reached and shown, or a law has failed."""
        return self.failed or (self.source.over and self._time >= self._present.time)

    @property
    def frame(self) -> Frame:
        """The frame to draw: between the last two while time passes, else the last."""
        if self._moments:
            return self._moments[self._moment]
        present, previous = self._present, self._previous
        if previous is None or self._time >= present.time or present.time <= previous.time:
            return present
        if self._seen is None or self._seen[0] is not present or self._seen[1] != self._time:
            self._seen = present, self._time, between(previous, present, self._time)
        return self._seen[2]

    @property
    def factor(self) -> float | None:
        """The recent factor of real time, None if it is not known yet."""
        if len(self._pace) < 2:
            return None
        (wall0, time0), (wall1, time1) = self._pace[0], self._pace[-1]
        return (time1 - time0) / (wall1 - wall0) if wall1 - wall0 > 0.25 else None

    def pass_time(self, wall: float) -> None:
        """Advance by `wall` seconds since the last picture."""
        if self._goal is not None:
            self._go_on()
        if not self.playing:
            self._pace.clear()
            return
        if self.speed == inf:
            # For as long as a picture may take, without frames in between.
            longest = max(self._budget, min(SHARE_AT_MAX * self.drawing, MAX_TIME_AT_MAX))
            deadline = self._clock() + longest
            while not self.source.over and self._advance() and not self._met:
                if self._clock() >= deadline:
                    break
            self.settle()
        else:
            wanted = self._time + self.speed * min(wall, MAX_GAP)
            self._advance_until(wanted)
            # If the simulation is too slow, time waits for it and does not catch up later.
            self._time = min(wanted, self._present.time)
        if self._met:
            self.pause()
            self._met = False
        now = self._clock()
        if self._pace and self._time < self._pace[-1][1]:  # it was started again
            self._pace.clear()
        self._pace.append((now, self._time))
        while now - self._pace[0][0] > 1.5:
            self._pace.popleft()

    def step(self, count: int = 1) -> None:
        """Advance by `count` sampling times, over several pictures if need be, and pause.

        More steps that are still to be done are not cut short, as by a key that repeats.
        """
        goal, wanted = self._goal, self.source.row + count
        self.pause()
        self._goal = wanted if goal is None or goal == inf else max(goal, wanted)
        self._go_on()

    def look_within(self, moments: Sequence[Frame]) -> None:
        """Show the row, and with `step_within` the moments within the step that follows it."""
        self.pause()
        self._moments = [self._present, *moments]

    def step_within(self, way: int) -> bool:
        """Show the next moment within a step, or for -1 the last one; return if there is one."""
        there = 0 <= self._moment + way < len(self._moments)
        self._moment += way if there else 0
        return there

    def next_contact(self) -> None:
        """Go to the next row at which a contact begins; at the newest, run until one does."""
        later = [row for row in self._meetings() if row > self.source.row]
        if later:
            self.go(later[0])
            return
        self.go(self.source.newest)
        self._goal = None if self.source.over or self.failed else inf

    def last_contact(self) -> None:
        """Go back to the last row before this one at which a contact began, or to the start."""
        self.go(max((row for row in self._meetings() if row < self.source.row), default=0))

    def _meetings(self) -> list[int]:
        contacts = self.source.contacts
        mine = contacts[meets(contacts, self.body)]
        return meetings(mine, self.source.scenario.sampling_time)

    def _meets(self) -> bool:
        """Return whether a contact began in the control step that led to the source's row."""
        return bool(meets(self.source.frame.contacts, self.body).any())

    def _go_on(self) -> None:
        """Go on towards the goal, as far as fits into the time of one picture."""
        deadline, seeks = self._clock() + self._budget, self._goal == inf
        while self._goal is not None and self.source.row < self._goal:
            if self.failed or self.source.over or not self._advance() or (seeks and self._meets()):
                break
            if self._clock() >= deadline:
                self.settle()
                return
        self._goal = None
        self.settle()

    def back(self, count: int = 1) -> None:
        """Go back by `count` sampling times, and pause."""
        self.go(self.source.row - count)

    def go(self, row: int) -> None:
        """Go to a row, or to the nearest recorded one, and pause."""
        self.pause()
        self.source.go(row)
        self.settle()

    def pause(self) -> None:
        """Stop time, and show the present frame."""
        self._goal = None
        if not self.manual:
            self.paused = True
        self.settle()

    def pause_or_resume(self) -> None:
        """Pause or resume, at the end from the start; in manual mode, do one step."""
        if self.manual:
            self.step()
            return
        self._goal, self._moments, self._moment = None, (), 0
        if self.over and not self.failed:
            self.source.go(0)
            self.settle()
            self.paused = False
            return
        self.paused = not self.paused
        if self.paused:
            self.settle()

    def set_speed(self, speed: float) -> None:
        """Play at a factor of real time; inf: as fast as possible."""
        if speed != self.speed:
            self.speed = speed
            self._pace.clear()

    def faster(self) -> None:
        """Go one rung up; from manual mode to the lowest rung."""
        self.set_speed(next((rung for rung in SPEEDS if rung > self.speed * (1 + 1e-9)), inf))

    def slower(self) -> None:
        """Go one rung down, not below the lowest."""
        lower = (rung for rung in reversed(SPEEDS) if rung < self.speed * (1 - 1e-9))
        self.set_speed(next(lower, self.speed))

    def restart(self) -> None:
        """Start again; a law that has failed is run again."""
        self.error = None
        self._goal = None
        self._pace.clear()
        try:
            self.source.restart()
        except Mars2dError as error:
            self.error = error
            self.source.go(self.source.newest)  # where the error is shown
        self.settle()

    def status(self) -> Status:
        """Return the state of the clock."""
        if self._moment:
            since = 1000 * (self.frame.time - self._present.time)
            return f"+{since:.3g} ms  {self._moment} of {len(self._moments) - 1}", "waiting"
        if self.past:
            ago = (self.source.newest - self.source.row) * self.source.scenario.sampling_time
            return f"{self._pace_in_words() if self.playing else 'past'}  {ago:g} s ago", "past"
        if self.over:
            return ("stopped", "error") if self.failed else ("over", "waiting")
        if self._goal is not None:
            left = self._goal - self.source.row
            return "until a contact" if left == inf else f"{left:.0f} steps", "running"
        if self.manual:
            return "manual", "waiting"
        return ("paused", "waiting") if self.paused else (self._pace_in_words(), "running")

    def _pace_in_words(self) -> str:
        factor = self.factor
        if self.speed == inf:
            return "max" if factor is None else f"max  {times(factor)}"
        text = times(self.speed)
        if factor is not None and factor < BEHIND * self.speed:
            text += f"  reaches {times(factor)}"
        return text

    def fail(self, error: Mars2dError) -> None:
        """Stop at the present frame, without drawings of add-ons and sensors: one has raised."""
        if str(self.error) != str(error):  # it raises again at each picture
            self.error = error
        self.settle()
        self._present = replace(self._present, readings={}, draw_addons=None)

    def settle(self) -> None:
        """Show the source's present frame, for example after a change of the world."""
        self._present = self.source.frame
        self._previous, self._moments, self._moment = None, (), 0
        self._time = self._present.time

    def _advance_until(self, wanted: float) -> None:
        deadline = self._clock() + self._budget
        while self._present.time < wanted and not self.source.over:
            before = self._present
            if not self._advance():
                self.settle()
                break
            self._present, self._previous = self.source.frame, before
            if self._met or self._clock() >= deadline:
                break

    def _advance(self) -> bool:
        """Advance by one sampling time; return whether nothing has failed."""
        try:
            self.source.advance()
        except Mars2dError as error:
            self.error = error
        self._met = self.stops and self._meets()
        return not self.failed
