"""How much the whole control step costs, against a bare pymunk loop that does the same physics.

    python benchmarks/control_loop.py [--json OUT.json] [--sizes N ...] [--rounds N]

Teams of unicycles (radius 0.15 m, 5 % of the area covered, 0.3 m/s, a new random omega each second,
sampling time 0.05 s) among obstacles in a walled square, as `reports.bench.scenes.team` makes them.
`mars2d`: `World.step` with a law and recording, at the default accuracy. `bare`: the loop of
`reports.bench.yardstick`, with as many substeps as keep overlaps about within the same millimetre
(15), without laws, checks or recording. Both run in turns in one process, so that the ratio holds
on a noisy machine.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import outcome

import mars2d
from mars2d.reports.bench.scenes import SPEED, team
from mars2d.reports.bench.worlds import SETTINGS, world_of
from mars2d.reports.bench.yardstick import Bare

DT = 0.05
SUBSTEPS = round(SPEED * DT / SETTINGS["default"])
SIZES = (2, 20, 100, 1000)
ROUNDS = 7


def seconds(step: Callable[[], None], steps: int) -> float:
    """Return how long `steps` calls take."""
    start = time.perf_counter()
    for _ in range(steps):
        step()
    return time.perf_counter() - start


def compare(n: int, rounds: int) -> dict[str, Any]:
    """Run both loops in turns and return steps per second and the ratio of their times."""
    scene = team(n, DT)
    ours, bare = world_of(scene).step, Bare(scene, SUBSTEPS)
    steps = max(20, min(2000, 40_000 // n))
    seconds(ours, steps), seconds(bare, steps)  # robots meet, caches fill
    pairs = [(seconds(ours, steps), seconds(bare, steps)) for _ in range(rounds)]
    return {
        "n": n,
        "mars2d_steps_per_s": round(steps / statistics.median(a for a, _ in pairs)),
        "bare_steps_per_s": round(steps / statistics.median(b for _, b in pairs)),
        "time_ratio": round(statistics.median(a / b for a, b in pairs), 3),
        "time_ratio_range": [round(f(a / b for a, b in pairs), 3) for f in (min, max)],
    }


def random_walk(rounds: int) -> dict[str, Any]:
    """Return how long the paper's Algorithm 2 takes, 1000 control steps."""
    mars2d.run("random_walk", stop_time=10)
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        mars2d.run("random_walk")
        times.append(time.perf_counter() - start)
    return {"ticks": 1000, "seconds": round(statistics.median(times), 4)}


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="The control step against bare pymunk.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="numbers of robots")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often both are timed")
    arguments = parser.parse_args()
    print(f"{'n':>5} {'mars2d':>10} {'bare':>10}  steps/s;  time ratio mars2d / bare")
    rows = []
    for n in arguments.sizes:
        row = compare(n, arguments.rounds)
        low, high = row["time_ratio_range"]
        print(
            f"{n:>5} {row['mars2d_steps_per_s']:>10,} {row['bare_steps_per_s']:>10,}"
            f"  {row['time_ratio']:.2f} ({low:.2f} to {high:.2f})"
        )
        rows.append(row)
    walk = random_walk(arguments.rounds)
    print(f"random_walk: {walk['ticks']} ticks in {walk['seconds']:.3f} s")
    result = {"substeps_of_bare": SUBSTEPS, "teams": rows, "random_walk": walk}
    outcome.write(result, arguments.json)


if __name__ == "__main__":
    main()
