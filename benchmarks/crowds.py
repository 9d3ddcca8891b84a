"""Crowds that push with all they have: does anyone get through a wall, how deep do they overlap?

    python benchmarks/crowds.py [--robot-runs 10000] [--seed 0] [--workers N] [--json OUT.json]
    python benchmarks/crowds.py --seed 0 --run 437

Each run is a crowd of 2 to 24 discs in a walled room with obstacles, drawn by chance over all that
validation admits: speeds of 0.1 to 1000 m/s, mass ratios of 1 to 10, walls without thickness, thin
ones from 0.01 mm on and thick ones, diameters of 2 cm to 1 m, strong drives and weak ones, friction
and restitution. All drive at full speed at each other, at the walls and into corners. After each
substep of an island, its bodies' overlaps are worked out from their places, and each centre's way
is compared with the walls: one that crosses a wall has escaped. The engine runs as Python for it,
which gives the same bits as what is compiled.

A robot-run is one robot in one run. Run k depends on the seed and on k alone, not on the workers.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count, pairwise
from math import cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from outcome import write

from mars2d import Holonomic, Robot, Scenario, Unicycle, World
from mars2d.addons import Map
from mars2d.core.progress import progress
from mars2d.geometry import edges_of, inside_polygon, point_segment_distance, wrap
from mars2d.physics.islands.body import Body
from mars2d.physics.islands.island import Island
from mars2d.study.work import Failure, each_done

Float = NDArray[np.float64]
Outline = Sequence[tuple[float, float]]

MOST_ROBOTS = 24
CONTROL_STEPS = 100
ENGINE_STEPS = 3000
"""A run is over after so many control steps, or in the one with the last of these engine steps."""

WALLS = {"none": (0.0, 0.0), "thin": (1e-5, 1e-3), "thick": (1e-3, 0.2)}
"""Thicknesses of walls, metres."""

MASS_RATIOS = {"1": (1.0, 1.0), "1 to 3": (1.0, 3.0), "3 to 10": (3.0, 10.0)}


# -- a crowd --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Crowd:
    """A run's scenario, and how it was drawn."""

    scenario: Scenario
    walls: str
    mass_ratio: str
    speed: float
    restitution: float

    @classmethod
    def drawn(cls, rng: np.random.Generator, robots: int) -> Crowd:
        """Return a crowd of so many robots."""
        walls, ratio = str(rng.choice([*WALLS])), str(rng.choice([*MASS_RATIOS]))
        size, speed = log_uniform(rng, 0.03, 1.0), log_uniform(rng, 0.1, 1000.0)
        diameters = size * rng.uniform(0.6, 1.0, robots)
        lightest, times = log_uniform(rng, 0.01, 1.0), log_uniform(rng, *MASS_RATIOS[ratio])
        masses = lightest * times ** rng.permutation(np.linspace(0.0, 1.0, robots))
        # Its full speed takes a drive from a hundredth of a diameter to ten of them.
        acceleration = min(speed**2 / (size * log_uniform(rng, 0.02, 20.0)), 9.9e4)
        restitution = float(rng.choice([0.0, 0.5, 1.0]))
        friction = float(rng.choice([0.0, 0.5, 1.0, 10.0]))
        kinds = (Unicycle, Holonomic)
        team = [
            Robot(
                diameter=float(diameter), mass=float(mass), friction=friction,
                restitution=restitution,
                drive=kinds[int(rng.integers(2))](
                    max_linear_speed=speed,
                    max_force=acceleration * float(mass),
                    max_torque=acceleration * float(mass) * size,
                ),
            )
            for diameter, mass in zip(diameters, masses, strict=True)
        ]  # fmt: skip
        path = size * log_uniform(rng, 0.02, 2.0)  # in one control step
        side = float(np.sqrt((diameters**2).sum() / rng.uniform(0.3, 0.6))) + 2 * size
        while True:
            room, obstacles = a_room(rng, side, size, WALLS[walls])
            found = placed(rng, team, side, obstacles)
            if len(found) == robots:
                break
            side *= 1.05
        time = float(np.clip(path / speed, 1e-6, 1.0))
        scenario = Scenario(
            robots=found, **room, sampling_time=time, stop_time=2 * CONTROL_STEPS * time
        )  # fmt: skip
        return cls(scenario, walls, ratio, speed, restitution)


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Return a number, of each order of magnitude as often."""
    return float(low * (high / low) ** rng.uniform())


def a_room(
    rng: np.random.Generator, side: float, size: float, thickness: tuple[float, float]
) -> tuple[dict[str, Any], list[Outline]]:
    """Return a square room with obstacles, as fields of a scenario and as outlines.

    size: of robots. thickness: from and to, of all walls; 0 for walls of two vertices. [m]
    """
    h, thick = side / 2, log_uniform(rng, *thickness) if thickness[1] else 0.0
    corners = [(-h, -h), (h, -h), (h, h), (-h, h), (-h, -h)]
    around = [bar(a, b, thick, beyond=thick) for a, b in pairwise(corners)]
    inside = [
        bar((x, y), (x + r * cos(turned), y + r * sin(turned)), thick)
        for x, y in rng.uniform(-h, h, (int(rng.integers(1, 5)), 2)).tolist()
        for r, turned in [(size * rng.uniform(0.3, 1.5), rng.uniform(-pi, pi))]
    ]
    if thick == 0 and rng.integers(2):  # the workspace's own walls
        return {"workspace": corners[:4], "on_exit": "wall", "addons": [Map(inside)]}, inside
    return {"workspace": None, "addons": [Map(around + inside)]}, inside


def bar(
    a: tuple[float, float], b: tuple[float, float], thick: float, beyond: float = 0.0
) -> Outline:
    """Return a wall from a to b, and `beyond` both, whose thickness lies to the right; metres."""
    if thick == 0:
        return [a, b]
    length = hypot(b[0] - a[0], b[1] - a[1])
    x, y = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    a, b = (a[0] - beyond * x, a[1] - beyond * y), (b[0] + beyond * x, b[1] + beyond * y)
    return [a, (a[0] + thick * y, a[1] - thick * x), (b[0] + thick * y, b[1] - thick * x), b]


def placed(
    rng: np.random.Generator, team: list[Robot], side: float, obstacles: Sequence[Outline]
) -> list[Robot]:
    """Return the robots at places where nothing touches, up to one that finds none."""
    edges = np.array([(*a, *b) for outline in obstacles for a, b in edges_of(outline)])
    solid = [np.array(outline) for outline in obstacles if len(outline) > 2]
    result: list[Robot] = []
    for robot in team:
        h = side / 2 - robot.radius - 1e-4
        for x, y in rng.uniform(-h, h, (300, 2)).tolist():
            at = np.array([x]), np.array([y])
            free = point_segment_distance(*at, edges).min() > robot.radius + 1e-4
            free = free and not any(inside_polygon(*at, outline)[0] for outline in solid)
            others = ((other.pose, other.radius) for other in result)
            if free and all(hypot(x - p[0], y - p[1]) > r + robot.radius for p, r in others):
                result.append(robot.at(x, y, float(rng.uniform(-pi, pi))))
                break
        else:
            break
    return result


def rush(rng: np.random.Generator, world: World, side: float) -> Callable[[], Float]:
    """Return a law: all go at full speed to others, to walls or to a corner, in turns."""
    robots = world.scenario.robots
    n = len(robots)
    speed = np.array([robot.drive.max_linear_speed for robot in robots])
    rim = np.array([getattr(robot.drive, "wheel_semiaxis", 0.0) for robot in robots])
    whom, where = np.arange(n), np.full((2, n), np.nan)

    def choose() -> None:
        """Choose another robot for some, a point beyond the walls for others, or one for all."""
        whom[:] = rng.integers(n, size=n)
        where[:] = rng.uniform(-side, side, (2, n))
        where[:, rng.uniform(size=n) < 0.5] = np.nan
        if rng.uniform() < 0.3:
            where[:] = rng.choice([-side, 0.0, side], (2, 1))

    def law() -> Float:
        if world.iteration % 10 == 0:
            choose()
        theta = world.pose[2]
        to = np.where(np.isnan(where), world.position[:, whom], where) - world.position
        angle = np.arctan2(to[1], to[0])
        off = wrap(angle - theta)
        turn = np.clip(off / world.sampling_time, -speed / (rim + 0.1), speed / (rim + 0.1))
        wheeled = np.array([speed * np.cos(off), turn])
        free = speed * np.array([np.cos(angle), np.sin(angle)])
        return np.where(rim > 0, wheeled, free)

    return law


# -- what is seen of it ---------------------------------------------------------------------------


class Watch:
    """What a run was seen to do; lengths in metres.

    deepest: of two bodies, and of a body and a wall. when: the control steps of these.
    engine_steps: how many.
    """

    def __init__(self, world: World) -> None:
        """Take a world of discs; see `after_each_substep`."""
        self._world = world
        scenario = world.scenario
        self._radius = np.array([robot.radius for robot in scenario.robots])
        outlines = [surface.outline for surface in scenario.surfaces]
        self._edges = np.array([(*a, *b) for outline in outlines for a, b in edges_of(outline)])
        self._solid = [np.array(o) for o in scenario.obstacles if len(o) > 2]
        room = world.workspace
        self._room = None if room is None else np.array(room)
        self._center = world.position.T.copy()
        self._far = self._from_walls(self._center)
        self.deepest, self.when = {"bodies": 0.0, "walls": 0.0}, {"bodies": 0, "walls": 0}
        self._escaped: dict[int, str] = {}
        self.engine_steps = 0

    @property
    def edges(self) -> Float:
        """All edges of walls and obstacles, (k, 4) = x1, y1, x2, y2."""
        return self._edges

    def _from_walls(self, center: Float) -> Float:
        """Return the distances (m, edges) of points from all edges."""
        return point_segment_distance(center[:, :1], center[:, 1:], self._edges)

    def look(self, who: Sequence[int], center: Float) -> None:
        """Look at some robots, which are at (m, 2) now, all at the same time."""
        if not np.isfinite(center).all():
            self._note_escapes(who, "or another is nowhere")
            return
        before, radius = self._center[who], self._radius[who]
        moved = np.hypot(*(center - before).T)
        for i, k in np.argwhere(self._far[who] <= moved[:, None]):
            if crosses(before[i], center[i], self._edges[k]):
                self._note_escapes([who[i]], "crossed a wall")
        far = self._from_walls(center)
        self._center[who], self._far[who] = center, far
        i, j = np.triu_indices(len(center), 1)
        depth = radius[i] + radius[j] - np.hypot(*(center[i] - center[j]).T)
        self._note_depth("bodies", float(depth.max(initial=0.0)))
        self._note_depth("walls", float((radius[:, None] - far).max(initial=0.0)))

    def look_where(self) -> None:
        """Look whether all are in the room and out of obstacles; to be called now and then."""
        x, y, _ = self._world.pose
        for outline in self._solid:
            self._note_escapes(np.flatnonzero(inside_polygon(x, y, outline)), "is in an obstacle")
        if self._room is not None:
            self._note_escapes(np.flatnonzero(~inside_polygon(x, y, self._room)), "is outside")

    def _note_depth(self, what: str, depth: float) -> None:
        if depth > self.deepest[what]:
            self.deepest[what], self.when[what] = depth, self._world.iteration

    def _note_escapes(self, robots: Iterable[int], what: str) -> None:
        for i in robots:
            text = f"control step {self._world.iteration}: robot{i} {what}"
            self._escaped.setdefault(int(i), text)

    @property
    def escapes(self) -> list[str]:
        """How each robot escaped that did."""
        return [*self._escaped.values()]


def crosses(start: Float, end: Float, edge: Float) -> bool:
    """Return whether the way from a point to another crosses an edge (x1, y1, x2, y2)."""

    def side(p: Float, q: Float, of: Float) -> float:
        return float((q[0] - p[0]) * (of[1] - p[1]) - (q[1] - p[1]) * (of[0] - p[0]))

    a, b = edge[:2], edge[2:]
    return (
        side(start, end, a) * side(start, end, b) < 0 and side(a, b, start) * side(a, b, end) <= 0
    )


@contextmanager
def after_each_substep(look: Callable[[list[Body]], None]) -> Iterator[None]:
    """Call something with an island's bodies after each substep of worlds that are built within."""
    close = Island.close

    def close_and_look(island: Island, time: float, h: float) -> None:
        close(island, time, h)
        look(island.bodies)

    plain = os.environ.get("MARS2D_PLAIN", "")
    os.environ["MARS2D_PLAIN"] = "1"
    try:
        with replaced(Island, "close", close_and_look):
            yield
    finally:
        os.environ["MARS2D_PLAIN"] = plain


