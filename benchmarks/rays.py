"""How many rays a second range finders cast, against pymunk's, and how fast a team runs.

    python benchmarks/rays.py [--json OUT.json] [--sizes N ...] [--rounds N]

Rays: 20 robots with 180 beams of 5 m among boxes that stand 1.5 m apart on average, of 20, 200 and
2000 segments in all; the robots are discs or squares. `fans`: `RangeFinder.read_all`, all beams of
all robots at once, compiled. `pymunk`: its method `Space.segment_query_first` for each beam. Both
take turns in one process, so that the ratio holds on a noisy machine; by how much their distances
differ is part of the benchmark.

Team: 20 such robots wander among 50 obstacles by what they see, at 10 Hz, with contacts and
recording; the real-time factor is simulated time over wall time.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import outcome
import pymunk
from numpy.typing import NDArray

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.core.plane import edges_of
from mars2d.geometry.shapes import rectangle
from mars2d.sensors import RangeFinder

Float = NDArray[np.float64]
Outline = list[tuple[float, float]]

ROBOTS, BEAMS, RANGE, RADIUS = 20, 180, 5.0, 0.15
SIDE = 0.2  # of a square within such a disc, metres
SPACING = 1.5
SIZES = (20, 200, 2000)
ROUNDS = 7
SECONDS = 20.0
SPEED, NEAR = 0.3, 0.6
GOLDEN = (5**0.5 - 1) / 2
"""The fractional parts of its multiples are scattered evenly from 0 to 1."""


def boxes(count: int, rng: np.random.Generator) -> tuple[list[Outline], float]:
    """Return turned boxes on a jittered grid round the origin, and half the side of the square."""
    per_row = int(np.ceil(np.sqrt(count)))
    half = SPACING * (per_row + 1) / 2
    outlines = []
    for k in range(count):
        center = (np.array([k % per_row, k // per_row]) + 1.0) * SPACING - half
        center += rng.uniform(-0.2, 0.2, 2)
        angle, length = rng.uniform(0, np.pi), rng.uniform(0.1, 0.35, 2)
        along = np.array([np.cos(angle), np.sin(angle)]) * length[0]
        across = np.array([-np.sin(angle), np.cos(angle)]) * length[1]
        corners = [along + across, across - along, -along - across, along - across]
        outlines.append([(float(x), float(y)) for x, y in (center + corner for corner in corners)])
    return outlines, half


def free_places(outlines: list[Outline], half: float, rng: np.random.Generator) -> Float:
    """Return poses (ROBOTS, 3) that touch neither boxes nor each other."""
    import shapely

    taken = [shapely.Polygon(outline) for outline in outlines]
    reach = min(half, 4 * SPACING) - RADIUS  # among the boxes, not out of the way
    poses: list[tuple[float, float, float]] = []
    while len(poses) < ROBOTS:
        x, y = rng.uniform(-reach, reach, 2)
        place = shapely.Point(x, y).buffer(1.1 * RADIUS)
        if not shapely.intersects(place, taken).any():
            taken.append(place)
            poses.append((x, y, rng.uniform(-np.pi, np.pi)))
    return np.array(poses)


def wander(robot: Any) -> Iterator[tuple[float, float]]:
    """Drive on, and turn away from what is near ahead."""
    sensor = RangeFinder(beams=BEAMS)
    ahead = np.abs(sensor.angles) < 0.6
    while True:
        if robot.sense.range_finder[ahead].min() > NEAR:
            yield SPEED, 0.0
        else:
            turn = robot.rng.choice([-1.5, 1.5])
            for _ in range(5):
                yield 0.0, turn


def team(
    count: int,
    *,
    square: bool = False,
    law: Callable[[Any], Any] | None = None,
    stop: float = 1e6,
) -> World:
    """Return a world of robots, discs or squares, with range finders among boxes."""
    rng = np.random.default_rng(count)
    outlines, half = boxes(count, rng)
    robot = Robot(
        diameter=2 * RADIUS,
        shape=rectangle(SIDE, SIDE) if square else None,
        sensors=[RangeFinder(beams=BEAMS, range=RANGE)],
        controller=law,
    )
    scenario = Scenario(
        robots=[robot.at(*pose) for pose in free_places(outlines, half, rng).tolist()],
        workspace=[(-half, -half), (-half, half), (half, half), (half, -half)],
        on_exit="wall" if law else "stop",
        addons=[Map(outlines)],
        sampling_time=0.1,
        stop_time=stop,
    )
    return World(scenario, seed=1)


def fans(world: World) -> Callable[[], Float]:
    """Return a function that reads all range finders, (ROBOTS, BEAMS)."""
    rngs = [world.stream("benchmark")] * ROBOTS
    (sensor,) = world.scenario.robots[0].sensors
    return lambda: np.asarray(sensor.read_all(world.robots, world.surroundings, rngs))


def in_pymunk(world: World) -> pymunk.Space:
    """Return a space with the same shapes."""
    space = pymunk.Space()
    for i, rigid in enumerate(world.scenario.bodies):
        body = pymunk.Body(1.0, 1.0)
        x, y, body.angle = world.simulation.engine.pose[:, i].tolist()
        body.position = x, y
        space.add(body)
        for points, radius in rigid.shape.pieces:
            disc = len(points) == 1
            shape = pymunk.Circle(body, radius, points[0]) if disc else pymunk.Poly(body, points)
            shape.filter = pymunk.ShapeFilter(group=i + 1)
            space.add(shape)
        space.reindex_shapes_for_body(body)
    edges = [edge for outline in world.obstacles for edge in edges_of(outline)]
    order = sorted(range(len(edges)), key=lambda k: k * GOLDEN % 1.0)  # its tree is balanced so
    space.add(*(pymunk.Segment(space.static_body, *edges[k], 0.0) for k in order))
    return space


def public(world: World) -> Callable[[], Float]:
    """Return a function that does the same by pymunk's method."""
    space = in_pymunk(world)
    (sensor,) = world.scenario.robots[0].sensors
    assert isinstance(sensor, RangeFinder)

    def read() -> Float:
        distances = np.full((ROBOTS, BEAMS), np.inf)
        for robot in world.robots:
            x, y, theta = robot.pose.tolist()
            own = pymunk.ShapeFilter(group=robot.index + 1)
            angles = theta + sensor.angles
            ends_x, ends_y = x + RANGE * np.cos(angles), y + RANGE * np.sin(angles)
            for k, end in enumerate(zip(ends_x.tolist(), ends_y.tolist(), strict=True)):
                hit = space.segment_query_first((x, y), end, 0.0, own)
                if hit is not None:
                    distances[robot.index, k] = hit.alpha * RANGE
        return distances

    return read


