"""The verb ``demo``: ``run`` for an example, with pictures where there is no window."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import option, shared
from mars2d.cli.outputs import picture_and_film
from mars2d.cli.runs import print_examples
from mars2d.core.terminal import tell
from mars2d.scenario.experiment import open_experiment
from mars2d.window.screen.display import display_available

FOLDER = Path("mars2d_demo")

ARGUMENTS = {
    "name": option("NAME", "an example (default: list all)", nargs="?"),
    **shared("headless seed theory dark text"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Run an example; without a display, make a picture and a short film. Without a name, list all.

    It is mars2d run, which has further options.
    """
    name = arguments.name
    if name is None:
        print_examples()
        tell("\nPlay one:  mars2d demo random_walk")
        return
    from mars2d.cli.command_line import parse

    run = parse(["run", name])
    asked = argparse.Namespace(**vars(run) | vars(arguments))
    if asked.headless or not display_available():
        picture_and_film(asked, FOLDER, open_experiment(name).scenario.stop_time)
        asked.headless, asked.size = True, (640, 480)
    run.execute(asked)
