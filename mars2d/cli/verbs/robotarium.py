"""The verb ``robotarium``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import add_preferences, add_theory, preferences_of
from mars2d.cli.outputs import (
    OUTPUTS,
    add_pictures,
    check_outputs,
    check_snapshots,
    run_and_save,
    say,
    tell_files,
)
from mars2d.cli.runs import has_display
from mars2d.core.errors import counted, one_line
from mars2d.core.terminal import tell
from mars2d.record.record import Record


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the script, and the outputs of its run."""
    add = parser.add_argument
    add("script", type=Path, metavar="SCRIPT", help="a .py file that imports rps")
    add("--headless", action="store_true", help="without a window, even where there is a display")
    add("--record", type=Path, metavar="OUT", help="save all data: .npz, .mat, .csv, .nc, .mcap")
    add_pictures(parser)
    add_theory(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """Run a script written for the Robotarium's Python simulator, unchanged, and replay it."""
    from mars2d.world.robotarium.script import run_script

    check_outputs(arguments, OUTPUTS)
    check_snapshots(arguments)

    def run() -> tuple[Record, None]:
        return run_script(arguments.script), None

    record, made, troubles = run_and_save(arguments, run)
    steps, met = counted(len(record) - 1, "step"), counted(record.collisions, "collision")
    tell(f"{arguments.script.name}: {one_line(record.over_message)}. {steps}, {met}")
    tell_files(made)
    if troubles:
        say(troubles[:-1])
        raise troubles[-1]
    if has_display() and not arguments.headless:
        from mars2d.window.show import show_record

        show_record(record, 1.0, preferences_of(arguments))
