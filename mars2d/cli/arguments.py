"""Arguments that several verbs share, and their values."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError
from mars2d.output.films.film import size_of
from mars2d.output.raster import has_pygame
from mars2d.scenario.animation import playback_speed
from mars2d.scenario.options import parse_option
from mars2d.window.screen.display import Preferences


def value(read: Callable[[str], Any], expected: str) -> Callable[[str], Any]:
    """Return the type of an argument; read: raises ValueError for a text that is not expected."""

    def typed(text: str) -> Any:
        try:
            return read(text)
        except ValueError as error:
            raise argparse.ArgumentTypeError(f"{text!r}: expected {expected}") from error

    return typed


def _speed(text: str) -> float | str:
    return text if text == "max" else playback_speed("--speed", float(text))


def _times(text: str) -> list[float | str]:
    items = [item.strip() for item in text.split(",")]
    return [item if item == "end" else float(item) for item in items]


def _many(**action: Any) -> dict[str, Any]:
    return {"action": "append", "default": [], **action}


SHARED: dict[str, dict[str, Any]] = {
    "experiment": {"help": "a .py or .toml file, or the name of an example"},
    "record": {"type": Path, "help": "a saved run: .npz, .csv, .mcap"},
    "--headless": {"action": "store_true", "help": "run without a window"},
    "--seed": {"type": int, "default": 0, "metavar": "N", "help": "of all random streams"},
    "--speed": {
        "type": value(_speed, "a number >= 0, or max"),
        "metavar": "X",
        "help": "of window or film: 1 is real time, 0 is one step per key press, max",
    },
    "--stop-time": {"type": float, "metavar": "S", "help": "seconds to simulate"},
    "--set": _many(metavar="KEY=VALUE", help="override a field"),
    "--figure": {"type": Path, "metavar": "OUT", "help": "draw a picture: .png, .pdf, .svg"},
    "--at": {
        "type": value(_times, "times, such as 1,30,end"),
        "metavar": "T1,T2,...",
        "help": "draw snapshots at these times",
    },
    "--video": {"type": Path, "metavar": "OUT", "help": "make a film: .gif, .mp4"},
    "--size": {
        "type": value(size_of, "width and height in pixels, such as 1280x720"),
        "metavar": "WxH",
        "help": "of the film, pixels (default: 1280x720)",
    },
    "--from": {"type": float, "dest": "start", "metavar": "S", "help": "start at this time"},
    "--to": {"type": float, "dest": "end", "metavar": "S", "help": "end at this time"},
    "--html": {
        "type": Path,
        "metavar": "OUT.html",
        "help": "a replay for any browser, in one file",
    },
    "--theory": {"action": "store_true", "help": "draw what theory predicts"},
    "--dark": {"action": argparse.BooleanOptionalAction, "help": "a dark window, or a light one"},
    "--text": {
        "type": value(lambda text: Preferences(text=float(text)).text, "a number from 0.5 to 4"),
        "metavar": "X",
        "help": "the window's text X times as large",
    },
    "--workers": {"type": int, "metavar": "N", "help": "processes; by default one per core"},
    "--cluster": {"metavar": "ADDRESS", "help": "a Dask scheduler, such as tcp://10.0.0.5:8786"},
    "--json": {"action": "store_true", "help": "print the outcome as one line of JSON"},
}
"""The arguments by name."""


def add_shared(parser: argparse.ArgumentParser, names: str) -> None:
    """Add shared arguments to a verb; names: with spaces between them, options without hyphens."""
    for name in names.split():
        if name in SHARED:
            parser.add_argument(name, metavar=name.upper(), **SHARED[name])
        else:
            parser.add_argument(f"--{name}", **SHARED[f"--{name}"])


def add_preferences(parser: argparse.ArgumentParser) -> None:
    """Add the looks of the window."""
    add_shared(parser, "dark text")


def add_workers(parser: argparse.ArgumentParser) -> None:
    """Add the number of processes on this machine, or the cluster, for many runs."""
    add_shared(parser, "workers cluster")


def options_of(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the options of --set, --stop-time and --theory, by the names of fields."""
    options = dict(map(parse_option, arguments.set))
    if getattr(arguments, "stop_time", None) is not None:
        options["stop_time"] = arguments.stop_time
    return options | ({"animation.theory": True} if getattr(arguments, "theory", False) else {})


def preferences_of(arguments: argparse.Namespace) -> Preferences:
    """Return the looks that --dark and --text ask for, else those of the last window."""
    if not has_pygame():
        return Preferences()
    from mars2d.window.screen.memory import Memory

    return Memory().preferences(dark=arguments.dark, text=arguments.text)


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
    with cluster(arguments.cluster) as executor:
        yield executor, None
