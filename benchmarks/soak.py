"""A very long run, and how its memory grows: twenty robots that sense, talk, bump and are logged.

    python benchmarks/soak.py [--ticks 1e7] [--log] [--folder FOLDER] [--json OUT.json]

Twenty unicycles wander at random in a walled room with obstacles. Four have proximity sensors and
turn away from what is near; one scans every two seconds, and tells another what it sees, over a
channel that loses messages. With --log the run is written to FOLDER/soak.mcap while it goes on;
either way its columns are kept in files of FOLDER. All that was recorded is looked at in the end:
is it finite, and what is its digest? Two runs, with a log and without, have the same.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from contextlib import nullcontext
from pathlib import Path
from tempfile import gettempdir
from typing import Any

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.addons import Communication, Map, Trails
from mars2d.core.progress import progress
from mars2d.output.formats.mcap import Log
from mars2d.record.columns import Scratch, blocks
from mars2d.scenario.experiment import Experiment
from mars2d.sensors import Proximity, RangeFinder
from mars2d.world.loop import open_world
from mars2d.world.record import Record

LOOKS = 100
"""How often memory is looked at."""


def scenario_of(ticks: int) -> Scenario:
    """Return the room and its team."""
    names = [f"robot{k}" for k in range(20)]
    scanner = RangeFinder(beams=5, rate=0.5)
    robots = [
        Robot(
            pose=(3 * (k % 5), 3 * (k // 5), k),
            name=name,
            sensors=[Proximity(range=0.6)] * (k % 5 == 0) + [scanner] * (k == 1),
        )
        for k, name in enumerate(names)
    ]
    obstacles = [
        [(4.0, 4.0), (5.0, 4.0), (4.5, 5.0)],
        [(7.0, 1.0), (9.0, 1.0), (9.0, 1.2), (7.0, 1.2)],
    ]
    return Scenario(
        title="A long run",
        robots=robots,
        workspace=[(-1, -1), (13, -1), (13, 10), (-1, 10)],
        on_exit="wall",
        sampling_time=0.1,
        stop_time=0.1 * ticks,
        addons=[Map(obstacles), Communication(loss=0.2, delay=0.3), Trails(duration=5.0)],
    )


def wander(world: World) -> np.ndarray:
    """Drive at random; four turn away from what is near, one tells another what it sees."""
    command = np.empty((2, 20))
    command[0], command[1] = 0.3, world.rng.normal(size=20)
    for robot in world.robots[::5]:
        if robot.sense.proximity < 0.4:
            command[:, robot.index] = 0.1, 1.5
    if world.iteration % 50 == 0:
        scanning = world.robots[1]
        scanning.send(float(scanning.sense.range_finder.min()), to=2)
    return command


def memory() -> int:
    """Return the memory of this process that no file stands behind, kB."""
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    return int(next(line for line in lines if line.startswith("RssAnon")).split()[1])


def run(ticks: int, folder: Path, *, logged: bool) -> dict[str, Any]:
    """Make the run; return its figures."""
    log = Log(folder / "soak.mcap") if logged else None
    storage = Scratch(folder) if log is None else log.storage
    begun, grown = time.perf_counter(), []
    with log or nullcontext(), progress(ticks, "step") as update:
        world = open_world(Experiment(scenario_of(ticks), wander, seed=1), storage=storage)
        while not world.over:
            world.step()
            update(world.iteration)
            if log is not None:
                log.follow(world)
            if world.iteration % (ticks // LOOKS) == 0:
                grown.append(memory())
        stepped = time.perf_counter() - begun
        record = world.record
        return {
            "ticks": len(record) - 1,
            "logged": logged,
            "us a tick": round(1e6 * stepped / ticks, 1),
            "collisions": record.collisions,
            "messages": len(record.messages),
            "all finite": is_sound(record),
            "memory at 1 %, most, last, kB": [grown[0], max(grown), grown[-1]],
            "digest": record.digest,
            "seconds in all": round(time.perf_counter() - begun),
        }


def is_sound(record: Record) -> bool:
    """Say whether all is finite but readings of what is too far, or that no sensor took.

    Messages that are lost never arrive.
    """
    for name, column in record.columns().items():
        if column.dtype.kind == "f" and name != "message:arrival":
            missing = np.isnan(column[0])
            for block in blocks(column):
                sensed = name.startswith("sensor:")
                if not ((np.isnan(block) == missing) if sensed else np.isfinite(block)).all():
                    return False
    return True


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=float, default=1e7)
    parser.add_argument("--log", action="store_true")
    parser.add_argument("--folder", type=Path, default=Path(gettempdir()))
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    result = run(int(arguments.ticks), arguments.folder, logged=arguments.log)
    for name, value in result.items():
        print(f"{name:32}{value}", file=sys.stdout)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(result, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
