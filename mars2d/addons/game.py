"""Games of pursuit: hunters, evaders, captures, a goal that may save an evader, and a winner."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.contest import Capture, Contest, Outcome, Teams, listed, mark, robots_of
from mars2d.core import checks
from mars2d.core.arithmetic import norms
from mars2d.core.description import accepts, entry, integer, real, wrong
from mars2d.core.errors import InputError, counted, likely, ordinal
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Outline, edges_of, outside_polygon
from mars2d.core.scene import Scene, faded

Float = NDArray[np.float64]
CONTACT, SIGHT = "contact", "sight"
GRASS = "#dcebdc"
"""The colour of the floor of a goal."""


@accepts({"anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"enum": [CONTACT, SIGHT]}]})
def _capture(name: str, value: object) -> str | float:
    expected = "'contact', 'sight', or a distance between two robots' poses, > 0 [m]"
    if isinstance(value, str):
        if value not in (CONTACT, SIGHT):
            raise wrong(name, value, expected + likely(value, [CONTACT, SIGHT]))
        return value
    distance = real(name, value, expected)
    if distance <= 0:
        raise wrong(name, value, expected)
    return distance


@accepts(checks.OUTLINE | {"minItems": 3})
def _goal(name: str, value: object) -> Outline | None:
    return None if value is None else checks.outline(name, value, least=3)


@accepts({"type": "array", "items": {"type": ["string", "integer"]}, "minItems": 1})
def _hunted(name: str, value: object) -> tuple[str | int, ...] | None:
    return None if value is None else robots_of(name, value)


class _Events(NamedTuple):
    """What has happened: captures in order, and when [s] evaders reached the goal, by index."""

    captures: tuple[Capture, ...]
    safe: dict[int, float]


class Game(Contest):
    """A game of pursuit: robots of the first role hunt those of the second.

    >>> game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=0.4)
    >>> game.roles
    (('pursuer', ('red',)), ('evader', ('blue',)))

    An evader is caught when a hunter touches it, comes as near as `capture`, or has it in sight:
    then no obstacle lies on the line between their poses. This is checked once a control step. A
    caught evader stands still from then on, and the game goes on with the others.

    With a `goal`, an evader is safe as soon as its pose is in it, and stands still there, too;
    without one, it is safe when time is over. The hunters need `wanted` captures, by default of
    all. The evaders have won when too many are safe for that; with a goal the hunters have won when
    time is over before. Either ends the experiment. Whatever else ends it leaves a game undecided.

    Laws find how it stands in `score`, `winner`, `caught`, `free`, `safe` and `capture_times`. Of
    a record, `outcome` says the same, also of a loaded one.
    """

    capture: str | float = entry(
        default=CONTACT, check=_capture, unit="m",
        doc="'contact', 'sight', or the distance of a hunter's pose from an evader's at a capture",
    )  # fmt: skip
    goal: Outline | None = entry(
        default=None, check=_goal, unit="m",
        doc="the polygon that the evaders must reach; None: they must stay free",
    )  # fmt: skip
    hunted: tuple[str | int, ...] | None = entry(
        default=None, check=_hunted,
        doc="the robots to catch, if not those of the second role, which then help them",
    )  # fmt: skip
    wanted: int | None = integer(
        default=None, low=1, high=10**6, optional=True,
        doc="the number of captures that the hunters need; None: all of the hunted",
    )  # fmt: skip

    # -- how it stands, in a world -----------------------------------------------------------------

    def on_start(self, world: WorldLike) -> None:
        """Find the robots; raise InputError if one is not there, or has two roles."""
        self._teams = self.players(world.scenario)
        self._edges = _edges(world.scenario) if self.capture == SIGHT else None
        self._events = _Events((), {})
        self._time_is_over = False

    def on_step(self, world: WorldLike) -> None:
        """Note who is caught or safe; end the experiment when it is won, or when time is over."""
        before = self._events
        now = self._found(
            (self._teams[0], self.free), np.array([world.time]), world.pose[None], world.contacts,
            self._edges,
        )  # fmt: skip
        self._events = _Events(before.captures + now.captures, before.safe | now.safe)
        for robot in (*(capture.evader for capture in now.captures), *now.safe):
            world.hold(robot)
        self._time_is_over = world.iteration >= world.scenario.last_iteration
        if self.winner is not None:
            world.stop(self._message(world))

    @property
    def captures(self) -> tuple[Capture, ...]:
        """The captures so far, in order."""
        return self._events.captures

    @property
    def caught(self) -> tuple[int, ...]:
        """The indices of the caught robots, in order."""
        return tuple(capture.evader for capture in self.captures)

    @property
    def capture_times(self) -> tuple[float, ...]:
        """The times of the captures, seconds."""
        return tuple(capture.time for capture in self.captures)

    @property
    def safe(self) -> tuple[int, ...]:
        """The indices of the evaders that have reached the goal, in order."""
        return tuple(self._events.safe)

    @property
    def free(self) -> tuple[int, ...]:
        """The indices of the evaders that are neither caught nor safe in the goal."""
        out = {*self.caught, *self._events.safe}
        return tuple(evader for evader in self._teams[1] if evader not in out)

    @property
    def results(self) -> dict[int, float]:
        """The results of robots that are out of the game: -1 if caught, 1 if safe."""
        return dict.fromkeys(self.caught, -1.0) | dict.fromkeys(self.safe, 1.0)

    @property
    def score(self) -> dict[str, int]:
        """The number of captures, and the number of evaders that are not caught, by role."""
        return self._outcome(self._teams, self._events, self._time_is_over).score

    @property
    def winner(self) -> str | None:
        """The role that has won, or None."""
        return self._outcome(self._teams, self._events, self._time_is_over).winner

    def _message(self, world: WorldLike) -> str:
        """Return why the game is over, in words."""
        names = [str(robot.name) for robot in world.scenario.robots]
        evaders, wins = len(self._teams[1]), f": {self.winner} wins"
        if len(self.captures) >= self._needed(self._teams):
            time, hunter, evader = self.captures[-1]
            count = len(self.captures)
            which = "last" if count == evaders else ordinal(count)
            whom = names[evader] + (f", the {which} of {evaders}," if evaders > 1 else "")
            verb = "sees" if self.capture == SIGHT else "catches"
            return f"{names[hunter]} {verb} {whom} after {round(time, 2):g} s{wins}"
        if self.goal is not None and self.winner == self.roles[1][0]:
            count = len(self.safe)
            who = f"{names[self.safe[0]]} has" if evaders == 1 else f"{count} of {evaders} have"
            return f"{who} reached the goal after {world.time:g} s{wins}"
        if self.goal is not None:
            return f"time is over after {world.time:g} s{wins}"
        count, done = len(self.free), "seen" if self.capture == SIGHT else "caught"
        who = f"{count} of {evaders} were" if evaders > 1 else f"{names[self.free[0]]} was"
        return f"{who} not {done} in {world.time:g} s{wins}"

    # -- how it stands, by a record ----------------------------------------------------------------

    def outcome(self, record: Any) -> Outcome:
        """Return captures, score and winner of a record, loaded or just made."""
        teams = self.players(record.scenario)
        contacts = record.contacts[record.contact_rows < len(record)]  # before its last row
        edges = _edges(record.scenario) if self.capture == SIGHT else None
        events = self._found(teams, record.time, record.pose, contacts, edges)
        return self._outcome(teams, events, len(record) > record.scenario.last_iteration)

    def players(self, scenario: ScenarioLike) -> Teams:
        """Return the indices of the hunters in a scenario, and of those that they hunt.

        Raises InputError for a robot that is not there or has two roles, for a hunter that is
        hunted, and if more are `wanted` than there are.
        """
        hunters, evaders = self.teams(scenario)
        if self.hunted is not None:
            field = f"{type(self).__name__}.hunted"
            evaders = tuple(scenario.index_of(field, robot) for robot in self.hunted)
            for robot in evaders:
                if robot in hunters:
                    raise InputError(f"{field}: {scenario.robots[robot].name} is a hunter")
        if self.wanted is not None and self.wanted > len(evaders):
            raise wrong(
                f"{type(self).__name__}.wanted", self.wanted,
                f"at most {len(evaders)}, as there are {counted(len(evaders), 'robot')} to catch",
            )  # fmt: skip
        return hunters, evaders

    def _needed(self, teams: Teams) -> int:
        """Return how many captures the hunters need."""
        return len(teams[1]) if self.wanted is None else self.wanted

    def _outcome(self, teams: Teams, events: _Events, time_is_over: bool) -> Outcome:
        (hunting, _), (evading, _) = self.roles
        caught, needed = len(events.captures), self._needed(teams)
        left = len(teams[1]) - caught  # those that are not caught
        safe = left if time_is_over and self.goal is None else len(events.safe)
        winner = None
        if caught >= needed:
            winner = hunting
        elif safe > len(teams[1]) - needed:
            winner = evading
        elif time_is_over:
            winner = hunting
        return Outcome(events.captures, {hunting: caught, evading: left}, winner)

    def _found(
        self,
        teams: Teams,
        time: Float,
        pose: Float,
        contacts: NDArray[np.void],
        edges: Float | None,
    ) -> _Events:
        """Return the first capture of each evader, in order, and who was at the goal before one.

        time: (T,). pose: (T, 3, n). contacts: all in that time, in order. edges: (k, 4), those of
        the obstacles, that hide an evader from a hunter; None if captures don't depend on them.
        """
        hunters, evaders = teams
        if self.capture == CONTACT:
            meetings = _touches(contacts, hunters, evaders)
        else:
            near = _sights(pose, hunters, evaders, edges) if edges is not None else None
            reach = np.inf if near is not None else float(self.capture)
            meetings = _approaches(time, pose, hunters, evaders, reach, near)
        first: dict[int, Capture] = {}
        for meeting in meetings:
            first.setdefault(meeting.evader, meeting)
        safe = self._arrivals(time, pose, evaders)
        captures = [c for c in first.values() if c.time <= safe.get(c.evader, np.inf)]
        caught = {capture.evader for capture in captures}
        return _Events(tuple(captures), {e: when for e, when in safe.items() if e not in caught})

    def _arrivals(self, time: Float, pose: Float, evaders: tuple[int, ...]) -> dict[int, float]:
        """Return when [s] evaders were first in the goal, by index, in order."""
        if self.goal is None or not len(time):
            return {}
        area = np.array(self.goal)
        first = {}
        for evader in evaders:
            inside = ~outside_polygon(pose[:, 0, evader], pose[:, 1, evader], area)
            if inside.any():
                first[evader] = float(time[inside.argmax()])
        return dict(sorted(first.items(), key=lambda robot_time: robot_time[1]))

    # -- how it is explained -----------------------------------------------------------------------

    scored: ClassVar[tuple[str, str]] = ("caught", "free")

    def aim(self, role: str, scenario: ScenarioLike) -> str:
        """Return how hunters or evaders win, in a few words."""
        _, evaders = teams = self.players(scenario)
        needed, whom = self._needed(teams), listed(scenario, evaders)
        time = f"for {scenario.last_iteration * scenario.sampling_time:g} s"
        if role == self.roles[0][0]:
            verb = "see" if self.capture == SIGHT else "catch"
            some = whom if needed == len(evaders) else f"{needed} of {len(evaders)}"
            if self.goal is None:
                return f"{verb} {some}"
            return f"{verb} {some} before {_so_many_are(len(evaders), needed)} in the goal"
        if self.goal is not None:
            return "reach the goal uncaught"
        if self.hunted is not None:
            return f"let nobody catch {whom} {time}"
        return f"stay out of sight {time}" if self.capture == SIGHT else f"stay free {time}"

    @property
    def counts(self) -> str:
        """What is a capture, and who has won, in a few sentences."""
        (hunting, hunters), (evading, evaders) = self.roles
        count = len(evaders if self.hunted is None else self.hunted)
        needed = count if self.wanted is None else self.wanted
        how = {
            CONTACT: "touches an evader",
            SIGHT: "sees an evader, with no obstacle between their middles",
        }.get(str(self.capture), f"comes within {self.capture} m of an evader, middle to middle")
        hunter = f"the {hunting}"
        if len(hunters) > 1:
            hunter = f"one of {len(hunters)} {hunting.removesuffix('s')}s"
        hunters_win, evaders_win = (
            f"{role} win" if role.endswith("s") else f"{role} wins" for role in (hunting, evading)
        )
        how = how.replace("an evader", f"the {evading}" if count == 1 else f"one of {count}")
        if self.hunted is not None:
            how = how.replace(f"the {evading}", "the hunted one")
        parts = [f"A capture is when {hunter} {how}."]
        if count > 1:
            parts.append("Who is caught stands still.")
        captures = "the capture" if needed == 1 else f"{needed} captures"
        parts.append(f"The {hunters_win} with {captures}.")
        if self.goal is None:
            parts.append(f"If time is over before, the {evaders_win}.")
        else:
            safe = _so_many_are(count, needed)
            parts.append(f"The {evaders_win} when {safe} in the goal uncaught.")
            parts.append(f"If time is over before, the {hunters_win}.")
        return " ".join(parts)

    # -- how it looks ------------------------------------------------------------------------------

    def paint(self, scene: Scene, area: Outline) -> None:  # noqa: ARG002
        """Paint the floor of the goal."""
        if self.goal is not None:
            scene.polygon(self.goal, fill=GRASS)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Cross out the caught ones, ring those that are safe; draw the hunters' reach."""
        scenario, teams = frame.scenario, self.players(frame.scenario)
        pose = frame.pose[None]
        if self.capture != CONTACT or self.goal is not None:
            pose = np.concatenate([frame.path, pose])
        time = np.arange(len(pose)) * np.float64(scenario.sampling_time)
        edges = _edges(scenario) if self.capture == SIGHT else None
        found = self._found(teams, time, pose, frame.contact_log(), edges)
        if not isinstance(self.capture, str):
            for hunter in teams[0]:
                color = faded(scenario.colors[hunter], 0.5)
                scene.circle(frame.pose[:2, hunter], self.capture, stroke=color)
        for capture in found.captures:
            above = bool(frame.pose[1, capture.evader] > frame.pose[1, capture.hunter])
            if self.capture == SIGHT:
                ends = [frame.pose[:2, robot] for robot in (capture.hunter, capture.evader)]
                scene.line(ends, stroke=faded(scenario.colors[capture.hunter], 0.5), width=1.2)
            mark(scene, frame, capture.evader, f"{round(capture.time, 1):g} s", above)
        for robot, when in found.safe.items():
            mark(scene, frame, robot, f"{round(when, 1):g} s", above=True, cross=False)


