"""Games of pursuit: hunters, evaders, captures, a goal that may save an evader, and a winner."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.contest import (
    MARK,
    Capture,
    Elimination,
    Exit,
    Float,
    Outcome,
    Span,
    Teams,
    carrier_after,
    firsts,
    listed,
    mark,
    robots_of,
    wins,
)  # fmt: skip
from mars2d.core import checks
from mars2d.core.arithmetic import ROUNDING, norms
from mars2d.core.description import accepts, entry, flag, integer, number, real, wrong
from mars2d.core.errors import InputError, counted, likely
from mars2d.core.interfaces import FrameLike, ScenarioLike, WorldLike
from mars2d.core.plane import Outline, edges_of, outside_polygon
from mars2d.core.scene import Scene, faded

if TYPE_CHECKING:
    import shapely

CONTACT, SIGHT = "contact", "sight"
GRASS, HOME = "#dcebdc", "#dce4ef"
"""The colours of the floor of a goal, and of a home."""
FLAG = 0.8
"""The height of a flag, metres."""
FURTHER = 2.0
"""How many times its drive's speed a robot is never pushed at."""
TINY = 1e-30


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


class Game(Elimination):
    """A game of pursuit: robots of the first role hunt those of the second.

    >>> game = Game({"pursuer": ["red"], "evader": ["blue"]}, capture=0.4)
    >>> game.roles
    (('pursuer', ('red',)), ('evader', ('blue',)))

    An evader is caught when a hunter touches it, comes as near as `capture`, or has it in sight:
    then no obstacle lies on the line between their poses. This is checked once a control step, for
    nearness on the straight ways that both have come since the last one. A caught evader brakes
    from then on, but can be pushed, and shields others; the game goes on with those. Where
    `capture` is None nobody is caught: bodies alone keep evaders from their goal.

    With a `goal`, an evader is safe as soon as its pose is in it, and stands still there, too;
    without one, it is safe when time is over. The hunters need `wanted` captures, by default of
    all. The evaders have won when too many are safe for that; with a goal the hunters have won when
    time is over before, which is at the `par` if there is one. Either ends the experiment, unless
    it goes on `to_the_end`. Whatever else ends it leaves a game undecided.

    With a `home`, a flag stands in the goal. The first evader there takes it, and is safe only when
    it has carried it home; then, or when its carrier is caught, the flag is back in its place.

    Laws find how it stands in `score`, `winner`, `caught`, `free`, `safe`, `carrier` and
    `capture_times`. Of a record, `outcome` says the same, also of a loaded one.
    """

    capture: str | float | None = entry(
        default=CONTACT, check=checks.optional(_capture), unit="m",
        doc="what catches an evader; None: nothing",
    )  # fmt: skip
    goal: Outline | None = entry(
        default=None, check=checks.optional(checks.polygon), unit="m",
        doc="the polygon that the evaders must reach; None: they must stay free",
    )  # fmt: skip
    home: Outline | None = entry(
        default=None, check=checks.optional(checks.polygon), unit="m",
        doc="the polygon that evaders carry the flag to, from the goal; None: they need not",
    )  # fmt: skip
    hunted: tuple[str | int, ...] | None = entry(
        default=None, check=checks.optional(robots_of),
        doc="the robots to catch, if not those of the second role",
        names="robot",
    )  # fmt: skip
    wanted: int | None = integer(
        default=None, low=1, high=10**6, optional=True,
        doc="the number of captures that the hunters need; None: all of the hunted",
    )  # fmt: skip

    together: int = integer(
        default=1, low=1, high=10**6, doc="the number of hunters that it takes at once to catch one"
    )
    par: float | None = number(
        default=None, above=0, high=1e9, optional=True, unit="s",
        doc="when the time is over; None: the stop time",
    )  # fmt: skip
    to_the_end: bool = flag(
        default=False, doc="go on, though it is decided, until nobody is left to catch"
    )

    # -- how it stands -----------------------------------------------------------------------------

    def _validate(self) -> None:
        super()._validate()
        if self.capture is None and self.goal is None:
            raise wrong("Game.capture", None, "a way to capture, or a goal that evaders must reach")
        if self.home is not None and self.goal is None:
            raise wrong("Game.home", self.home, "a goal, too, where the flag stands")

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
        if self.together > len(hunters):
            most = f"at most {len(hunters)}, as there are {counted(len(hunters), 'hunter')}"
            raise wrong(f"{type(self).__name__}.together", self.together, most)
        return hunters, evaders

    def exits(self, teams: Teams, span: Span) -> list[Exit]:
        """Return the evaders that are caught, in order, then those that are safe before.

        With a home, those that take the flag follow.
        """
        captures: list[Exit] = []
        if self.capture == CONTACT:
            captures = _touches(teams, span, self.together)
        elif self.capture == SIGHT:
            captures = _approaches(teams, span, np.inf, _sights(teams, span), self.together)
        elif self.capture is not None:
            captures = _approaches(teams, span, float(self.capture), np.True_, self.together)
        safe: list[tuple[float, int]] = []
        taken: list[Exit] = []
        if self.goal is not None:
            there = _inside(self.goal, span)
            if self.home is None:
                safe = firsts(span.time, there, teams[1])
            else:
                there &= np.isin(np.arange(there.shape[1]), teams[1])
                safe, taken = _carried(there, _inside(self.home, span), span, captures)
        before = {robot: when for when, robot in safe}
        caught: dict[int, Exit] = {}
        for capture in captures:
            if capture.time <= before.get(capture.robot, np.inf):
                caught.setdefault(capture.robot, capture)
        arrived = [Exit(when, robot, 1.0) for when, robot in safe if robot not in caught]
        return [*caught.values(), *arrived, *taken]

    def judged(self, teams: Teams, exits: Sequence[Exit], time_is_over: bool) -> Outcome:
        """Return the captures, how many are caught and how many are not, and who has won."""
        (hunting, _), (evading, _) = self.roles
        captures = tuple(Capture(e.time, e.hunter, e.robot) for e in exits if e.hunter is not None)
        needed, left = self.wanted or len(teams[1]), len(teams[1]) - len(captures)
        in_time = [e for e in exits if e.result and e.time <= (self.par or np.inf)]
        caught = sum(leaving.hunter is not None for leaving in in_time)
        safe = (
            len(teams[1]) - caught if time_is_over and self.goal is None else len(in_time) - caught
        )
        winner = None
        if caught >= needed:
            winner = hunting
        elif safe > len(teams[1]) - needed:
            winner = evading
        elif time_is_over:
            winner = hunting
        return Outcome(captures, {hunting: len(captures), evading: left}, winner)

    def time_is_over(self, scenario: ScenarioLike, row: int) -> bool:
        """Return whether a row is the last one, or after the par."""
        late = self.par is not None and row * scenario.sampling_time > self.par
        return late or super().time_is_over(scenario, row)

    def outcome(self, record: Any) -> Outcome:
        """Return captures, score, winner and payoff of a record, loaded or just made."""
        found, end = super().outcome(record), float(record.time[-1])
        caught = {capture.evader: capture.time for capture in found.captures}
        evaders = self.players(record.scenario)[1]
        return found._replace(payoff=sum(caught.get(k, end) for k in evaders) / len(evaders))

    @property
    def captures(self) -> tuple[Capture, ...]:
        """The captures so far, in order."""
        return self.judged(self._teams, self._exits, self._time_is_over).captures

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
        return tuple(robot for robot, result in self.results.items() if result > 0)

    @property
    def carrier(self) -> int | None:
        """The index of the evader that carries the flag; None: nobody does."""
        return carrier_after(self._exits)

    @property
    def free(self) -> tuple[int, ...]:
        """The indices of the evaders that are neither caught nor safe in the goal."""
        return tuple(robot for robot in self._teams[1] if robot not in self.results)

    def ending(self, world: WorldLike) -> str:
        """Return why the game is over now, in words; "" while it goes on."""
        goes_on = self.to_the_end and self.free and world.iteration < world.scenario.last_iteration
        if self.winner is None or goes_on:
            return ""
        names = [str(robot.name) for robot in world.scenario.robots]
        evaders, won = len(self._teams[1]), f": {wins(self.winner)}"
        if len(self.captures) >= (self.wanted or evaders):
            time, hunter, evader = self.captures[-1]
            count = len(self.captures)
            which = "the last" if count == evaders else f"number {count}"
            whom = names[evader] + (f", {which} of {evaders}," if evaders > 1 else "")
            verb = "sees" if self.capture == SIGHT else "catches"
            late = f", not within {self.par:g} s" if self.winner == self.roles[1][0] else ""
            return f"{names[hunter]} {verb} {whom} after {round(time, 2):g} s{late}{won}"
        if self.goal is not None and self.winner == self.roles[1][0]:
            count = len(self.safe)
            who = f"{names[self.safe[0]]} has" if evaders == 1 else f"{count} of {evaders} have"
            done = "reached the goal" if self.home is None else "brought the flag home"
            return f"{who} {done} after {world.time:g} s{won}"
        if self.goal is not None:
            return f"finished after {world.time:g} s{won}"
        count, done = len(self.free), "seen" if self.capture == SIGHT else "caught"
        who = f"{count} of {evaders} were" if evaders > 1 else f"{names[self.free[0]]} was"
        return f"{who} not {done} in {world.time:g} s{won}"

    # -- how it is explained -----------------------------------------------------------------------

    scored: ClassVar[tuple[str, str]] = ("caught", "free")

    def aim(self, role: str, scenario: ScenarioLike) -> str:
        """Return how hunters or evaders win, in a few words."""
        _, evaders = self.players(scenario)
        needed, whom = self.wanted or len(evaders), listed(scenario, evaders)
        seconds = self.par or scenario.last_iteration * scenario.sampling_time
        time = f"for {seconds:g} s"
        if role == self.roles[0][0]:
            verb = "see" if self.capture == SIGHT else "catch"
            if self.capture is None:
                return f"keep {whom} from the goal {time}"
            some = whom if needed == len(evaders) else f"{needed} of {len(evaders)}"
            if self.goal is None:
                return f"{verb} {some}" + (f" within {self.par:g} s" if self.par else "")
            place = "in the goal" if self.home is None else "home with the flag"
            safe, many = len(evaders) - needed + 1, len(evaders) > 1
            who = f"{safe} of {len(evaders)} {'is' if safe == 1 else 'are'}" if many else "it is"
            return f"{verb} {some} before {who} {place}"
        if self.goal is not None:
            way = "reach the goal" if self.home is None else "bring the flag home"
            return way + ("" if self.capture is None else " uncaught")
        if self.hunted is not None:
            return f"let nobody catch {whom} {time}"
        return f"stay out of sight {time}" if self.capture == SIGHT else f"stay free {time}"

    # -- how it looks ------------------------------------------------------------------------------

    def paint(self, scene: Scene, area: Outline) -> None:  # noqa: ARG002
        """Paint the floor of the goal, and of the home."""
        for floor, color in ((self.home, HOME), (self.goal, GRASS)):
            if floor is not None:
                scene.polygon(floor, fill=color)

    def draw(self, scene: Scene, frame: FrameLike) -> None:
        """Cross out the caught ones, ring the safe ones; draw the flag and the hunters' reach."""
        scenario = frame.scenario
        if isinstance(self.capture, float):
            for robot in self.players(scenario)[0]:
                color = faded(scenario.colors[robot], 0.5)
                scene.circle(frame.pose[:2, robot], self.capture, stroke=color)
        exits = self.exits_at(frame)
        if self.home is not None and self.goal is not None:
            carrier = carrier_after(exits)
            at = np.mean(self.goal, axis=0) if carrier is None else frame.pose[:2, carrier]
            tall, wide, half = at + FLAG * np.array([(0, 1), (0.7, 0.75), (0, 0.5)])
            scene.line([at, tall], stroke=MARK, width=2.0)
            scene.polygon([tall, wide, half], fill="#e8a200", stroke=MARK)
        for leaving in filter(lambda leaving: leaving.result, exits):
            hunter, above = leaving.hunter, True
            if hunter is not None:
                above = bool(frame.pose[1, leaving.robot] > frame.pose[1, hunter])
            if hunter is not None and self.capture == SIGHT:
                ends = [frame.pose[:2, robot] for robot in (hunter, leaving.robot)]
                scene.line(ends, stroke=faded(scenario.colors[hunter], 0.5), width=1.2)
            mark(scene, frame, leaving, above=above)


