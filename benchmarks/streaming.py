"""What it costs to write a run down while it goes on: time and bytes.

    python benchmarks/streaming.py [--json OUT.json] [--rounds N]

Teams of unicycles drive in circles; a control step is timed with a log and without one, in turns,
by the processor's time. The bytes are those of a control step in the file, while it grows and once
it is packed.
"""

from __future__ import annotations

import argparse
import json
import statistics
from pathlib import Path
from tempfile import TemporaryDirectory
from time import thread_time
from typing import Any

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.output.formats.mcap import Log
from mars2d.sensors import RangeFinder

TICKS = 400
SCENES = {"1 robot": (1, 0), "10 robots": (10, 0), "20 robots": (20, 0),
          "10 robots, 10 scanners of 180 beams": (10, 180)}  # fmt: skip


def scenario_of(count: int, beams: int) -> Scenario:
    """Return a team in a circle of its own each, with scanners or without."""
    sensors = [RangeFinder(beams=beams)] if beams else []
    side = 1 + int(count**0.5)
    robots = [Robot(pose=(k % side, k // side, 0.3 * k), sensors=sensors) for k in range(count)]
    return Scenario(robots=robots, on_exit="ignore", sampling_time=0.1, stop_time=1e5)


def step(world: World) -> np.ndarray:
    """Let all drive in circles."""
    return np.tile([[0.1], [0.5]], len(world.robots))


def measure(count: int, beams: int, rounds: int, folder: Path) -> dict[str, Any]:
    """Time control steps with a log and without; return their ratio and the bytes of each."""
    path = folder / "run.mcap"
    log = Log(path)
    scenario = scenario_of(count, beams)
    bare, logged = World(scenario, step), World(scenario, step)
    ratios, seconds = [], []
    for _ in range(rounds):
        start = thread_time()
        for _ in range(TICKS):
            bare.step()
        middle = thread_time()
        for _ in range(TICKS):
            logged.step()
            log.follow(logged)
        end = thread_time()
        ratios.append((end - middle) / (middle - start))
        seconds.append((end - 2 * middle + start) / TICKS)
    ticks, grown, start = rounds * TICKS, path.stat().st_size, thread_time()
    log.close()
    return {
        "ratio": statistics.median(ratios),
        "log_us": 1e6 * statistics.median(seconds),
        "pack_us": 1e6 * (thread_time() - start) / ticks,
        "bytes": grown / ticks,
        "packed": path.stat().st_size / ticks,
    }


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--rounds", type=int, default=7)
    arguments = parser.parse_args()
    results: dict[str, Any] = {}
    print(f"{'scene':38}{'with / without':>16}{'log':>9}{'packing':>9}{'bytes':>9}{'packed':>9}")
    with TemporaryDirectory() as folder:
        for name, (count, beams) in SCENES.items():
            found = results[name] = measure(count, beams, arguments.rounds, Path(folder))
            print(
                f"{name:38}{found['ratio']:16.2f}"
                f"{found['log_us']:6.0f} us{found['pack_us']:6.0f} us"
                f"{found['bytes']:9.0f}{found['packed']:9.0f}"
            )
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(results, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