def _so_many_are(count: int, needed: int) -> str:
    """Return how many of so many evaders decide it by their goal, with the verb."""
    safe = count - needed + 1
    return "it is" if count == 1 else f"{safe} of {count} {'is' if safe == 1 else 'are'}"


def _edges(scenario: ScenarioLike) -> Float:
    """Return the edges of all obstacles (k, 4): x1, y1, x2, y2."""
    edges = [(*a, *b) for outline in scenario.obstacles for a, b in edges_of(outline)]
    return np.array(edges, dtype=float).reshape(-1, 4)


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


def _sights(
    pose: Float, hunters: tuple[int, ...], evaders: tuple[int, ...], edges: Float
) -> NDArray[np.bool_]:
    """Return which evaders are in sight of which hunters (T, h, e): no edge is between them.

    pose: (T, 3, n). edges: (k, 4).
    """
    start = pose[:, :2, list(hunters)].transpose(0, 2, 1)[:, :, None, None]  # (T, h, 1, 1, 2)
    end = pose[:, :2, list(evaders)].transpose(0, 2, 1)[:, None, :, None]
    a, b = edges[:, :2], edges[:, 2:]
    apart = _side(start, end, a) * _side(start, end, b) < 0
    across = _side(a, b, start) * _side(a, b, end) < 0
    return np.asarray(~(apart & across).any(axis=-1))


