"""What several sub-commands share: arguments, runs with a progress bar, tables."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mars2d.core.errors import InputError
from mars2d.core.progress import Progress
from mars2d.output.raster import require_pygame
from mars2d.record.record import Record
from mars2d.scenario.animation import playback_speed
from mars2d.scenario.experiment import Experiment, examples
from mars2d.scenario.options import parse_setting
from mars2d.scenario.prediction import Prediction, table
from mars2d.window.display import Preferences
from mars2d.world.loop import simulate
from mars2d.world.teleop import robot_of
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

SPEED_BY_HAND = 4.0
"""How fast an experiment goes at most in which somebody drives, unless a speed is given."""


def add_run_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what every verb has that runs an experiment."""
    parser.add_argument("--headless", action="store_true", help="without a window")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of all random streams")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add what changes an experiment before it is run."""
    parser.add_argument("--stop-time", type=float, metavar="S", help="seconds to simulate")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="override a field"
    )


def add_preferences(parser: argparse.ArgumentParser) -> None:
    """Add how the window looks."""
    parser.add_argument("--dark", action="store_true", help="a dark window")
    parser.add_argument(
        "--text", type=_text, default=1.0, metavar="X", help="the window's text X times as large"
    )


def _text(text: str) -> float:
    try:
        return Preferences(text=float(text)).text
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number from 0.5 to 4") from error


def preferences_of(arguments: argparse.Namespace) -> Preferences:
    """Return what `add_preferences` has asked for."""
    return Preferences(dark=arguments.dark, text=arguments.text)


def add_human(parser: argparse.ArgumentParser) -> None:
    """Add who is driven by hand."""
    parser.add_argument(
        "--human", metavar="WHO", help="a robot to drive by hand: its name or index, or a role"
    )


def human_of(arguments: argparse.Namespace, experiment: Experiment) -> int | None:
    """Return the robot that `add_human` has asked for, by its index."""
    if arguments.human is None:
        return None
    robot = robot_of(experiment.scenario, arguments.human, "--human")
    if arguments.headless or not has_display():
        require_pygame("a window")
        why = "not --headless" if arguments.headless else "and there is no display"
        raise InputError(f"--human {arguments.human}: driving by hand needs a window, {why}")
    return robot


def add_theory(parser: argparse.ArgumentParser) -> None:
    """Add the switch that shows what theory predicts."""
    parser.add_argument("--theory", action="store_true", help="draw what theory predicts")


def theory_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options that `add_theory` has asked for."""
    return {"animation.theory": True} if arguments.theory else {}


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options that `add_options` has asked for, by the names of fields."""
    options = dict(parse_setting(setting) for setting in arguments.set)
    if arguments.stop_time is not None:
        options["stop_time"] = arguments.stop_time
    return options


def times(text: str) -> list[float]:
    """Return the times [s] that an argument lists."""
    try:
        return [float(item) for item in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected times, as 1,30,60") from None


def make_folder(path: Path) -> None:
    """Make a folder, unless it is there."""
    try:
        path.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.absolute()}: can't be made: {error.strerror}") from error


def add_speed(parser: argparse.ArgumentParser) -> None:
    """Add the speed of playback."""
    parser.add_argument(
        "--speed",
        type=_speed,
        metavar="X",
        help="of window or film: 1 is real time, 0 one step a key press, max",
    )


def _speed(text: str) -> float | str:
    if text == "max":
        return text
    try:
        return playback_speed("--speed", float(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number >= 0, or max") from error


def has_display() -> bool:
    """Return whether a window could be opened."""
    from mars2d.window.display import display_available

    return display_available()


def show(
    experiment: Experiment,
    speed: float | str | None,
    seed: int,
    preferences: Preferences,
    human: int | None = None,
    log: Log | None = None,
) -> Record:
    """Run in a window, at the experiment's own speed unless one is given.

    human: a robot that is driven by hand, for which the experiment's own speed may be too fast.
    log: what writes each row while the run goes on.
    """
    from mars2d.window.show import show_experiment

    own = experiment.scenario.animation.playback_speed
    if human is not None and not (isinstance(own, float) and 0 < own < SPEED_BY_HAND):
        own = SPEED_BY_HAND
    pace = own if speed is None else speed
    return show_experiment(experiment, pace, seed, preferences=preferences, human=human, log=log)


def run_headless(
    experiment: Experiment, seed: int, watchers: Sequence[Watcher] = (), log: Log | None = None
) -> World:
    """Run without a window, with a progress bar, and return the world, which is over."""
    progress = Progress(experiment.scenario.last_iteration)
    try:
        return simulate(experiment, seed, watchers=[*watchers, progress], log=log)
    finally:
        progress.close()


def predictions_of(experiment: Experiment, record: Record) -> tuple[Prediction, ...]:
    """Return what an experiment's checks make of a run; say why if there is nothing to be made."""
    if not record.finished:
        warn_unchecked(experiment, "cut short")
    elif record.interventions:
        warn_unchecked(experiment, "changed by hand")
    return experiment.predictions(record)


def print_predictions(experiment: Experiment, record: Record) -> None:
    """Print what an experiment's checks make of a run as a table, if it has any."""
    predictions = predictions_of(experiment, record)
    if predictions:
        title = [experiment.summary] if experiment.summary else []
        print("", *title, table(predictions), sep="\n")


def warn_unchecked(experiment: Experiment, what: str) -> None:
    """Say what was done to a run, if the experiment has checks that were to follow it."""
    if experiment.checks is not None:
        print(f"mars2d: the run was {what}, so its checks were not made", file=sys.stderr)


def print_table(title: str, lines: Mapping[str, str]) -> None:
    """Print names and what they are, in two columns."""
    print(f"{title}:")
    width = max((len(name) for name in lines), default=0)
    for name, line in lines.items():
        print(f"  {name:<{width}}  {line}")


def print_examples() -> None:
    """Print the examples with the first line of each, those of the paper first, by its figures."""
    from mars2d.reports.paper.figures import FIGURES

    lines = {}
    for name, path in examples().items():
        first = path.read_text(encoding="utf-8").partition("\n")[0]
        lines[name] = first.strip('" ')
    paper = dict.fromkeys(run.experiment for figure in FIGURES for run in figure.runs)
    print_table("Experiments of the MARS paper", {k: lines.pop(k) for k in paper if k in lines})
    print_table("Other examples", lines)
