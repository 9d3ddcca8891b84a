"""The verb ``compare``."""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.cli.arguments import options_of, preferences_of, shared
from mars2d.cli.outputs import (
    FPS,
    conclude,
    film_speed,
    outcome,
    picture_and_film,
    produced,
)
from mars2d.cli.runs import has_display, run_headless
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.progress import Progress
from mars2d.core.terminal import aligned, tell
from mars2d.output.figures.comparison import MODES, Comparison
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.world.record import Record

if TYPE_CHECKING:
    from mars2d.output.films.triptych import Reel

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
    reels: dict[str, Reel] = {}
    comparison = Comparison(**{mode: _run(opened(mode), mode, arguments, reels) for mode in MODES})
    if not arguments.json:
        tell(_as_table(comparison))
    makers = {
        "figure": lambda: comparison.save_figure(arguments.figure),
        "video": lambda: _save_film(comparison, reels, arguments.video),
    }
    made, troubles = produced(arguments, makers)
    if arguments.json:
        found = {"title": comparison.contact.scenario.title, "seed": comparison.contact.seed}
        found |= {name: str(path) for name, path in made.items()}
        found |= {"runs": _outcomes(comparison), "wall_s": round(time.perf_counter() - start, 6)}
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
        tell(_as_table(Comparison(**records)))


def _run(
    experiment: Experiment, mode: str, arguments: argparse.Namespace, reels: dict[str, Reel]
) -> Record:
    """Run with a physics, which errors name; keep the frames of a film that is wanted."""
    from mars2d.output.films.footage import Footage

    speed = film_speed(experiment.scenario, arguments.speed)
    footage = Footage(experiment.scenario, speed, FPS) if arguments.video else None
    try:
        world = run_headless(experiment, [footage] if footage else [])
    except Mars2dError as error:
        error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
        raise
    if footage:
        reels[mode] = footage, world.frame
    return world.record


def _save_film(comparison: Comparison, reels: dict[str, Reel], path: Path) -> None:
    from mars2d.output.films.film import save_pictures
    from mars2d.output.films.triptych import triptych

    count = max(footage.count(last) for footage, last in reels.values())
    with closing(Progress(count, "frames")) as bar:
        save_pictures(triptych(comparison, reels), path, FPS, bar.update)


def _outcomes(comparison: Comparison) -> list[dict[str, Any]]:
    """Return how the runs went, with the final drift from the run with contact, metres."""
    found = []
    for mode, record in comparison.records.items():
        drift = comparison.drifts.get(mode)
        most, mean = (0.0, 0.0) if drift is None else (drift.max[-1], drift.mean[-1])
        drifted = {"drift_max": float(most), "drift_mean": float(mean)}
        found.append({"physics": mode, **drifted, **outcome(record)})
    return found


def _as_table(comparison: Comparison) -> str:
    lines, ends = [("physics", "steps", "collisions", "drift max", "drift mean")], ["ended"]
    for run in _outcomes(comparison):
        apart = ["-", "-"]
        if run["physics"] in comparison.drifts:  # less than a micrometre is rounding
            apart = [f"{round(run[name], 6):.3g} m" for name in ("drift_max", "drift_mean")]
        lines.append((run["physics"], f"{run['ticks']}", f"{run['collisions']}", *apart))
        ends.append(run["message"])
    title = f"{comparison.contact.scenario.title}, seed {comparison.contact.seed}"
    rows = zip(aligned(lines, left=1), ends, strict=True)
    return "\n".join([title, *("  ".join(row) for row in rows)])
