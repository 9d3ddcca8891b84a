"""The verb ``demo``: ``run`` for an example, with pictures where there is no window."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import add_shared
from mars2d.cli.outputs import DURATION
from mars2d.cli.runs import has_display, make_folder, print_examples
from mars2d.cli.verbs import run
from mars2d.core.terminal import tell
from mars2d.output.raster import require_pygame
from mars2d.scenario.experiment import open_experiment

FOLDER = Path("mars2d_demo")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the example, and some of the arguments of ``run``."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="an example (default: list all)")
    add_shared(parser, "headless seed theory dark text")


def execute(arguments: argparse.Namespace) -> None:
    """Run an example; without a display, make a picture and a short film. Without a name, list all.

    It is mars2d run, which has further options.
    """
    name = arguments.name
    if name is None:
        print_examples()
        tell("\nPlay one:  mars2d demo random_walk")
        return
    of_run = argparse.ArgumentParser()
    run.add_arguments(of_run)
    asked = argparse.Namespace(**vars(of_run.parse_args([name])) | vars(arguments))
    if asked.headless or not has_display():
        require_pygame("a film")
        asked.speed = max(open_experiment(name).scenario.stop_time / DURATION, 1e-9)
        make_folder(FOLDER)
        files = [FOLDER / f"{Path(name).stem}{suffix}" for suffix in (".png", ".gif")]
        asked.headless, asked.size, (asked.figure, asked.video) = True, (640, 480), files
    run.execute(asked)
