"""Where the time of a control step goes: the share of each of its stages.

    python benchmarks/stages.py [--json OUT.json] [SCENE ...] [--seconds S]

The suite's scenes at both settings. The stages are those of `World._control_step`; "rest" is what
lies between them.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Mapping
from operator import attrgetter
from pathlib import Path
from typing import Any

from scenes import SCENES, Scene
from suite import STEPS, warmed_up
from worlds import SETTINGS

from mars2d.world.world import World

STAGES = {
    "sense": "_observe",
    "law": "laws.commands",
    "limits": "_saturate",
    "record": "_write_row",
    "motion": "_drive",
}
"""The stages, and the methods of a simulation that do them."""


class Watch:
    """Adds up how long calls take."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def around(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that does the same and is timed."""

        def timed(*arguments: Any) -> Any:
            start = time.perf_counter()
            try:
                return function(*arguments)
            finally:
                self.seconds += time.perf_counter() - start

        return timed


def shares(scene: Scene, max_overlap: float, least_time: float) -> dict[str, float]:
    """Return microseconds of a scene's control step, and the parts of its stages."""
    watches = {stage: Watch() for stage in STAGES}
    world = watched(scene, max_overlap, watches)
    steps, taken = 0, 0.0
    while taken < least_time:
        if steps and scene.proximity:  # see suite.py
            world = watched(scene, max_overlap, watches)
        start = time.perf_counter()
        for _ in range(STEPS[scene.name]):
            world.step()
        taken += time.perf_counter() - start
        steps += STEPS[scene.name]
    parts = {stage: watch.seconds / taken for stage, watch in watches.items()}
    return {"us": 1e6 * taken / steps, **parts, "rest": 1 - sum(parts.values())}


def watched(scene: Scene, max_overlap: float, watches: Mapping[str, Watch]) -> World:
    """Return a world whose stages are timed."""
    world = warmed_up(scene, max_overlap)
    for stage, method in STAGES.items():
        *owner, name = f"simulation.{method}".split(".")
        does = attrgetter(".".join(owner))(world)
        setattr(does, name, watches[stage].around(getattr(does, name)))
    return world


def main() -> None:
    """Measure, print a table, and write the figures where they are asked for."""
    parser = argparse.ArgumentParser(description="Where the time of a control step goes.")
    parser.add_argument("scene", nargs="*", default=list(SCENES), help="of the suite; else all")
    parser.add_argument("--json", type=Path, metavar="OUT.json", help="write the figures")
    parser.add_argument("--seconds", type=float, default=3.0, help="for each")
    arguments = parser.parse_args()
    if unknown := {*arguments.scene} - {*SCENES}:
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")
    if not arguments.seconds > 0:
        parser.error(f"--seconds {arguments.seconds:g}: expected more than 0")
    columns = [*STAGES, "rest"]
    print(f"{'':<12}{'step':>12}", *(f"{name:>8}" for name in columns))
    rows = {}
    for name in arguments.scene:
        scene = SCENES[name]()
        for setting, max_overlap in SETTINGS.items():
            row = rows[f"{name} {setting}"] = shares(scene, max_overlap, arguments.seconds)
            parts = (f"{100 * row[column]:>6.0f} %" for column in columns)
            print(f"{name} {setting:<9}{row['us']:>9,.0f} us", *parts, flush=True)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
