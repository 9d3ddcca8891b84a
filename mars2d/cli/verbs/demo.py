"""The verb ``demo``."""

from __future__ import annotations

import argparse
from pathlib import Path

from mars2d.cli.arguments import (
    add_preferences,
    add_run_arguments,
    add_theory,
    preferences_of,
    theory_of,
)
from mars2d.cli.films import DURATION, FPS, save_footage
from mars2d.cli.runs import (
    has_display,
    make_folder,
    print_examples,
    print_predictions,
    run_headless,
    show,
    warn_unchecked,
)
from mars2d.core.errors import InputError, likely, one_line
from mars2d.core.terminal import tell
from mars2d.output.raster import require_pygame
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import LISTED, Experiment, open_experiment
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record

FOLDER = Path("mars2d_demo")
FILM_SIZE = (640, 480)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("name", nargs="?", metavar="NAME", help="an example (default: list all)")
    add_run_arguments(parser)
    add_theory(parser)
    add_preferences(parser)


def execute(arguments: argparse.Namespace) -> None:
    """List the examples, or play one."""
    name = arguments.name
    if name is None:
        print_examples()
        tell("\nPlay one:  mars2d demo random_walk")
        return
    known = examples()
    if name not in known:
        raise InputError(f"{name}: there is no such example{likely(name, known) or LISTED}")
    experiment = open_experiment(known[name], theory_of(arguments), seed=arguments.seed)
    look = preferences_of(arguments)
    try:
        if not arguments.headless and has_display():
            record = show(experiment, None, look)
        else:
            record = _make_pictures(experiment, name)
    except Interrupted:
        warn_unchecked(experiment, "cut short")
        raise
    print_predictions(experiment, record)


def _make_pictures(experiment: Experiment, name: str) -> Record:
    """Run, make a picture and a short film, and print their paths."""
    require_pygame("a film")
    from mars2d.output.figures.figure import save_figure
    from mars2d.output.films.footage import Footage

    make_folder(FOLDER)
    footage = Footage(experiment.scenario, experiment.scenario.stop_time / DURATION, FPS)
    world = run_headless(experiment, [footage])
    record = world.record
    tell(f"{record.scenario.title}: {one_line(record.over_message)}")
    tell(f"picture: {save_figure(record, FOLDER / f'{name}.png')}")
    film = FOLDER / f"{name}.gif"
    save_footage(footage, world.frame, film, FILM_SIZE)
    tell(f"film:    {film}")
    return record