@contextmanager
def replaced(owner: Any, name: str, value: Any) -> Iterator[None]:
    """Put something else in an attribute's place for a while."""
    original = getattr(owner, name)
    setattr(owner, name, value)
    try:
        yield
    finally:
        setattr(owner, name, original)


# -- many of them ---------------------------------------------------------------------------------


def robots_of(seed: int, run: int) -> int:
    """Return how many robots a run has."""
    return int(np.random.default_rng((seed, run, 0)).integers(2, MOST_ROBOTS + 1))


def figures(seed: int, run: int) -> dict[str, Any]:
    """Make a run and return what was seen."""
    rng = np.random.default_rng((seed, run, 1))
    crowd = Crowd.drawn(rng, robots_of(seed, run))
    watch: Watch | None = None

    def look(bodies: list[Body]) -> None:
        assert watch is not None
        watch.engine_steps += 1
        center = np.array([(body.x, body.y) for body in bodies])
        watch.look([body.number for body in bodies], center)

    with after_each_substep(look):
        world = World(crowd.scenario)
        watch, everybody = Watch(world), range(len(world.robots))
        law = rush(rng, world, float(np.ptp(watch.edges)))
        while world.iteration < CONTROL_STEPS and watch.engine_steps < ENGINE_STEPS:
            world.step(law())
            watch.look(everybody, world.position.T)
            watch.look_where()
    return {
        "run": run, "robots": len(crowd.scenario.robots), "walls": crowd.walls,
        "mass_ratio": crowd.mass_ratio, "speed": crowd.speed, "restitution": crowd.restitution,
        "control_steps": world.iteration, "engine_steps": watch.engine_steps,
        "escapes": watch.escapes, "deepest": watch.deepest, "when": watch.when,
        "allowed": crowd.scenario.max_overlap,
    }  # fmt: skip


