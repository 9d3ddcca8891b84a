"""The verb ``replay``."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from mars2d.cli.arguments import add_preferences, add_speed, add_theory, preferences_of
from mars2d.cli.films import add_film, check_film, save_film_of
from mars2d.cli.outputs import OUTPUTS, add_html, check_outputs
from mars2d.cli.runs import has_display
from mars2d.core.errors import InputError
from mars2d.core.terminal import tell
from mars2d.output.formats import SUFFIXES
from mars2d.output.raster import require_pygame
from mars2d.world.record import Record, load

NO_DISPLAY = (
    "there is no display for a window; make a film with --video OUT.gif, a page for any browser "
    "with --html OUT.html, or a figure with mars2d plot"
)

OUTPUTS_WITHOUT_WINDOW = ("video", "html")
"""The outputs that replace the window."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "record", type=Path, metavar="RECORD", help=f"a saved run: {', '.join(SUFFIXES)}"
    )
    add_speed(parser)
    add_theory(parser)
    add_film(parser)
    add_html(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """Play a recorded run in the window, or make a film or a page of it."""
    check_outputs(arguments, {name: OUTPUTS[name] for name in OUTPUTS_WITHOUT_WINDOW})
    record = load(arguments.record)
    if arguments.theory:
        animation = record.scenario.animation.replace(theory=True)
        record = replace(record, scenario=record.scenario.replace(animation=animation))
    last = float(record.time[-1]) if len(record) else 0.0
    check_film(arguments, record.scenario, last)
    if arguments.video is not None:
        tell(f"film: {save_film_of(record, arguments)}")
    if arguments.html is not None:
        tell(f"page: {record.save_html(arguments.html)}")
    if arguments.video is None and arguments.html is None:
        _play(record, arguments)


def _play(record: Record, arguments: argparse.Namespace) -> None:
    if not has_display():
        require_pygame("a window")
        raise InputError(NO_DISPLAY)
    from mars2d.window.show import show_record

    speed = arguments.speed
    pace = record.scenario.animation.playback_speed if speed is None else speed
    show_record(record, pace, preferences_of(arguments))
