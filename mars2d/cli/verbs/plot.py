"""The verb ``plot``."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import times
from mars2d.cli.outputs import check_outputs, naming_lost_letters
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell
from mars2d.output.figures import figure
from mars2d.output.figures.style import STYLES, style_of
from mars2d.output.formats import SUFFIXES
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.scenario.examples import examples
from mars2d.world.record import Record, load

KINDS = ("paths", "snapshots", "signals", "energy", "momentum", "contacts", "distances")

DRAWINGS = ("paths", "snapshots")
"""The kinds that show the plane, by layers."""

KIND_OF_OPTION = {"at": "snapshots"} | dict.fromkeys(("columns", "robots", "from", "to"), "signals")
"""Options that belong to one kind of figure."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("record", type=Path, metavar="RECORD", help=f"a saved run: {', '.join(SUFFIXES)}")
    add("kind", metavar="KIND", nargs="?", default="paths", help=f"{', '.join(KINDS)}")
    add("--figure", type=Path, metavar="OUT", help="the figure's file: .png, .pdf, .svg")
    add("--columns", type=_words, metavar="A,B,...", help="signals: such as x,speed,effort")
    add("--robots", type=_words, metavar="A,B,...", help="signals: of robots, by name or index")
    add("--from", type=float, metavar="S", help="signals: start at this time")
    add("--to", type=float, metavar="S", help="signals: end at this time")
    add("--at", type=times, metavar="T1,T2,...", help="snapshots: at these times")
    add("--layers", type=_words, metavar="A,B,...", help="such as names,neighbours,no-grid")
    add("--style", default="screen", metavar="STYLE", help=f"{', '.join(STYLES)}")


def _words(text: str) -> list[str]:
    words = [word.strip() for word in text.split(",")]
    if not all(words):
        raise argparse.ArgumentTypeError(f"{text!r}: expected names with commas between them")
    return words


def execute(arguments: argparse.Namespace) -> None:
    """Draw a recorded run: paths, snapshots, signals, energy, momentum, contacts or distances."""
    kind, path = arguments.kind, arguments.record
    if kind not in KINDS:
        raise InputError(f"there is no figure of {kind!r}{nearest(kind, KINDS)}")
    for option, only in KIND_OF_OPTION.items():
        if getattr(arguments, option) is not None and kind != only:
            raise InputError(f"--{option} is for {only}: mars2d plot {path} {only}")
    if arguments.layers is not None and kind not in DRAWINGS:
        raise InputError(f"--layers is for {' and '.join(DRAWINGS)}: mars2d plot {path} paths")
    if kind == "snapshots" and arguments.at is None:
        raise InputError("snapshots need their times, such as --at 0,5,end")
    look = style_of(arguments.style)
    check_outputs(arguments, {"figure": figure.SUFFIXES})
    _refuse_experiments(path)
    record = load(path)
    draw = _drawing(arguments, record)
    target = arguments.figure or _free(f"{path.stem}_{kind}")
    with naming_lost_letters():
        tell(figure.save_drawing(draw, target, trim=look.trim, dpi=look.dpi))


def _refuse_experiments(path: Path) -> None:
    """Raise InputError for an experiment, which has to be run first."""
    if path.suffix in (".py", ".toml") or (str(path) in examples() and not path.exists()):
        raise InputError(
            f"{path}: an experiment; run it first: mars2d run {path} --record {path.stem}.npz"
        )


def _drawing(arguments: argparse.Namespace, record: Record) -> Callable[[], Any]:
    """Return the function that makes the figure."""
    paths = arguments.kind == "paths"
    style, layers = arguments.style, _layers(arguments.layers, record, paths=paths)
    makers: dict[str, Callable[[], Any]] = {
        "paths": lambda: figure.plot_paths(record, style=style, layers=layers).figure,
        "snapshots": lambda: figure.plot_snapshots(
            record, arguments.at, style=style, layers=layers
        ),
        "signals": lambda: (
            record.plot_signals(
                *arguments.columns or (),
                robots=_robots(arguments.robots, record),
                start=getattr(arguments, "from"),
                end=arguments.to,
                style=style,
            )[0].figure
        ),
        "energy": lambda: record.plot_signals("energy", "kinetic", style=style)[0].figure,
        "momentum": lambda: record.plot_signals("momentum", style=style)[0].figure,
        "contacts": lambda: record.plot_contacts(style=style)[0].figure,
        "distances": lambda: record.plot_distances(style=style).figure,
    }
    return makers[arguments.kind]


def _layers(words: list[str] | None, record: Record, *, paths: bool) -> Layers | None:
    """Return the layers of a drawing with some switched; None for those that it has anyway.

    paths: whether it is a drawing of paths.
    """
    if words is None:
        return None
    known = [layer.name for layer in LAYERS if layer.switch]
    switches = {word.removeprefix("no-"): not word.startswith("no-") for word in words}
    for name in switches:
        if name not in known:
            raise InputError(f"--layers {name}: there is no such layer{nearest(name, known)}")
    return figure.layers_of(record.scenario, paths=paths).switched(**switches)


def _robots(words: list[str] | None, record: Record) -> list[str | int] | None:
    """Return robots by name, or by index if no robot has that name."""
    if words is None:
        return None
    names = {robot.name for robot in record.scenario.robots}
    return [int(w) if w.isdecimal() and w not in names else w for w in words]


def _free(stem: str) -> Path:
    """Return the name of a new file in the current folder."""
    names = (Path(f"{stem}_{k}.png" if k > 1 else f"{stem}.png") for k in count(1))
    return next(path for path in names if not path.exists())
