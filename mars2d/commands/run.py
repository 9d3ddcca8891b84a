"""The verb ``run``."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from mars2d.commands.base import (
    FILM_FPS,
    add_human,
    add_options,
    add_preferences,
    add_run_arguments,
    add_speed,
    add_theory,
    check_outputs,
    film_speed,
    has_display,
    human_of,
    options_of,
    predictions_of,
    preferences_of,
    print_predictions,
    run_headless,
    save_footage,
    show,
    theory_of,
    warn_unchecked,
)
from mars2d.errors import InputError, Mars2dError, counted
from mars2d.files import Experiment, open_experiment
from mars2d.loop import Interrupted
from mars2d.output import figure, film
from mars2d.prediction import Prediction
from mars2d.record import Record

NAME = "run"

OUTPUTS = {"record": (".npz",), "figure": figure.SUFFIXES, "video": film.SUFFIXES}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("experiment", metavar="EXPERIMENT", help="a .py or .toml file, or the name of an example")
    add_run_arguments(parser)
    add_speed(parser)
    add_options(parser)
    add("--record", type=Path, metavar="OUT.npz", help="save all data")
    add("--figure", type=Path, metavar="OUT", help="draw the paths: .png, .pdf, .svg")
    add("--at", type=_times, metavar="T1,T2,...", help="snapshots at these times in the figure")
    add("--video", type=Path, metavar="OUT", help="make a film: .gif, .mp4")
    add_theory(parser)
    add_human(parser)
    add_preferences(parser)
    add("--json", action="store_true", help="print the outcome as one line of JSON")


def _times(text: str) -> list[float]:
    try:
        return [float(item) for item in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected times, as 1,30,60") from None


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment, in a window where there is one, and save what is asked for."""
    check_outputs(arguments, OUTPUTS)
    if arguments.at is not None and arguments.figure is None:
        raise InputError("--at needs --figure OUT")
    experiment = open_experiment(arguments.experiment, options_of(arguments) | theory_of(arguments))
    _check_times(arguments, experiment)
    human_of(arguments, experiment)
    start = time.perf_counter()
    try:
        run = _run_in_window if _wants_window(arguments) else _run_headless
        record = run(arguments, experiment)
    except (Mars2dError, Interrupted) as error:
        if error.record is not None and len(error.record):
            _keep(arguments, error.record)
        if isinstance(error, Interrupted):
            warn_unchecked(experiment, "cut short")
        raise
    lawless = experiment.control is None and not any(
        robot.controller for robot in experiment.scenario.robots
    )
    if lawless and not experiment.scenario.props:
        print("mars2d: there is no law, so all robots stood still", file=sys.stderr)
    if arguments.json:
        predictions = predictions_of(experiment, record)
        print(_as_json(record, predictions, time.perf_counter() - start))
    else:
        print(_as_text(record), flush=True)
        print_predictions(experiment, record)


def _check_times(arguments: argparse.Namespace, experiment: Experiment) -> None:
    last = experiment.scenario.stop_time
    for moment in arguments.at or ():
        if not 0 <= moment <= last:
            raise InputError(f"--at {moment:g}: the experiment goes from 0 to {last:g} s")


def _wants_window(arguments: argparse.Namespace) -> bool:
    if not arguments.headless and has_display():
        return True
    if arguments.speed == 0:
        why = "it needs a window, not --headless" if arguments.headless else "there is no display"
        raise InputError(f"--speed 0 makes one step a key press: {why}")
    if not arguments.headless:
        print("mars2d: there is no display, so this runs without a window", file=sys.stderr)
    return False


def _run_in_window(arguments: argparse.Namespace, experiment: Experiment) -> Record:
    human, look = human_of(arguments, experiment), preferences_of(arguments)
    record = show(experiment, arguments.speed, arguments.seed, look, human)
    _save_all(arguments, record)
    return record


def _run_headless(arguments: argparse.Namespace, experiment: Experiment) -> Record:
    """Run as quick as can be: without a window, a speed is that of the film."""
    if arguments.video is None:
        record = run_headless(experiment, arguments.seed).record
        _save_data(arguments, record)
        return record
    from mars2d.output.footage import Footage

    footage = Footage(experiment.scenario, film_speed(experiment, arguments.speed), FILM_FPS)
    world = run_headless(experiment, arguments.seed, [footage])
    record = world.record
    _save_data(arguments, record)
    save_footage(footage, world.frame, arguments.video)
    return record


def _keep(arguments: argparse.Namespace, record: Record) -> None:
    """Save what was recorded until an error, which is the one that counts."""
    try:
        _save_all(arguments, record)
    except Mars2dError as error:
        print(f"mars2d: {error}", file=sys.stderr)


def _save_data(arguments: argparse.Namespace, record: Record) -> None:
    """Save the record, those of branches beside it, and the figure, where they are asked for."""
    if arguments.record is not None:
        record.save(arguments.record)
        for branch in record.branches:
            saved = branch.save(_free_beside(arguments.record))
            end = f"left at {branch.time[-1]:g} s" if len(branch) else "empty"
            print(f"mars2d: another branch, {end}, is in {saved}", file=sys.stderr)
    if arguments.figure is not None:
        figure.save_figure(record, arguments.figure, _times_within(arguments.at, record))


def _free_beside(path: Path) -> Path:
    """Return where a branch of a run is kept: no file is overwritten."""
    number = 1
    while (beside := path.with_stem(f"{path.stem}_branch{number}")).exists():
        number += 1
    return beside


def _times_within(times: list[float] | None, record: Record) -> list[float] | None:
    """Return those times that a run lasted for; it may have ended early."""
    if times is None:
        return None
    end = float(record.time[-1])
    within = [moment for moment in times if moment <= end]
    if len(within) < len(times):
        print(f"mars2d: the run ended at {end:g} s: no snapshots after it", file=sys.stderr)
    return within or None


def _save_all(arguments: argparse.Namespace, record: Record) -> None:
    """Save what is asked for, the film made of the record."""
    _save_data(arguments, record)
    if arguments.video is not None:
        speed = film_speed(Experiment(record.scenario), arguments.speed)
        rows = film.film_rows(record.time, speed, FILM_FPS)
        film.save_film((record.frame(row) for row in rows), arguments.video, fps=FILM_FPS)


def _as_text(record: Record) -> str:
    done = f"{counted(_ticks(record), 'step')}, {counted(record.collisions, 'collision')}"
    message = f"{record.scenario.title}: {record.over_message}"
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
    """Return how many sampling times passed: one less than there are rows."""
    return max(len(record) - 1, 0)
