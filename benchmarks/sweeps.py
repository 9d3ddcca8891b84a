"""How much faster two workers do a study than one: the same runs, in turns.

    python benchmarks/sweeps.py [--json OUT.json] [--rounds N] [--runs N] [--workers N]

Whole: from the call to the last row, with the start of the processes, which import MARS2D.
Steady: from the first row on, which is what a long study comes to. Each ratio is of two studies,
one after the other; what other programs take of the cores is missing in it.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from outcome import write

import mars2d
from mars2d.study.work import Failure, each_done

EXPERIMENT = "random_walk"


class Times(NamedTuple):
    """How long a study took, seconds: whole, and a row once the first had come."""

    whole: float
    row: float


def digest(stop_time: float, seed: int) -> str:
    """Return the digest of one run."""
    return mars2d.run(EXPERIMENT, seed=seed, stop_time=stop_time).digest


def study(runs: int, stop_time: float, workers: int) -> tuple[Times, dict[int, str | Failure]]:
    """Return how long so many runs took by so many workers, and what came of them."""
    start = time.perf_counter()
    rows: dict[int, str | Failure] = {}
    came: list[float] = []
    for index, row in each_done(partial(digest, stop_time), range(runs), workers=workers):
        rows[index] = row
        came.append(time.perf_counter() - start)
    steady = (came[-1] - came[workers - 1]) / (runs - workers)
    return Times(came[-1], steady), rows


def main() -> None:
    """Make the same study by one worker and by several, in turns, and compare."""
    parser = argparse.ArgumentParser(description="How much faster several workers are.")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--rounds", type=int, default=5, help="how often both are timed")
    parser.add_argument("--runs", type=int, default=40, help="of each study")
    parser.add_argument("--stop-time", type=float, default=2000.0, help="of each run, seconds")
    parser.add_argument("--workers", type=int, default=2, help="compared with one")
    arguments = parser.parse_args()
    if arguments.runs <= arguments.workers:
        parser.error("--runs must be more than --workers")
    times: dict[int, list[Times]] = {1: [], arguments.workers: []}
    for _ in range(arguments.rounds):
        found = []
        for workers, each in times.items():
            taken, rows = study(arguments.runs, arguments.stop_time, workers)
            each.append(taken)
            found.append(rows)
        assert all(rows == found[0] for rows in found), "the workers change what comes of runs"
    one, several = times[1], times[arguments.workers]
    result = {
        "runs": arguments.runs,
        "workers": arguments.workers,
        "whole_s": [[t.whole for t in one], [t.whole for t in several]],
        "whole": _ratios([t.whole for t in one], [t.whole for t in several]),
        "steady": _ratios([t.row for t in one], [t.row for t in several]),
    }
    print(f"{arguments.runs} runs of {EXPERIMENT}, one worker: {_text([t.whole for t in one])} s")
    print(f"{arguments.workers} workers: {_text([t.whole for t in several])} s")
    for name in ("whole", "steady"):
        print(f"times as fast, {name}: {_text(result[name])}")
    if hasattr(os, "getloadavg"):
        print(f"load of the machine in the last minute: {os.getloadavg()[0]:.1f}")
    if arguments.json is not None:
        write(result, arguments.json)


def _ratios(one: Sequence[float], several: Sequence[float]) -> list[float]:
    return [a / b for a, b in zip(one, several, strict=True)]


def _text(values: Sequence[float]) -> str:
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


if __name__ == "__main__":
    main()
