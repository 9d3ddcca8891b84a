"""The verb ``run``."""

from __future__ import annotations

import argparse
import inspect
import json
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from mars2d.cli import remarks
from mars2d.cli.arguments import (
    add_human,
    add_options,
    add_preferences,
    add_run_arguments,
    add_speed,
    add_theory,
    humans_of,
    options_of,
    preferences_of,
    theory_of,
)
from mars2d.cli.films import FPS, Film, check_film, film_speed, save_footage
from mars2d.cli.outputs import (
    OUTPUTS,
    add_pictures,
    check_outputs,
    check_snapshots,
    run_and_save,
    say,
    tell_files,
)
from mars2d.cli.runs import (
    has_display,
    predictions_of,
    print_predictions,
    run_headless,
    show,
    warn_unchecked,
)
from mars2d.core.errors import InputError, counted, likely, one_line
from mars2d.core.terminal import tell, warn
from mars2d.output import formats
from mars2d.output.raster import require_pygame
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.prediction import Prediction
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record
from mars2d.world.world import Watcher

FOXGLOVE = 8765
"""The port at which Foxglove looks for a server."""

LONG = 20.0
"""Seconds of the engine's work after which it is worth while to have it compiled."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("experiment", metavar="EXPERIMENT", help="a .py or .toml file, or the name of an example")
    add_run_arguments(parser)
    add_speed(parser)
    add_options(parser)
    add(
        "--record",
        type=Path,
        metavar="OUT",
        help="save all data: .npz, .csv, or .mcap, which is written during the run; .mat, .nc",
    )
    add_pictures(parser)
    add(
        "--foxglove",
        type=int,
        nargs="?",
        const=FOXGLOVE,
        metavar="PORT",
        help=f"serve the run to Foxglove on this machine while it goes on, at port {FOXGLOVE}",
    )
    add_theory(parser)
    add_human(parser)
    add_preferences(parser)
    add("--json", action="store_true", help="print the outcome as one line of JSON")


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment, in a window if there is a display, and save the requested files."""
    check_outputs(arguments, OUTPUTS)
    check_snapshots(arguments)
    options = options_of(arguments) | theory_of(arguments)
    experiment = open_experiment(arguments.experiment, options, seed=arguments.seed)
    _check_times(arguments, experiment)
    scenario = experiment.scenario
    check_film(arguments, scenario, scenario.last_iteration * scenario.sampling_time)
    humans_of(arguments, experiment)
    for remark in remarks.before(experiment):
        warn(remark)
    bounds = remarks.Bounds()
    start = time.perf_counter()
    run = _run_in_window if _wants_window(arguments) else _run_headless
    try:
        with _live(arguments) as live:
            watchers: list[Watcher] = [bounds, *live]
            record, made, troubles = run_and_save(
                arguments, lambda: run(arguments, experiment, watchers)
            )
    except Interrupted:
        warn_unchecked(experiment, "cut short")
        raise
    lawless = experiment.control is None and not any(
        robot.controller for robot in experiment.scenario.robots
    )
    if lawless and not experiment.scenario.props:
        warn(f"there is no law, so all robots stood still{_law_meant(experiment)}")
    if arguments.json:
        predictions = predictions_of(experiment, record)
        tell(_as_json(record, predictions, time.perf_counter() - start))
    else:
        tell(_as_text(record))
        print_predictions(experiment, record)
        for remark in bounds.remarks():
            tell(f"note: {remark}")
        tell_files(made)
    if troubles:
        say(troubles[:-1])
        raise troubles[-1]


@contextmanager
def _live(arguments: argparse.Namespace) -> Iterator[list[Watcher]]:
    """Serve the run to Foxglove, if that is asked for, and yield who sends it."""
    if arguments.foxglove is None:
        yield []
        return
    from mars2d.output.formats.mcap.live import Live

    with Live(arguments.foxglove) as live:
        warn(f"Foxglove: open {live.address}")
        yield [live]


