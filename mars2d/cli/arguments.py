"""Arguments that several verbs share, and their values."""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mars2d.core.errors import InputError
from mars2d.core.files import why_unwritable
from mars2d.output import formats
from mars2d.output.figures import figure
from mars2d.output.films import film
from mars2d.output.films.mp4 import require_av
from mars2d.output.raster import has_pygame, require_pygame
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


def option(metavar: str | None, about: str, kind: Any = None, **more: Any) -> dict[str, Any]:
    """Return what argparse is told of an argument; metavar: None for a switch."""
    if metavar is None:
        return {"action": "store_true", "help": about, **more}
    return {"metavar": metavar, "help": about, "type": kind, **more}


OUTPUTS = {
    "record": tuple(formats.FORMATS),
    "figure": figure.SUFFIXES,
    "video": tuple(film.ENCODERS),
    "html": (".html", ".htm"),
    "out": (".csv",),
}
"""The arguments that name output files, with their possible suffixes."""


class Output(argparse.Action):
    """An argument that names a file to be made, of the kind that the argument's name says."""

    def __call__(self, _: Any, namespace: Any, path: Any, name: str | None = None) -> None:
        """Keep the path; raise InputError, before anything runs, where it can't be written."""
        suffixes, why, folder = OUTPUTS[self.dest], why_unwritable(path), path.parent
        if path.suffix.lower() not in suffixes:
            why = f"expected a name that ends in {' or '.join(suffixes)}"
        elif not folder.is_dir():
            why = f"there is no folder {folder}"
        elif not os.access(folder, os.W_OK):
            why = f"nothing can be written in {folder.absolute()}"
        if why:
            raise InputError(f"{name} {path}: {why}")
        if self.dest == "video":
            require_pygame("a film")
            if path.suffix.lower() == ".mp4":
                require_av(path)
        if self.dest == "record":
            formats.require(path)
        setattr(namespace, self.dest, path)


MANY: dict[str, Any] = {"action": "append", "default": []}
"""What argparse is told of an option that may be given several times."""

_TEXT = value(lambda text: Preferences(text=float(text)).text, "a number from 0.5 to 4")
_LOOKS = {"action": argparse.BooleanOptionalAction, "help": "a dark window, or a light one"}
_SIZE = value(film.size_of, "width and height in pixels, such as 1280x720")
_FACTOR = value(_speed, "a number >= 0, or max")
_PACE = "of window or film: 1 is real time, 0 is one step per key press, max"
_MOMENTS = value(_times, "times, such as 1,30,end")

SHARED: dict[str, dict[str, Any]] = {
    "experiment": option("EXPERIMENT", "a .py or .toml file, or the name of an example"),
    "record": option("RECORD", "a saved run: .npz, .csv, .mcap", Path),
    "--headless": option(None, "run without a window"),
    "--seed": option("N", "of all random streams", int, default=0),
    "--speed": option("X", _PACE, _FACTOR),
    "--stop-time": option("S", "seconds to simulate", float),
    "--set": option("KEY=VALUE", "override a field", **MANY),
    "--figure": option("OUT", "draw a picture: .png, .pdf, .svg", Path, action=Output),
    "--at": option("T1,T2,...", "draw snapshots at these times", _MOMENTS),
    "--video": option("OUT", "make a film: .gif, .mp4", Path, action=Output),
    "--size": option("WxH", "of the film, pixels (default: 1280x720)", _SIZE),
    "--from": option("S", "start at this time", float, dest="start"),
    "--to": option("S", "end at this time", float, dest="end"),
    "--html": option("OUT.html", "a replay for any browser, in one file", Path, action=Output),
    "--theory": option(None, "draw what theory predicts"),
    "--dark": _LOOKS,
    "--text": option("X", "the window's text X times as large", _TEXT),
    "--workers": option("N", "processes; by default one per core", int),
    "--json": option(None, "print the outcome as one line of JSON"),
}
"""The arguments that several verbs have, by name."""

WHERE = {"from": "start", "to": "end", "for": "game"}
"""Where the value of an argument is, if its name is a word of Python's or says too little."""


def shared(names: str) -> dict[str, dict[str, Any]]:
    """Return shared arguments; names: with spaces between them, without hyphens."""
    keys = (name if name in SHARED else f"--{name}" for name in names.split())
    return {key: SHARED[key] for key in keys}


def refuse(arguments: argparse.Namespace, names: str, why: str) -> None:
    """Raise InputError for the first of some options that is given; names: as of `shared`."""
    for name in names.split():
        if vars(arguments)[WHERE.get(name, name.replace("-", "_"))] not in (None, False, []):
            raise InputError(f"--{name} {why}")


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
