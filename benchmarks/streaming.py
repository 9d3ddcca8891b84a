"""What it costs to write a run down while it goes on: time, bytes and memory.

    python benchmarks/streaming.py [--json OUT.json] [--rounds N] [--memory TICKS]

Teams of unicycles drive in circles; a control step is timed with a log and without one, in turns,
by the processor's time. The bytes are those of a control step in the file, while it grows and once
it is packed. With --memory, runs of 10 000 and of TICKS control steps of one robot say how much
memory they took at most, each in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import thread_time
from typing import Any

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.output.formats.mcap import Log
from mars2d.scenario.experiment import Experiment
from mars2d.sensors import RangeFinder
from mars2d.world.loop import simulate

TICKS = 400
SCENES = {"1 robot": (1, 0), "10 robots": (10, 0), "20 robots": (20, 0),
          "10 robots, 10 scanners of 180 beams": (10, 180)}  # fmt: skip


def scenario_of(count: int, beams: int, ticks: int = 10**6) -> Scenario:
    """Return a team in a circle of its own each, with scanners or without."""
    sensors = [RangeFinder(beams=beams)] if beams else []
    side = 1 + int(count**0.5)
    robots = [Robot(pose=(k % side, k // side, 0.3 * k), sensors=sensors) for k in range(count)]
    return Scenario(robots=robots, on_exit="ignore", sampling_time=0.1, stop_time=0.1 * ticks)


def step(world: World) -> np.ndarray:
    """Let all drive in circles."""
    return np.tile([[0.1], [0.5]], len(world.robots))


def measure(count: int, beams: int, rounds: int, folder: Path) -> dict[str, Any]:
    """Time control steps with a log and without; return their ratio and the bytes of each."""
    path = folder / "run.mcap"
    log = Log(path)
    scenario = scenario_of(count, beams)
    bare, logged = World(scenario, step), World(scenario, step, storage=log.storage)
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


def memory(ticks: int) -> int:
    """Run with a log and return the most memory that the process has had, kB."""
    with TemporaryDirectory() as folder:
        log = Log(Path(folder) / "run.mcap")
        world = simulate(Experiment(scenario_of(1, 0, ticks), step), log=log)
        assert len(world.record.digest) == 64
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    return int(next(line for line in lines if line.startswith("VmHWM")).split()[1])


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--memory", type=float, metavar="TICKS")
    parser.add_argument("--peak", type=int, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.peak is not None:
        print(memory(arguments.peak))
        return
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
    if arguments.memory is not None:
        for ticks in (10_000, int(arguments.memory)):
            command = [sys.executable, __file__, "--peak", str(ticks)]
            peak = int(subprocess.run(command, capture_output=True, check=True).stdout)
            results[f"{ticks} ticks, kB"] = peak
            print(f"{ticks} control steps: {peak / 1000:.1f} MB at most")
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(results, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