def _inside(outline: Outline, span: Span) -> NDArray[np.bool_]:
    """Return which robots' poses are in a polygon, (T, n)."""
    x, y, _ = span.pose.swapaxes(0, 1)
    return ~outside_polygon(x.ravel(), y.ravel(), np.array(outline)).reshape(x.shape)


def _carried(
    at_flag: NDArray[np.bool_],
    at_home: NDArray[np.bool_],
    span: Span,
    captures: Sequence[Exit],
) -> tuple[list[tuple[float, int]], list[Exit]]:
    """Return when which robots have carried the flag home, and who takes it, in order.

    at_flag: which evaders are where it stands, (T, n). at_home: who is at home, (T, n).
    """
    until = np.full(at_flag.shape[1], np.inf)  # when each is out
    for capture in reversed(captures):
        until[capture.robot] = capture.time
    row, carrier = 0, span.carrier
    safe: list[tuple[float, int]] = []
    taken: list[Exit] = []
    while True:
        if carrier is None:
            ready = at_flag[row:] & (span.time[row:, None] < until)
            if not ready.any():
                return safe, taken
            first, carrier = np.argwhere(ready)[0].tolist()
            row += first
            taken.append(Exit(float(span.time[row]), carrier, 0.0))
        caught = span.time[row:] >= until[carrier]
        over = caught | at_home[row:, carrier]
        if not over.any():
            return safe, taken
        last = int(over.argmax())
        row += last
        if not caught[last]:
            until[carrier] = span.time[row]
            safe.append((float(span.time[row]), carrier))
        carrier = None


