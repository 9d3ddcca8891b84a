"""The verb ``compare``."""

from __future__ import annotations

import argparse
import dataclasses
import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.cli.arguments import add_options, add_preferences, options_of, preferences_of
from mars2d.cli.films import DURATION, FPS, film_speed
from mars2d.cli.outputs import check_outputs
from mars2d.cli.runs import has_display, make_folder, run_headless
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.progress import Progress
from mars2d.core.terminal import tell
from mars2d.output.figures import figure
from mars2d.output.figures.comparison import MODES, Comparison
from mars2d.output.films import film
from mars2d.output.raster import require_pygame
from mars2d.scenario.animation import playback_speed
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.world.record import Record

if TYPE_CHECKING:
    from mars2d.output.films.footage import Footage
    from mars2d.output.films.triptych import Reel

FOLDER = Path("mars2d_compare")

OUTPUTS = {"figure": figure.SUFFIXES, "video": film.SUFFIXES}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("experiment", metavar="EXPERIMENT", help="a .py or .toml file, or the name of an example")
    add("--seed", type=int, default=0, metavar="N", help="of all random streams")
    add_options(parser)
    add("--figure", type=Path, metavar="OUT", help="the picture: .png, .pdf, .svg")
    add("--video", type=Path, metavar="OUT", help="the film: .gif, .mp4")
    add("--speed", type=_speed, metavar="X", help="of the window or the film: 1 is real time")
    add("--headless", action="store_true", help="without a window: a picture and a film")
    add_preferences(parser)
    add("--json", action="store_true", help="print the outcome as one line of JSON")


def _speed(text: str) -> float:
    try:
        speed = playback_speed("--speed", float(text))
    except ValueError:
        speed = 0.0
    if not isinstance(speed, float) or speed <= 0:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number > 0")
    return speed


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment with each physics, and show the runs side by side.

    In a window, if there is a display and no other output is wanted.
    """
    start = time.perf_counter()
    check_outputs(arguments, OUTPUTS)
    options, seed = _options(arguments), arguments.seed
    outputs = arguments.figure, arguments.video
    if not (arguments.headless or arguments.json or any(outputs)) and has_display():
        _show(arguments, options, seed)
        return
    experiments = {mode: _opened(arguments.experiment, options, seed, mode) for mode in MODES}
    paths = _paths(arguments)
    records: dict[str, Record] = {}
    reels: dict[str, Reel] = {}
    for mode, experiment in experiments.items():
        with _saying(mode):
            footage = _footage(arguments, experiment) if "video" in paths else None
            world = run_headless(experiment, [footage] if footage else [])
        records[mode] = world.record
        if footage is not None:
            reels[mode] = footage, world.frame
    comparison = Comparison(**records)
    if not arguments.json:
        tell(_as_table(comparison))
    _save(comparison, reels, paths, say=not arguments.json)
    if arguments.json:
        tell(_as_json(comparison, paths, time.perf_counter() - start))


def _opened(source: str, options: dict[str, Any], seed: int, mode: str) -> Experiment:
    """Return an experiment with a physics, opened again.

    Laws keep state in generators and in their module's globals, so that no two runs share them.
    """
    opened = open_experiment(source, options, seed=seed)
    scenario = opened.scenario.replace(physics=mode)
    again = partial(_opened, source, options, seed, mode)
    return dataclasses.replace(opened, scenario=scenario, opened=again)


def _show(arguments: argparse.Namespace, options: dict[str, Any], seed: int) -> None:
    """Show the runs in a window, and print how they went until it was closed."""
    from mars2d.window.show import show_comparison

    own = open_experiment(arguments.experiment, options, seed=seed).scenario.animation
    speed = own.playback_speed if arguments.speed is None else arguments.speed
    opened = partial(_opened, arguments.experiment, options, seed)
    records = show_comparison(opened, speed, preferences_of(arguments))
    if all(len(record) for record in records.values()):
        tell(_as_table(Comparison(**records)))


def _options(arguments: argparse.Namespace) -> dict[str, Any]:
    options = options_of(arguments)
    if "physics" in options:
        raise InputError("--set physics: compare runs each physics by itself")
    return options


def _paths(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the paths of figure and film; without any output option, both go into a folder."""
    wanted = {name: path for name in OUTPUTS if (path := getattr(arguments, name)) is not None}
    if wanted or arguments.json:
        return wanted
    require_pygame("a film")
    make_folder(FOLDER)
    name = Path(arguments.experiment).stem
    return {"figure": FOLDER / f"{name}.png", "video": FOLDER / f"{name}.gif"}


