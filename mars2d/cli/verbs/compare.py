"""The verb ``compare``."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from pathlib import Path

from mars2d.cli.arguments import options_of, preferences_of, shared
from mars2d.cli.outputs import (
    FPS,
    SIZE,
    conclude,
    film_speed,
    picture_and_film,
    produced,
)
from mars2d.cli.runs import run_headless
from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.progress import progress
from mars2d.core.terminal import aligned, tell
from mars2d.output.figures.comparison import MODES, Drift, plot_comparison
from mars2d.output.figures.figure import save_drawing
from mars2d.output.films.footage import Cut
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.window.screen.display import display_available
from mars2d.window.screen.source import Playback
from mars2d.world.record import Record

FOLDER = Path("mars2d_compare")

ARGUMENTS = shared("experiment headless seed speed stop-time set figure video dark text")


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment with each physics, and show the runs side by side.

    In a window, if there is a display and no other output is wanted.
    """
    options = options_of(arguments)
    if "physics" in options:
        raise InputError("--set physics: compare runs each physics by itself")
    if arguments.speed in (0, "max"):
        raise InputError("--speed: expected a number > 0")

    def opened(mode: str) -> Experiment:
        """Return the experiment with a physics, opened again, so that no two runs share laws."""
        every = {**options, "physics": mode}
        return open_experiment(arguments.experiment, every, seed=arguments.seed)

    if not (arguments.figure or arguments.video):
        if not arguments.headless and display_available():
            _show(arguments, opened)
            return
        picture_and_film(arguments, FOLDER, opened("contact").scenario.stop_time)
    records = {mode: _run(opened(mode), mode) for mode in MODES}
    tell(_as_table(records))
    makers = {
        "figure": lambda: save_drawing(lambda: plot_comparison(records), arguments.figure),
        "video": lambda: _save_film(records, arguments),
    }
    conclude(*produced(arguments, makers))


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
    from mars2d.window.screen.source import Trio

    speed = film_speed(records["contact"].scenario, arguments.speed)
    cut = Cut.of(max(float(record.time[-1]) for record in records.values()), speed, FPS)
    window = CompareWindow(Trio({mode: Playback(record) for mode, record in records.items()}))
    with progress(cut.count, "frame") as update:
        pictures = window.film(cut, SIZE, f"{speed:.3g}x")
        save_pictures(pictures, arguments.video, FPS, update)


def _as_table(records: Mapping[str, Record]) -> str:
    """Return how the runs went, with the final drift from the run with contact."""
    lines = [["physics", "steps", "collisions", "drift max", "drift mean"]]
    ends = ["ended"]
    for mode, record in records.items():
        apart = ["-", "-"]
        if mode != "contact":  # less than a micrometre is rounding
            drift = Drift.between(records["contact"], record)
            apart = [f"{round(float(x[-1]), 6):.3g} m" for x in (drift.max, drift.mean)]
        lines.append([mode, f"{record.steps}", f"{record.collisions}", *apart])
        ends.append(record.over_message)
    first = records["contact"]
    title = f"{first.scenario.title}, seed {first.seed}"
    rows = zip(aligned(lines, left=1), ends, strict=True)
    return "\n".join([title, *("  ".join(row) for row in rows)])
