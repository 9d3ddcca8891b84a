"""Games of pursuit: hunters, evaders, captures, and a winner."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.contest import Capture, Contest, Outcome, Teams, listed, mark
from mars2d.core.arithmetic import norms
from mars2d.core.description import entry, real, wrong
from mars2d.core.errors import likely
from mars2d.core.interfaces import FrameLike, RecordLike, ScenarioLike, WorldLike
from mars2d.core.scene import Scene, faded

__all__ = ["Capture", "Game", "Outcome"]

Float = NDArray[np.float64]
CONTACT = "contact"


def _capture(name: str, value: object) -> str | float:
    expected = "'contact', or a distance between two robots' poses, > 0 [m]"
    if isinstance(value, str):
        if value != CONTACT:
            raise wrong(name, value, expected + likely(value, [CONTACT]))
        return value
    distance = real(name, value, expected)
    if distance <= 0:
        raise wrong(name, value, expected)
    return distance


class Game(Contest):
    """A game of pursuit: robots of the first role hunt those of the second.

    >>> game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=0.4)
    >>> game.roles
    (('pursuer', ('red',)), ('evader', ('blue',)))

    An evader is caught when a hunter touches it, or comes as near as `capture`; this is checked
    once a control step. It stands still from then on, and the game goes on with the others. The
    hunters have won when all are caught, which ends the experiment; the evaders, when one is free
    at the stop time. Whatever else ends an experiment leaves a game undecided.

    Laws find how it stands in `score`, `winner`, `caught`, `free` and `capture_times`. Of a record,
    `outcome` says the same, also of a loaded one.
    """

    capture: str | float = entry(
        default=CONTACT, check=_capture, unit="m",
        doc="'contact', or how near a hunter's pose has to come to an evader's",
    )  # fmt: skip

    # -- how it stands, in a world -----------------------------------------------------------------

    def on_start(self, world: WorldLike) -> None:
        """Find the robots; raise InputError if one is not there, or has two roles."""
        self._teams = self.teams(world.scenario)
        self._captures: tuple[Capture, ...] = ()
        self._time_is_over = False

    def on_step(self, world: WorldLike) -> None:
        """Note new captures; end the experiment when all are caught, or when time is over."""
        now = self._found(
            (self._teams[0], self.free), np.array([world.time]), world.pose[None], world.contacts
        )
        self._captures += now
        for capture in now:
            world.hold(capture.evader)
        self._time_is_over = world.iteration >= world.scenario.last_iteration
        if self.winner is not None:
            world.stop(self._message(world))

    @property
    def captures(self) -> tuple[Capture, ...]:
        """The captures so far, in order."""
        return self._captures

    @property
    def caught(self) -> tuple[int, ...]:
        """The indices of the caught robots, in order."""
        return tuple(capture.evader for capture in self._captures)

    @property
    def capture_times(self) -> tuple[float, ...]:
        """The times of the captures, seconds."""
        return tuple(capture.time for capture in self._captures)

    @property
    def hunters(self) -> tuple[int, ...]:
        """The indices of the hunters."""
        return self._teams[0]

    @property
    def free(self) -> tuple[int, ...]:
        """The indices of the evaders that are not caught."""
        caught = self.caught
        return tuple(evader for evader in self._teams[1] if evader not in caught)

    @property
    def score(self) -> dict[str, int]:
        """The number of captures and the number of free evaders, by role."""
        return self._outcome(self._teams, self._captures, self._time_is_over).score

    @property
    def winner(self) -> str | None:
        """The role that has won, or None."""
        return self._outcome(self._teams, self._captures, self._time_is_over).winner

    def _message(self, world: WorldLike) -> str:
        """Return why the game is over, in words."""
        names = [str(robot.name) for robot in world.scenario.robots]
        free, evaders = self.free, len(self._teams[1])
        if free:
            who = f"{len(free)} of {evaders} were" if evaders > 1 else f"{names[free[0]]} was"
            return f"{who} not caught in {world.time:g} s: {self.winner} wins"
        time, hunter, evader = self._captures[-1]
        whom = f"{names[evader]}, the last of {evaders}," if evaders > 1 else names[evader]
        return f"{names[hunter]} catches {whom} after {round(time, 2):g} s: {self.winner} wins"

    # -- how it stands, by a record ----------------------------------------------------------------

    def outcome(self, record: RecordLike) -> Outcome:
        """Return captures, score and winner of a record, loaded or just made."""
        teams = self.teams(record.scenario)
        contacts = record.contacts[record.contact_rows < len(record)]  # before its last row
        captures = self._found(teams, record.time, record.pose, contacts)
        return self._outcome(teams, captures, len(record) > record.scenario.last_iteration)

    def _outcome(self, teams: Teams, captures: tuple[Capture, ...], time_is_over: bool) -> Outcome:
        (hunting, _), (evading, _) = self.roles
        free = len(teams[1]) - len(captures)
        winner = hunting if not free else evading if time_is_over else None
        return Outcome(captures, {hunting: len(captures), evading: free}, winner)

    def _found(
        self, teams: Teams, time: Float, pose: Float, contacts: NDArray[np.void]
    ) -> tuple[Capture, ...]:
        """Return the first capture of each evader, in order.

        time: (T,). pose: (T, 3, n). contacts: all in that time, in order.
        """
        hunters, evaders = teams
        if self.capture == CONTACT:
            touches = _touches(contacts, hunters, evaders)
        else:
            touches = _approaches(time, pose, hunters, evaders, float(self.capture))
        first: dict[int, Capture] = {}
        for touch in touches:
            first.setdefault(touch.evader, touch)
        return tuple(first.values())

    # -- how it is explained -----------------------------------------------------------------------

    scored: ClassVar[tuple[str, str]] = ("caught", "free")

    def aim(self, role: str, scenario: ScenarioLike) -> str:
        """Return how hunters or evaders win, in a few words."""
        (hunting, _), _ = self.roles
        if role == hunting:
            return f"catch {listed(scenario, self.teams(scenario)[1])}"
        return f"do not be caught for {scenario.last_iteration * scenario.sampling_time:g} s"

    @property
    def counts(self) -> str:
        """What is a capture, and who has won, in a few sentences."""
        (hunting, hunters), (evading, evaders) = self.roles
        near = (
            f"touches the {evading}"
            if self.capture == CONTACT
            else f"comes within {self.capture:g} m of the {evading}, from middle to middle"
        )
        whole = f"the {hunting} wins with the capture, and the {evading} if time is over before"
        if len(evaders) > 1:
            whole = (
                f"who is caught stands still. With all {len(evaders)} caught, the {hunting} wins; "
                f"with one of them free when time is over, the {evading}"
            )
        who = f"the {hunting}" if len(hunters) == 1 else f"one of {len(hunters)} as {hunting}"
        return f"A capture is when {who} {near}: {whole}."

    # -- how it looks ------------------------------------------------------------------------------

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Cross out the caught ones, with the time of their capture; draw the hunters' reach."""
        scenario, teams = frame.scenario, self.teams(frame.scenario)
        pose = frame.pose[None]
        if self.capture != CONTACT:
            pose = np.concatenate([frame.path, pose])
        time = np.arange(len(pose)) * np.float64(scenario.sampling_time)
        found = self._found(teams, time, pose, frame.contact_log())
        if self.capture != CONTACT:
            for hunter in teams[0]:
                color = faded(scenario.colors[hunter], 0.5)
                scene.circle(frame.pose[:2, hunter], float(self.capture), stroke=color)
        for capture in found:
            above = bool(frame.pose[1, capture.evader] > frame.pose[1, capture.hunter])
            mark(scene, frame, capture.evader, f"{round(capture.time, 1):g} s", above)


