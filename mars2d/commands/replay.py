"""The verb ``replay``."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from mars2d.commands.base import (
    add_preferences,
    add_speed,
    add_theory,
    has_display,
    preferences_of,
)
from mars2d.errors import InputError
from mars2d.record import load

NAME = "replay"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("record", type=Path, metavar="RECORD", help="a saved run, .npz")
    add_speed(parser)
    add_theory(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """Play a recorded run in the window."""
    record = load(arguments.record)
    if not has_display():
        from mars2d.view.display import NO_DISPLAY

        raise InputError(NO_DISPLAY.replace("run it", "run the experiment"))
    from mars2d.view.show import show_record

    if arguments.theory:
        animation = record.scenario.animation.replace(theory=True)
        record = replace(record, scenario=record.scenario.replace(animation=animation))
    speed = arguments.speed
    pace = record.scenario.animation.playback_speed if speed is None else speed
    show_record(record, pace, preferences_of(arguments))
