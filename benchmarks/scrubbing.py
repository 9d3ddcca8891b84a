"""Going back in a long run: what it takes to look at a step, and to go on from there.

    python benchmarks/scrubbing.py [--json OUT.json] [--rows N] [--robots N]

20 robots wander for 600 control steps of 0.1 s: `plain` by a law of a few lines, `sensing` by
generators that see with noisy range finders of 9 beams. Rows are picked by chance. To look at a row
is to make its frame, as the window does before it draws. To branch is to get a world to that row:
from the start, or from a snapshot, of which there are none of generators.
"""

from __future__ import annotations

import argparse
import gc
import os
import statistics
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from outcome import write

from mars2d.core.errors import InputError
from mars2d.scenario import open_experiment
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

FILE = """
from mars2d import Robot, Scenario
from mars2d.sensors import RangeFinder


def plain(robot):
    return 0.2, 0.8 * robot.memory.__dict__.setdefault("side", robot.rng.choice([-1, 1]))


def sensing(robot):
    turn = 0.0
    while True:
        turn = 0.9 * turn + 0.2 * robot.rng.standard_normal()
        yield 0.2, turn + (1.5 if min(robot.sense.range_finder) < 0.5 else 0.0)


def scenario(law: str = "plain", robots: int = 20, rows: int = 600):
    eye = [RangeFinder(beams=9, range=2.0, noise=0.01)] if law == "sensing" else []
    robot = Robot(diameter=0.3, sensors=eye, controller=globals()[law])
    team = [robot.at(-4 + 2 * (i % 5), -4 + 2 * (i // 5), i) for i in range(robots)]
    return Scenario(robots=team, on_exit="wall", sampling_time=0.1, stop_time=0.1 * rows)
"""

LOOKS, BRANCHES = 200, 7


def measure(path: Path, law: str, robots: int, rows: int) -> dict[str, Any]:
    """Run an experiment, then look at rows and branch at some; return seconds and bytes."""
    experiment = open_experiment(path, {"law": law, "robots": robots, "rows": rows})
    before = resident()
    timeline = Timeline(experiment)
    start = time.perf_counter()
    while not timeline.over:
        timeline.advance()
    run = time.perf_counter() - start
    ran = resident()
    chosen = np.random.default_rng(0).integers(0, rows, LOOKS).tolist()
    timeline.go(chosen[0])
    first = timed(lambda: timeline.frame)
    looks = [timed(lambda row=row: look(timeline, row)) for row in chosen]
    back = [branching(timeline, row) for row in chosen[:BRANCHES]]
    timeline.branch.snapshots = None
    return {
        "run": run,
        "first look": first,
        "look": statistics.median(looks),
        "longest look": max(looks),
        "branch": back,
        "branch from the start": [branching(timeline, row) for row in chosen[:BRANCHES]],
        "memory of the run, with its snapshots": ran - before,
    }


def look(timeline: Timeline, row: int) -> None:
    """Look at a row."""
    timeline.go(row)
    _ = timeline.frame


def branching(timeline: Timeline, row: int) -> float:
    """Return the seconds that it takes to have a world at a row, with which nothing is done."""

    def refuse(_: World) -> None:
        raise InputError("it is there")

    timeline.go(row)
    start = time.perf_counter()
    with suppress(InputError):
        timeline.change(refuse)
    return time.perf_counter() - start


def timed(do: Any) -> float:
    """Return the seconds that something takes."""
    start = time.perf_counter()
    do()
    return time.perf_counter() - start


def resident() -> int:
    """Return the memory that this process has, bytes."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def main() -> None:
    """Measure both laws, and print or write what was found."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, metavar="OUT.json")
    parser.add_argument("--rows", type=int, default=600)
    parser.add_argument("--robots", type=int, default=20)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "wandering.py"
        path.write_text(FILE)
        found = {
            law: measure(path, law, arguments.robots, arguments.rows)
            for law in ("plain", "sensing")
        }
    write(found, arguments.json)


if __name__ == "__main__":
    main()