@contextmanager
def _saying(mode: str) -> Iterator[None]:
    """Add the kind of physics to the place of an error."""
    try:
        yield
    except Mars2dError as error:
        error.where = ": ".join(filter(None, [f"physics = {mode!r}", error.where]))
        raise


def _footage(arguments: argparse.Namespace, experiment: Experiment) -> Footage:
    from mars2d.output.films.footage import Footage

    speed = arguments.speed
    if speed is None and arguments.video is None:
        speed = experiment.scenario.stop_time / DURATION
    return Footage(experiment.scenario, film_speed(experiment.scenario, speed), FPS)


def _save(
    comparison: Comparison, reels: dict[str, Reel], paths: dict[str, Path], *, say: bool
) -> None:
    """Save the requested figure and film, and print their paths."""
    if "figure" in paths:
        comparison.save_figure(paths["figure"])
        if say:
            tell(f"picture: {paths['figure']}")
    if "video" in paths:
        from mars2d.output.films.triptych import triptych

        progress = Progress(max(footage.count(last) for footage, last in reels.values()), "frames")
        try:
            pictures = triptych(comparison, reels)
            film.save_pictures(pictures, paths["video"], FPS, progress.update)
        finally:
            progress.close()
        if say:
            tell(f"film:    {paths['video']}")


def _rows(comparison: Comparison) -> list[dict[str, Any]]:
    """Return the outcome of each run; the drift is that at the last time of both runs."""
    rows = []
    for mode, record in comparison.records.items():
        drift = comparison.drifts.get(mode)
        rows.append(
            {
                "physics": mode,
                "ticks": len(record) - 1,
                "time": float(record.time[-1]),
                "collisions": record.collisions,
                "drift_max": 0.0 if drift is None else float(drift.max[-1]),
                "drift_mean": 0.0 if drift is None else float(drift.mean[-1]),
                "message": record.over_message,
                "digest": record.digest,
            }
        )
    return rows


def _as_table(comparison: Comparison) -> str:
    """Return the outcome as a table, with the final drift from the run with contact."""
    lines = [("physics", "steps", "collisions", "drift max", "drift mean", "ended")]
    for row in _rows(comparison):
        drifts = ("-", "-")
        if row["physics"] != "contact":
            drifts = _metres(row["drift_max"]), _metres(row["drift_mean"])
        counts = str(row["ticks"]), str(row["collisions"])
        lines.append((row["physics"], *counts, *drifts, row["message"]))
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    table = [f"{comparison.contact.scenario.title}, seed {comparison.contact.seed}"]
    for first, *middle, last in lines:
        cells = [cell.rjust(width) for cell, width in zip(middle, widths[1:-1], strict=True)]
        table.append("  ".join([first.ljust(widths[0]), *cells, last]))
    return "\n".join(table)


def _metres(distance: float) -> str:
    """Return a distance as text; less than a micrometre is rounding and shown as 0."""
    return f"{round(distance, 6):.3g} m"


def _as_json(comparison: Comparison, paths: dict[str, Path], seconds: float) -> str:
    outcome = {
        "title": comparison.contact.scenario.title,
        "seed": comparison.contact.seed,
        "runs": _rows(comparison),
        **{name: str(path) for name, path in paths.items()},
        "wall_s": round(seconds, 6),
    }
    return json.dumps(outcome)
