"""Arguments that several verbs share: `add_...` adds them, `..._of` returns their values."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from typing import Any

from mars2d.cli.runs import has_display
from mars2d.core.errors import InputError
from mars2d.core.terminal import warn
from mars2d.output.raster import has_pygame, require_pygame
from mars2d.scenario.animation import playback_speed
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.options import parse_option
from mars2d.scenario.roles import robots_named
from mars2d.window.screen.display import Preferences


def add_run_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of all verbs that run an experiment."""
    parser.add_argument("--headless", action="store_true", help="run without a window")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of all random streams")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that change an experiment before it is run."""
    parser.add_argument("--stop-time", type=float, metavar="S", help="seconds to simulate")
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="override a field"
    )


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options that `add_options` asks for, by the names of fields."""
    options = dict(parse_option(setting) for setting in arguments.set)
    if arguments.stop_time is not None:
        options["stop_time"] = arguments.stop_time
    return options


def add_preferences(parser: argparse.ArgumentParser) -> None:
    """Add the looks of the window."""
    parser.add_argument(
        "--dark", action=argparse.BooleanOptionalAction, help="a dark window, or a light one"
    )
    parser.add_argument(
        "--text", type=_text, metavar="X", help="the window's text X times as large"
    )


def preferences_of(arguments: argparse.Namespace) -> Preferences:
    """Return the looks that `add_preferences` asks for, else those of the last window."""
    if not has_pygame():
        return Preferences()
    from mars2d.window.screen.memory import Memory

    return Memory().preferences(dark=arguments.dark, text=arguments.text)


def _text(text: str) -> float:
    try:
        return Preferences(text=float(text)).text
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number from 0.5 to 4") from error


def add_human(parser: argparse.ArgumentParser) -> None:
    """Add the choice of a robot to drive by hand."""
    parser.add_argument(
        "--human",
        action="append",
        default=[],
        metavar="WHO",
        help="a robot to drive by hand: its name or index, or a role; may be given twice",
    )


def humans_of(arguments: argparse.Namespace, experiment: Experiment) -> tuple[int, ...]:
    """Return the indices of the robots that `add_human` asks for."""
    robots = robots_named(experiment.scenario, arguments.human, "--human")
    if robots and (arguments.headless or not has_display()):
        require_pygame("a window")
        why = "not --headless" if arguments.headless else "and there is no display"
        who = ", ".join(arguments.human)
        raise InputError(f"--human {who}: driving by hand needs a window, {why}")
    return robots


def add_theory(parser: argparse.ArgumentParser) -> None:
    """Add the switch that shows theoretical predictions."""
    parser.add_argument("--theory", action="store_true", help="draw what theory predicts")


def theory_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options that `add_theory` asks for."""
    return {"animation.theory": True} if arguments.theory else {}


def add_speed(parser: argparse.ArgumentParser) -> None:
    """Add the speed of playback."""
    parser.add_argument(
        "--speed",
        type=_speed,
        metavar="X",
        help="of window or film: 1 is real time, 0 is one step per key press, max",
    )


def _speed(text: str) -> float | str:
    if text == "max":
        return text
    try:
        return playback_speed("--speed", float(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number >= 0, or max") from error


def times(text: str) -> list[float | str]:
    """Return the times [s] that an argument lists, separated by commas; the last may be "end"."""
    try:
        items = [item.strip() for item in text.split(",")]
        return [item if item == "end" else float(item) for item in items]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected times, such as 1,30,end") from None


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add the number of processes on this machine, or the cluster, for many runs."""
    parser.add_argument(
        "--workers", type=int, metavar="N", help="number of processes; by default one per core"
    )
    parser.add_argument(
        "--cluster", metavar="ADDRESS", help="a Dask scheduler, such as tcp://10.0.0.5:8786"
    )


@contextmanager
def workers_of(arguments: argparse.Namespace) -> Iterator[tuple[Executor | None, int | None]]:
    """Yield the executor and the number of workers that `add_workers` asks for."""
    from mars2d.study.cluster import cluster
    from mars2d.study.work import worker_count

    if arguments.workers is not None:
        worker_count(arguments.workers)
    if arguments.cluster is None:
        yield None, arguments.workers
        return
    if arguments.workers is not None:
        raise InputError(
            "--workers is of this machine: a cluster has its own; give it or --cluster"
        )
    with ExitStack() as stack:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            executor = stack.enter_context(cluster(arguments.cluster))
        for warning in caught:
            warn(warning.message)
        yield executor, None
