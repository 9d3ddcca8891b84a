"""What isolation costs: the same match with two laws in processes of their own, and in this one.

    python benchmarks/isolation.py [--json OUT.json] [--rounds N]

The same match is run in turns with its laws in this process, and each in its own; medians of all
control steps say little of what other programs do meanwhile. Both must end with the same digest.
`start` is from a match's description to the first control step, with two laws that are loaded.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from itertools import pairwise
from pathlib import Path
from typing import Any, ClassVar

import outcome

from mars2d import Robot, Scenario, load_law
from mars2d.addons import Addon
from mars2d.scenario.experiment import Experiment
from mars2d.sensors import RangeFinder
from mars2d.tournaments.isolation import run_isolated
from mars2d.world.loop import simulate

LAW = """
def control(robot):
    while True:
        x, y = robot.neighbours[0].position - robot.position
        yield 0.1 * robot.rng.uniform(), x * y
"""

ALONE = """
def control(robot):
    while True:
        yield 0.1, robot.rng.uniform() * (robot.sense.range_finder.min() > 1)
"""

MATCHES = {
    "positions": ("positions", LAW, ()),
    "full": ("full", LAW, ()),
    "sensors, 64 beams": ("sensors", ALONE, (RangeFinder(beams=64),)),
}
"""What the laws see, their text, and their robots' sensors."""

STEPS = 1000
"""Control steps of a match."""


class Stopwatch(Addon):
    """Notes when each control step of the last run has begun."""

    times: ClassVar[list[float]] = []

    def on_start(self, world: Any) -> None:  # noqa: ARG002
        """Begin to note."""
        self.times.clear()

    def on_step(self, world: Any) -> None:  # noqa: ARG002
        """Note the time."""
        self.times.append(time.perf_counter())


def compare(sees: str, law: str, sensors: tuple[Any, ...], rounds: int) -> dict[str, Any]:
    """Return microseconds of a control step, and seconds of a start."""
    robot = Robot(sees=sees, sensors=sensors)
    scenario = Scenario(
        robots=[robot.at(-3, 0), robot.at(3, 0)],
        stop_time=STEPS * 0.1,
        on_exit="ignore",
        addons=[Stopwatch()],
    )
    inside, isolated, starts = list[float](), list[float](), list[float]()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "law.py"
        file.write_text(law, encoding="utf-8")
        for seed in range(rounds):
            here = simulate(Experiment(scenario.with_laws([load_law(file)] * 2), seed=seed)).record
            inside += _steps()
            start = time.perf_counter()
            laws = {"a": (file, [0]), "b": (file, [1])}
            there = run_isolated(Experiment(scenario, seed=seed), laws).record
            starts.append(Stopwatch.times[0] - start)
            isolated += _steps()
            assert here.digest == there.digest, "isolation has changed the match"
    deciles = [round(1e6 * q, 1) for q in statistics.quantiles(isolated, n=10)]
    middle = statistics.median(inside)
    return {
        "inside_us": round(1e6 * middle, 1),
        "isolated_us": deciles[4],
        "overhead_us": round(deciles[4] - 1e6 * middle, 1),
        "isolated_deciles_us": deciles,
        "start_s": round(statistics.median(starts[1:] or starts), 4),
        "first_start_s": round(starts[0], 4),
    }


def _steps() -> list[float]:
    """Return the seconds of each control step of the last run."""
    return [after - before for before, after in pairwise(Stopwatch.times)]


def main() -> None:
    """Run the benchmark, print a table, and write JSON where it is asked for."""
    parser = argparse.ArgumentParser(description="Isolated laws against laws in one process.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=3, help="how many matches of each kind")
    arguments = parser.parse_args()
    print(f"{'two laws that see':20} inside isolated overhead  (us a control step)  start, s")
    result = {}
    for name, match in MATCHES.items():
        row = result[name] = compare(*match, arguments.rounds)
        low, *_, high = row["isolated_deciles_us"]
        print(
            f"{name:20} {row['inside_us']:6.0f} {row['isolated_us']:8.0f} {row['overhead_us']:8.0f}"
            f"  (isolated: {low:.0f} to {high:.0f} in 8 of 10)  {row['start_s']:.3f}"
        )
    outcome.write(result, arguments.json)


if __name__ == "__main__":
    main()
