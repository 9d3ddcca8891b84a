"""How fast control steps are in seven scenes, in turns with a bare pymunk loop.

    python benchmarks/suite.py [SCENE ...] [--rounds N] [--json OUT.json] [--compare OLD.json]

Each scene runs at both settings. The yardstick, a loop over pymunk with the robots of S2, is timed
before and after each round, since the load of a machine changes: so figures of other days and
machines compare in units of it.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from statistics import fmean, median
from typing import Any

import numpy as np
from scenes import SCENES, Scene
from worlds import SETTINGS, deepest, world_of
from yardstick import Bare

from mars2d.world.record import Record
from mars2d.world.world import World

STEPS = {"S1": 600, "S2": 150, "S3": 40, "S4": 15, "P1": 40, "P2": 40, "P3": 40}
"""Control steps in a round of each scene."""

WARM_UP = 5.0
"""The simulated time before the first round, in which robots move and meet, seconds."""

BARE_STEPS = 200
"""Control steps of the yardstick between two rounds."""

HEAD = (
    f"{'':<35}{'overlap':>8}{'steps':>10}{'times':>11}{'deepest':>10}{'bytes per':>12}\n"
    f"{'':<35}{'allowed':>8}{'a second':>10}{'real time':>11}{'seen':>10}{'robot-step':>12}"
)


def seconds(step: Callable[[], None], steps: int) -> float:
    """Return how long a call takes, in the mean of some."""
    start = time.perf_counter()
    for _ in range(steps):
        step()
    return (time.perf_counter() - start) / steps


def warmed_up(scene: Scene, max_overlap: float) -> World:
    """Return a world of a scene whose robots have moved and met."""
    world = world_of(scene, max_overlap)
    seconds(world.step, round(WARM_UP / scene.sampling_time))
    return world


def measure(scene: Scene, max_overlap: float, rounds: int) -> dict[str, Any]:
    """Return the time of a control step in each round, alone and in steps of the yardstick."""
    bare = Bare(SCENES["S2"]())
    world = warmed_up(scene, max_overlap)
    times, shares, before = [], [], seconds(bare, BARE_STEPS)
    for _ in range(rounds):
        if scene.proximity:  # Algorithm 2 may back into a corner and stay there
            world = warmed_up(scene, max_overlap)
        times.append(seconds(world.step, STEPS[scene.name]))
        after = seconds(bare, BARE_STEPS)
        shares.append(2 * times[-1] / (before + after))
        before = after
    record = world.record
    poses = np.concatenate([record.pose, record.prop_pose], axis=2)
    return {
        "step_s": fmean(times),
        "real_time": scene.sampling_time / fmean(times),
        "deepest_mm": 1e3 * deepest(scene, poses),
        "bytes_a_robot_step": size(record) / record.effort.size,
        "yardsticks": shares,
    }


def size(record: Record) -> int:
    """Return the size of a record's numbers, bytes."""
    columns = (record.time, record.command_time, record.pose, record.command, record.effort)
    others = (record.prop_pose, record.contacts, *record.sensors.values())
    return sum(values.nbytes for values in columns + others)


def compared(old: dict[str, Any], new: dict[str, Any]) -> str:
    """Return how many times as fast a row has become: the median, the least and the most."""
    ratios = [a / b for a, b in zip(old["yardsticks"], new["yardsticks"], strict=False)]
    return f"  {median(ratios):.2f} x ({min(ratios):.2f} to {max(ratios):.2f})"


def main() -> None:
    """Measure, print a table, and write the figures where they are asked for."""
    parser = argparse.ArgumentParser(description="How fast are control steps?")
    parser.add_argument("scene", nargs="*", default=list(SCENES), help="else all")
    parser.add_argument("--rounds", type=int, default=7, help="how often each is timed")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--compare", type=Path, metavar="OLD.json", help="with those of a file")
    arguments = parser.parse_args()
    if unknown := {*arguments.scene} - {*SCENES}:
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")
    old = json.loads(arguments.compare.read_text("utf-8")) if arguments.compare else {}
    print(HEAD)
    rows = {}
    for scene in (SCENES[name]() for name in arguments.scene):
        for setting, allowed in SETTINGS.items():
            name = f"{scene.name} {setting}"
            row = rows[name] = measure(scene, allowed, arguments.rounds)
            print(
                f"{name:<12}{scene.title:<23}{1e3 * allowed:>5.0f} mm{1 / row['step_s']:>10,.0f}"
                f"{row['real_time']:>11,.1f}{row['deepest_mm']:>7.2f} mm"
                f"{row['bytes_a_robot_step']:>12.0f}",
                compared(old[name], row) if name in old else "",
                flush=True,
            )
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