def _touches(
    contacts: NDArray[np.void], hunters: tuple[int, ...], evaders: tuple[int, ...]
) -> list[Capture]:
    """Return a capture for each touch of a hunter and an evader, in the order of the contacts."""
    if not len(contacts):
        return []
    a, b = contacts["a"], contacts["b"]
    hunts = np.isin(a, hunters) & np.isin(b, evaders)
    hunted = np.isin(b, hunters) & np.isin(a, evaders)
    return [
        Capture(float(contacts["time"][k]), int(h), int(e))
        for k in np.flatnonzero(hunts | hunted)
        for h, e in [(a[k], b[k]) if hunts[k] else (b[k], a[k])]
    ]


def _approaches(
    time: Float, pose: Float, hunters: tuple[int, ...], evaders: tuple[int, ...], reach: float
) -> list[Capture]:
    """Return the first capture of each evader by the nearest hunter in reach, in order."""
    found = []
    for evader in evaders:
        x, y = (pose[:, k, list(hunters)] - pose[:, k, evader, None] for k in (0, 1))
        distance = norms(x, y)
        rows = np.flatnonzero(distance.min(axis=1) <= reach)
        if len(rows):
            nearest_one = hunters[int(distance[rows[0]].argmin())]
            found.append(Capture(float(time[rows[0]]), nearest_one, evader))
    return sorted(found, key=lambda capture: capture.time)