def runs_for(seed: int, robot_runs: int) -> list[int]:
    """Return the numbers of the first runs that have so many robots together."""
    runs: list[int] = []
    robots = 0
    for run in count():
        if robots >= robot_runs:
            return runs
        runs.append(run)
        robots += robots_of(seed, run)
    raise AssertionError


def summary(rows: list[dict[str, Any]], seed: int) -> dict[str, Any]:
    """Return the figures of all runs together."""

    def worst(rows: list[dict[str, Any]], what: str) -> dict[str, Any]:
        row = max(rows, key=lambda row: row["deepest"][what], default=None)
        if row is None:
            return {"m": 0.0}
        return {"m": row["deepest"][what], "run": row["run"], "control_step": row["when"][what]}

    def seen(rows: list[dict[str, Any]]) -> dict[str, Any]:
        return {
            "runs": len(rows),
            "robot_runs": sum(row["robots"] for row in rows),
            "escapes": sum(len(row["escapes"]) for row in rows),
            "runs deeper than allowed": sum(
                max(row["deepest"].values()) > row["allowed"] for row in rows
            ),
            "worst of two bodies": worst(rows, "bodies"),
            "worst of body and wall": worst(rows, "walls"),
        }

    return {
        "seed": seed,
        "control_steps": sum(row["control_steps"] for row in rows),
        "engine_steps": sum(row["engine_steps"] for row in rows),
        "all": seen(rows),
        "classes": {
            f"mass ratio {ratio}, walls {walls}": seen(
                [row for row in rows if (row["mass_ratio"], row["walls"]) == (ratio, walls)]
            )
            for ratio in MASS_RATIOS
            for walls in WALLS
        },
        "escaped": [{"run": row["run"], "what": row["escapes"]} for row in rows if row["escapes"]],
    }