def _law_meant(experiment: Experiment) -> str:
    """Return how a function of the file that is no law becomes one, or ""."""
    for name, function in experiment.source.functions.items():
        first = next(iter(inspect.signature(function).parameters), "")
        if first == "robot":
            return f"; give {name}(robot) to a robot: Robot(controller={name})"
        if first == "world" or likely(name, ["control"]):
            return f"; the law of the team must be called control: rename {name}({first})"
    return ""


def _check_times(arguments: argparse.Namespace, experiment: Experiment) -> None:
    last = experiment.scenario.stop_time
    for moment in arguments.at or ():
        if moment != "end" and not 0 <= moment <= last:
            raise InputError(f"--at {moment:g}: the experiment goes from 0 to {last:g} s")


def _wants_window(arguments: argparse.Namespace) -> bool:
    if not arguments.headless and has_display():
        return True
    if arguments.speed == 0:
        require_pygame("a window")
        why = "it needs a window, not --headless" if arguments.headless else "there is no display"
        raise InputError(f"--speed 0 makes one step a key press: {why}")
    if not arguments.headless:
        warn("there is no display, so this runs without a window")
    return False


def _run_in_window(
    arguments: argparse.Namespace, experiment: Experiment, watchers: Sequence[Watcher]
) -> tuple[Record, Film | None]:
    people, look = humans_of(arguments, experiment), preferences_of(arguments)
    log = formats.log_to(arguments.record)
    record = show(
        experiment,
        arguments.speed,
        look,
        people,
        log,
        watchers,
        kept=arguments.record is not None,
    )
    return record, None


def _run_headless(
    arguments: argparse.Namespace, experiment: Experiment, watchers: Sequence[Watcher]
) -> tuple[Record, Film | None]:
    """Run as fast as possible, or in real time for Foxglove; --speed is the film's, too."""
    log = formats.log_to(arguments.record)
    pace = "max" if arguments.foxglove is None else arguments.speed or 1.0
    if arguments.video is None:
        world = run_headless(experiment, watchers, log, pace)
        _advise_to_compile(world.simulation.engine_seconds)
        return world.record, None
    from mars2d.output.films.footage import Footage

    speed = film_speed(experiment.scenario, arguments.speed)
    footage = Footage(experiment.scenario, speed, FPS, arguments.start, arguments.end)
    world = run_headless(experiment, [footage, *watchers], log, pace)
    _advise_to_compile(world.simulation.engine_seconds)
    last, path, size = world.frame, arguments.video, arguments.size
    return world.record, lambda: save_footage(footage, last, path, size)


def _advise_to_compile(seconds: float) -> None:
    """Print how the engine would be quicker, if it took long because it was not compiled."""
    from mars2d.physics.islands import reason_without

    if seconds < LONG or not reason_without():
        return
    from mars2d.reports.remedy import remedy

    warn(
        f"the engine took {seconds:.0f} s, since {reason_without()}. "
        f"Compiled it is many times quicker: {remedy()}"
    )


def _as_text(record: Record) -> str:
    done = f"{counted(_ticks(record), 'step')}, {counted(record.collisions, 'collision')}"
    message = f"{record.scenario.title}: {one_line(record.over_message)}"
    return f"{message}. {done}, digest {record.digest[:16]}"


def _as_json(record: Record, predictions: Sequence[Prediction], wall: float) -> str:
    outcome = {
        "ticks": _ticks(record),
        "time": float(record.time[-1]) if len(record) else 0.0,
        "over": record.finished,
        "message": record.over_message,
        "digest": record.digest,
        "collisions": record.collisions,
        "seed": record.seed,
        "wall_s": round(wall, 6),
        "checks": [prediction.as_dict() for prediction in predictions],
    }
    return json.dumps(outcome, allow_nan=False)


def _ticks(record: Record) -> int:
    """Return the number of control steps: one less than the number of rows."""
    return max(len(record) - 1, 0)