def _touches(teams: Teams, span: Span, together: int) -> list[Exit]:
    """Return an exit for each touch of a hunter and an evader, in the order of the contacts.

    together: how many hunters must touch the evader in the same control step.
    """
    hunters, evaders = teams
    met = span.contacts[np.minimum(span.contacts["a"], span.contacts["b"]) >= 0]  # no obstacles
    if not len(met):
        return []
    a, b = met["a"], met["b"]
    hunts = np.isin(a, hunters) & np.isin(b, evaders)
    hunted = np.isin(b, hunters) & np.isin(a, evaders)
    found, steps = [], np.floor(met["time"] / span.scenario.sampling_time + ROUNDING)
    touching: dict[tuple[float, int], set[int]] = defaultdict(set)  # by control step and evader
    for k in np.flatnonzero(hunts | hunted).tolist():
        hunter, evader = map(int, (a[k], b[k]) if hunts[k] else (b[k], a[k]))
        there = touching[steps[k], evader]
        there.add(hunter)
        if len(there) >= together:
            found.append(Exit(float(met["time"][k]), evader, -1.0, hunter))
    return found


def _lines(teams: Teams, position: Float) -> Sequence[Float]:
    """Return the ends of the lines from hunters to evaders, (T, h, e, 2). position: (T, 2, n)."""
    hunters, evaders = (position[:, :, list(team)].swapaxes(1, 2) for team in teams)
    return np.broadcast_arrays(hunters[:, :, None], evaders[:, None])


