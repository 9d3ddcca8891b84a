"""The verb ``compare``."""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import options_of, preferences_of, shared
from mars2d.cli.outputs import (
    FPS,
    SIZE,
    conclude,
    film_speed,
    outcome,
    picture_and_film,
    produced,
)
from mars2d.cli.runs import has_display, run_headless
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.progress import progress
from mars2d.core.terminal import aligned, tell
from mars2d.output.figures.comparison import MODES, Drift, save_comparison
from mars2d.output.films.footage import Cut
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.window.screen.source import Playback
from mars2d.world.record import Record

FOLDER = Path("mars2d_compare")

ARGUMENTS = shared("experiment headless seed speed stop-time set figure video dark text json")


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment with each physics, and show the runs side by side.

    In a window, if there is a display and no other output is wanted.
    """
    start = time.perf_counter()
    options = options_of(arguments)
    if "physics" in options:
        raise InputError("--set physics: compare runs each physics by itself")
    if arguments.speed in (0, "max"):
        raise InputError("--speed: expected a number > 0")
    opened = partial(_opened, arguments.experiment, options, arguments.seed)
    if not (arguments.json or arguments.figure or arguments.video):
        if not arguments.headless and has_display():
            _show(arguments, opened)
            return
        picture_and_film(arguments, FOLDER, opened("contact").scenario.stop_time)
    records = {mode: _run(opened(mode), mode) for mode in MODES}
    if not arguments.json:
        tell(_as_table(records))
    makers = {
        "figure": lambda: save_comparison(records, arguments.figure),
        "video": lambda: _save_film(records, arguments),
    }
    made, troubles = produced(arguments, makers)
    if arguments.json:
        found = {"title": records["contact"].scenario.title, "seed": records["contact"].seed}
        found |= {name: str(path) for name, path in made.items()}
        found |= {"runs": _outcomes(records), "wall_s": round(time.perf_counter() - start, 6)}
        tell(json.dumps(found))
    conclude({} if arguments.json else made, troubles)


def _opened(source: str, options: dict[str, Any], seed: int, mode: str) -> Experiment:
    """Return an experiment with a physics, opened again.

    Laws keep state in generators and in their module's globals, so that no two runs share them.
    """
    opened = open_experiment(source, options, seed=seed)
    scenario = opened.scenario.replace(physics=mode)
    again = partial(_opened, source, options, seed, mode)
    return dataclasses.replace(opened, scenario=scenario, opened=again)


def _show(arguments: argparse.Namespace, opened: Callable[[str], Experiment]) -> None:
    """Show the runs in a window, and print how they went until it was closed."""
    from mars2d.window.show import show_comparison

    own = opened("contact").scenario.animation.playback_speed
    speed = own if arguments.speed is None else arguments.speed
    records = show_comparison(opened, speed, preferences_of(arguments))
    if all(len(record) for record in records.values()):
        tell(_as_table(records))


def _run(experiment: Experiment, mode: str) -> Record:
    """Run with a physics, which errors name."""
    try:
        return run_headless(experiment).record
    except Mars2dError as error:
        error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
        raise


def _save_film(records: dict[str, Record], arguments: argparse.Namespace) -> None:
    from mars2d.output.films.film import save_pictures
    from mars2d.window.compare_window import CompareWindow
    from mars2d.window.trio import Trio

    speed = film_speed(records["contact"].scenario, arguments.speed)
    cut = Cut.of(max(float(record.time[-1]) for record in records.values()), speed, FPS)
    window = CompareWindow(Trio({mode: Playback(record) for mode, record in records.items()}))
    with progress(cut.count, "frame") as update:
        pictures = window.film(cut, SIZE, f"{speed:.3g}x")
        save_pictures(pictures, arguments.video, FPS, update)


def _outcomes(records: Mapping[str, Record]) -> list[dict[str, Any]]:
    """Return how the runs went, with the final drift from the run with contact, metres."""
    found = []
    for mode, record in records.items():
        drift = Drift.between(records["contact"], record)
        drifted = {"drift_max": float(drift.max[-1]), "drift_mean": float(drift.mean[-1])}
        found.append({"physics": mode, **drifted, **outcome(record)})
    return found


def _as_table(records: Mapping[str, Record]) -> str:
    lines, ends = [("physics", "steps", "collisions", "drift max", "drift mean")], ["ended"]
    for run in _outcomes(records):
        apart = ["-", "-"]
        if run["physics"] != "contact":  # less than a micrometre is rounding
            apart = [f"{round(run[name], 6):.3g} m" for name in ("drift_max", "drift_mean")]
        lines.append((run["physics"], f"{run['ticks']}", f"{run['collisions']}", *apart))
        ends.append(run["message"])
    first = records["contact"]
    title = f"{first.scenario.title}, seed {first.seed}"
    rows = zip(aligned(lines, left=1), ends, strict=True)
    return "\n".join([title, *("  ".join(row) for row in rows)])
