"""The verb ``plot``."""

from __future__ import annotations

import argparse
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

from mars2d.cli.arguments import option, refuse, shared, value
from mars2d.cli.outputs import conclude, produced
from mars2d.core.errors import InputError, nearest
from mars2d.output.figures import figure
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.scenario.examples import examples
from mars2d.world.record import Record, load

KINDS = ("paths", "snapshots", "signals", "energy", "momentum", "contacts", "distances")

OPTIONS = {
    "at": ("snapshots",),
    "layers": ("paths", "snapshots"),
    **dict.fromkeys(("columns", "robots", "from", "to"), ("signals",)),
}
"""The kinds of figures that have an option, by options that not all have."""


def _words(text: str) -> list[str]:
    words = [word.strip() for word in text.split(",")]
    if not all(words):
        raise ValueError(text)
    return words


_NAMES = value(_words, "names with commas between them")

ARGUMENTS = {
    **shared("record"),
    "kind": option("KIND", ", ".join(KINDS), nargs="?", default="paths"),
    "--columns": option("A,B,...", "signals: such as x,speed,effort", _NAMES),
    "--robots": option("A,B,...", "signals: of robots, by name or index", _NAMES),
    "--layers": option("A,B,...", "such as names,neighbours,no-grid", _NAMES),
    **shared("figure at from to"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Draw a recorded run: paths, snapshots, signals, energy, momentum, contacts or distances."""
    kind, path = arguments.kind, arguments.record
    if kind not in KINDS:
        raise InputError(f"there is no figure of {kind!r}{nearest(kind, KINDS)}")
    for name, kinds in OPTIONS.items():
        if kind not in kinds:
            other = f"mars2d plot {path} {kinds[0]}"
            refuse(arguments, name, f"is for {' and '.join(kinds)}: {other}")
    if kind == "snapshots" and arguments.at is None:
        raise InputError("snapshots need their times, such as --at 0,5,end")
    if path.suffix in (".py", ".toml") or (str(path) in examples() and not path.exists()):
        first = f"mars2d run {path} --record {path.stem}.npz"
        raise InputError(f"{path}: an experiment; run it first: {first}")
    record = load(path)
    layers = _layers(arguments.layers, record, paths=kind == "paths")
    names = (f"{path.stem}_{kind}{f'_{k}' if k > 1 else ''}.png" for k in count(1))
    free = (Path(name) for name in names if not Path(name).exists())
    arguments.figure = arguments.figure or next(free)
    drawing = partial(_drawing, arguments, record, layers)
    save = partial(figure.save_drawing, drawing, arguments.figure)
    conclude(*produced(arguments, {"figure": save}))


def _drawing(arguments: argparse.Namespace, record: Record, layers: Layers | None) -> Any:
    """Return the figure."""
    kind = arguments.kind
    if kind == "paths":
        return figure.plot_paths(record, layers=layers).figure
    if kind == "snapshots":
        return figure.plot_snapshots(record, arguments.at, layers=layers)
    if kind == "contacts":
        return record.plot_contacts()[0].figure
    if kind == "distances":
        return record.plot_distances().figure
    columns = {"energy": ("energy", "kinetic"), "momentum": ("momentum",)}
    return record.plot_signals(
        *columns.get(kind, arguments.columns or ()),
        robots=arguments.robots,
        start=arguments.start,
        end=arguments.end,
    )[0].figure


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