def _sights(teams: Teams, span: Span) -> NDArray[np.bool_]:
    """Return which evaders are in sight of which hunters (T, h, e): no edge is between them."""
    import shapely

    lines = shapely.linestrings(np.stack(_lines(teams, span.pose[:, :2]), axis=-2))
    hidden, _ = _edges(span.scenario.obstacles).query(lines.ravel(), predicate="crosses")
    seen = np.ones(lines.size, dtype=bool)
    seen[hidden] = False
    return seen.reshape(lines.shape)


@lru_cache(maxsize=4)
def _edges(obstacles: tuple[Outline, ...]) -> shapely.STRtree:
    """Return the edges of all obstacles."""
    import shapely

    ends = [edge for outline in obstacles for edge in edges_of(outline)]
    return shapely.STRtree(shapely.linestrings(np.reshape(ends, (-1, 2, 2))))


def _distances(teams: Teams, span: Span, *, passing: bool) -> Float:
    """Return the distances (T, h, e) of hunters from evaders, metres.

    passing: return the least on the straight ways from the poses before. Who has come further than
    its drive takes it was put there, and has passed nobody.
    """
    there = span.pose[:, :2]
    start, end = _lines(teams, there)
    apart = end - start
    if passing:
        before = np.concatenate([there[:1], there[:-1]])
        fastest = np.array([robot.drive.max_linear_speed for robot in span.scenario.robots])
        far = FURTHER * fastest * np.diff(span.time, prepend=span.time[:1])[:, None]
        put = norms(*(there - before).swapaxes(0, 1)) > far
        start, end = _lines(teams, np.where(put[:, None], there, before))
        way = apart - (end - start)
        share = (apart * way).sum(axis=-1) / np.maximum((way**2).sum(axis=-1), TINY)
        apart = apart - share.clip(0.0, 1.0)[..., None] * way
    return norms(*np.moveaxis(apart, -1, 0))


def _approaches(teams: Teams, span: Span, reach: float, seen: Any, together: int) -> list[Exit]:
    """Return the first capture of each evader by the nearest hunter in reach, in order.

    seen: whom the hunters see (T, h, e). together: how many have to be in reach at once.
    """
    hunters, evaders = teams
    distance = np.where(seen, _distances(teams, span, passing=np.isfinite(reach)), np.inf)
    near = np.partition(distance, together - 1, axis=1)[:, together - 1]
    there = (near <= reach) & np.isfinite(near)
    return [
        Exit(when, evaders[k], -1.0, hunters[distance[there[:, k].argmax(), :, k].argmin()])
        for when, k in firsts(span.time, there, range(len(evaders)))
    ]