def seconds(action: Callable[[], object], times: int) -> float:
    """Return how long one of several calls takes."""
    start = time.perf_counter()
    for _ in range(times):
        action()
    return (time.perf_counter() - start) / times


def compare(segments: int, square: bool, rounds: int) -> dict[str, Any]:
    """Cast the same rays by both and return million rays per second, and the ratio."""
    world = team(segments // 4, square=square)
    ways = {"fans": fans(world), "pymunk": public(world)}
    found = [np.minimum(read(), 2 * RANGE) for read in ways.values()]
    calls = {"fans": 30, "pymunk": 2}
    taken: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(rounds):
        for name, read in ways.items():
            taken[name].append(seconds(read, calls[name]))
    pairs = zip(taken["pymunk"], taken["fans"], strict=True)
    million = ROBOTS * BEAMS / 1e6
    return {
        "robots": "squares" if square else "discs",
        "segments": segments,
        "million_rays_per_s": {
            name: round(million / statistics.median(times), 3) for name, times in taken.items()
        },
        "scan_ms": round(1e3 * statistics.median(taken["fans"]), 3),
        "times_as_fast_as_pymunk": round(statistics.median(a / b for a, b in pairs), 2),
        "largest_difference": float(np.abs(found[0] - found[1]).max()),
    }


def real_time(rounds: int) -> dict[str, Any]:
    """Return how much faster than time a team wanders about, with all that belongs to it."""
    factors = []
    for _ in range(rounds):
        world = team(50, law=wander, stop=SECONDS)
        start = time.perf_counter()
        while not world.over:
            world.step()
        factors.append(SECONDS / (time.perf_counter() - start))
    readings = world.record.sensors["range_finder"]
    return {
        "robots": ROBOTS,
        "obstacles": 50,
        "readings": list(readings.shape),
        "real_time_factor": round(statistics.median(factors), 1),
    }


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="Rays against pymunk's, and a team's speed.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="numbers of segments")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often all is timed")
    arguments = parser.parse_args()
    print(f"{'robots':>7} {'segments':>8} {'fans':>6} {'pymunk':>6}  million rays/s")
    rows = []
    for square in (False, True):
        for segments in arguments.sizes:
            row = compare(segments, square, arguments.rounds)
            rates = row["million_rays_per_s"].values()
            print(
                f"{row['robots']:>7} {segments:>8}", *(f"{rate:>6.2f}" for rate in rates),
                f" {row['times_as_fast_as_pymunk']:.1f} times as fast,"
                f" up to {row['largest_difference']:.1g} m apart",
            )  # fmt: skip
            rows.append(row)
    wandering = real_time(arguments.rounds)
    print(
        f"{ROBOTS} robots with {BEAMS} beams among {wandering['obstacles']} obstacles:"
        f" {wandering['real_time_factor']:.0f} times as fast as time"
    )
    result = {"rays": rows, "team": wandering}
    outcome.write(result, arguments.json)


if __name__ == "__main__":
    main()