def as_lines(result: dict[str, Any]) -> Iterator[str]:
    """Yield the lines of the table."""
    yield f"{'':36}  runs  robot-runs  escapes  two bodies, mm (run)  body and wall, mm (run)"
    for name, seen in [*result["classes"].items(), ("all", result["all"])]:
        depths = [
            f"{1e3 * worst['m']:.4f} ({worst.get('run', '-')})"
            for worst in (seen["worst of two bodies"], seen["worst of body and wall"])
        ]
        yield (
            f"{name:36}{seen['runs']:>6}{seen['robot_runs']:>12}{seen['escapes']:>9}"
            f"{depths[0]:>22}{depths[1]:>25}"
        )
    steps = f"{result['control_steps']:,} control steps, {result['engine_steps']:,} engine steps"
    deeper = result["all"]["runs deeper than allowed"]
    yield f"{steps}; overlaps after each of these, in {deeper} runs deeper than max_overlap"
    for escaped in result["escaped"]:
        yield f"run {escaped['run']}: {escaped['what'][0]}"


def main() -> None:
    """Make the runs, print a table, and write the figures where they are asked for."""
    parser = argparse.ArgumentParser(description="Does a crowd get through walls, or too deep?")
    parser.add_argument("--robot-runs", type=int, default=10_000, help="robots in all runs")
    parser.add_argument("--seed", type=int, default=0, help="of all runs")
    parser.add_argument("--run", type=int, help="make this one alone, and print what is seen")
    parser.add_argument("--workers", type=int, help="processes; else one a core")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    arguments = parser.parse_args()
    if arguments.run is not None:
        write(figures(arguments.seed, arguments.run), arguments.json)
        return
    runs = runs_for(arguments.seed, arguments.robot_runs)
    rows, work = [], partial(figures, arguments.seed)
    with progress(len(runs), "run") as update:
        for index, row in each_done(work, runs, workers=arguments.workers):
            if isinstance(row, Failure):
                raise SystemExit(f"run {runs[index]}: {row.error}")
            rows.append(row)
            update(len(rows))
    result = summary(sorted(rows, key=lambda row: row["run"]), arguments.seed)
    print(*as_lines(result), sep="\n")
    if arguments.json is not None:
        write(result, arguments.json)


if __name__ == "__main__":
    main()
