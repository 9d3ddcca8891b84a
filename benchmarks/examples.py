"""How many times as fast as time the shipped examples run, without a window.

    python benchmarks/examples.py [--json OUT.json] [EXAMPLE ...] [--rounds N]

Simulated seconds over the processor's seconds of all control steps, the slowest first, and the
share of the physics, `engine.drive`, in these. Opening an experiment, building its world and
importing libraries do not count: all examples are run in turns, and the least time of each counts.
"""

from __future__ import annotations

import argparse
import math
import time
from pathlib import Path
from typing import Any

import outcome

from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment
from mars2d.world.loop import open_world

ROUNDS = 3
GOAL = 50.0
"""How many times as fast as time each example should be."""


def run(name: str) -> tuple[float, dict[str, Any]]:
    """Run an example to its end; return the processor's seconds of its steps, and its figures."""
    world = open_world(open_experiment(name, seed=0))
    engine, clock = world.simulation.engine, time.process_time
    drive, driving = engine.drive, 0.0

    def timed(*arguments: Any) -> None:
        nonlocal driving
        start = clock()
        drive(*arguments)
        driving += clock() - start

    engine.drive = timed  # type: ignore[assignment,method-assign]
    start = clock()
    while not world.over:
        world.step()
    taken = clock() - start
    return taken, {
        "times_real_time": round(world.time / taken, 1),
        "ms_a_step": round(1e3 * taken / (world.iteration + 1), 4),
        "physics": round(driving / taken, 3),
    }


def main() -> None:
    """Run all examples, print a table, and write the figures where they are asked for."""
    known = sorted(examples())
    parser = argparse.ArgumentParser(description="How fast are the examples?")
    parser.add_argument("example", nargs="*", default=known, help="its name; else all")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=ROUNDS, help="how often each is run")
    arguments = parser.parse_args()
    if unknown := {*arguments.example} - {*known}:
        parser.error(f"no example {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    best: dict[str, tuple[float, dict[str, Any]]] = {}
    for _ in range(arguments.rounds):
        for name in arguments.example:
            best[name] = min(best.get(name, (math.inf, {})), run(name), key=lambda found: found[0])
    rows = [{"example": name, **figures} for name, (_, figures) in best.items()]
    rows.sort(key=lambda row: row["times_real_time"])
    print(f"{'':<22}{'times real time':>16}{'ms a step':>11}{'physics':>9}")
    for row in rows:
        speed, share = row["times_real_time"], 100 * row["physics"]
        below = "" if speed >= GOAL else f"  below {GOAL:g}"
        print(f"{row['example']:<22}{speed:>16,.0f}{row['ms_a_step']:>11.3f}{share:>7.0f} %{below}")
    outcome.write({"goal": GOAL, "examples": rows}, arguments.json)


if __name__ == "__main__":
    main()
