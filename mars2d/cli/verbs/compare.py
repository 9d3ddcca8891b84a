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
from typing import Any

from mars2d.cli.arguments import options_of, preferences_of, shared
from mars2d.cli.outputs import DURATION, FPS, OUTPUTS, SIZE, check_outputs, film_speed, outcome
from mars2d.cli.runs import has_display, run_headless
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.progress import Progress
from mars2d.core.terminal import aligned, tell
from mars2d.output.figures.comparison import MODES, Comparison
from mars2d.output.films.footage import Cut
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import experiment_name
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
    check_outputs(arguments, {name: OUTPUTS[name] for name in ("figure", "video")})
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
        require_pygame("a film")
        FOLDER.mkdir(exist_ok=True)
        stem = experiment_name(Path(arguments.experiment))
        arguments.figure, arguments.video = FOLDER / f"{stem}.png", FOLDER / f"{stem}.gif"
        arguments.speed = arguments.speed or opened("contact").scenario.stop_time / DURATION
    records = {mode: _run(opened(mode), mode) for mode in MODES}
    comparison = Comparison(**records)
    if arguments.json:
        _save(comparison, records, arguments)
        tell(_as_json(comparison, arguments, time.perf_counter() - start))
        return
    tell(_as_table(comparison))
    for word, path in _save(comparison, records, arguments).items():
        tell(f"{word + ':':<8} {path}")


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


def _run(experiment: Experiment, mode: str) -> Record:
    """Run with a physics, which errors name."""
    try:
        return run_headless(experiment).record
    except Mars2dError as error:
        error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
        raise


def _save(
    comparison: Comparison, records: dict[str, Record], arguments: argparse.Namespace
) -> dict[str, Path]:
    """Save the requested picture and film, and return their paths."""
    made: dict[str, Path] = {}
    if arguments.figure:
        made["picture"] = comparison.save_figure(arguments.figure)
    if arguments.video:
        from mars2d.output.films.film import save_pictures
        from mars2d.window.compare_window import CompareWindow
        from mars2d.window.trio import Trio

        made["film"] = arguments.video
        speed = film_speed(comparison.contact.scenario, arguments.speed)
        cut = Cut.of(max(float(record.time[-1]) for record in records.values()), speed, FPS)
        window = CompareWindow(Trio({mode: Playback(record) for mode, record in records.items()}))
        pictures = window.film(cut, SIZE, f"{speed:.3g}x")
        with closing(Progress(cut.count, "frames")) as bar:
            save_pictures(pictures, arguments.video, FPS, bar.update)
    return made


def _as_table(comparison: Comparison) -> str:
    """Return the outcome as a table, with the final drift from the run with contact."""
    lines = [("physics", "steps", "collisions", "drift max", "drift mean", "ended")]
    for mode, record in comparison.records.items():
        drift = comparison.drifts.get(mode)
        # Less than a micrometre is rounding.
        last = [] if drift is None else [drift.max[-1], drift.mean[-1]]
        apart = [f"{round(float(each), 6):.3g} m" for each in last] or ["-", "-"]
        counts = str(len(record) - 1), str(record.collisions)
        lines.append((mode, *counts, apart[0], apart[1], record.over_message))
    title = f"{comparison.contact.scenario.title}, seed {comparison.contact.seed}"
    cells = aligned([line[:-1] for line in lines], left=1)
    ends = (line[-1] for line in lines)
    return "\n".join([title, *("  ".join(row) for row in zip(cells, ends, strict=True))])


def _as_json(comparison: Comparison, arguments: argparse.Namespace, seconds: float) -> str:
    runs = []
    for mode, record in comparison.records.items():
        drift = comparison.drifts.get(mode)
        last, mean = (0.0, 0.0) if drift is None else (drift.max[-1], drift.mean[-1])
        run = {"physics": mode, "drift_max": float(last), "drift_mean": float(mean)}
        runs.append(run | outcome(record))
    found = {"title": comparison.contact.scenario.title, "seed": comparison.contact.seed}
    files = {"figure": arguments.figure, "video": arguments.video}
    found |= {name: str(path) for name, path in files.items() if path}
    return json.dumps(found | {"runs": runs, "wall_s": round(seconds, 6)})