def _side(start: Float, end: Float, point: Float) -> Float:
    """Return on which side of a line points lie: > 0 to its left. Arrays (..., 2)."""
    way, to = end - start, point - start
    return np.asarray(way[..., 0] * to[..., 1] - way[..., 1] * to[..., 0])


def _approaches(
    time: Float,
    pose: Float,
    hunters: tuple[int, ...],
    evaders: tuple[int, ...],
    reach: float,
    seen: NDArray[np.bool_] | None = None,
) -> list[Capture]:
    """Return the first capture of each evader by the nearest hunter in reach, in order.

    seen: (T, h, e), whom the hunters see, where they have to; None: where they need not.
    """
    found = []
    for k, evader in enumerate(evaders):
        x, y = (pose[:, axis, list(hunters)] - pose[:, axis, evader, None] for axis in (0, 1))
        distance = norms(x, y)
        if seen is not None:
            distance = np.where(seen[:, :, k], distance, np.inf)
        near = distance.min(axis=1)
        rows = np.flatnonzero((near <= reach) & np.isfinite(near))
        if len(rows):
            nearest_one = hunters[int(distance[rows[0]].argmin())]
            found.append(Capture(float(time[rows[0]]), nearest_one, evader))
    return sorted(found, key=lambda capture: capture.time)
