"""The verb ``play``."""

from __future__ import annotations

import argparse

from mars2d.cli.arguments import MANY, option, options_of, preferences_of, shared
from mars2d.cli.runs import print_table, require_display
from mars2d.core.errors import InputError
from mars2d.core.terminal import tell
from mars2d.scenario.examples import games, title_of
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.roles import contests_of, robots_named
from mars2d.window import show

MOST_NAMES = 5
"""How many robots a message names."""

ARGUMENTS = {
    "game": option("GAME", "an example or a file (default: list the games)", nargs="?"),
    "--role": option(
        "ROLE", "the role to play; for two people twice; without it, the window asks", **MANY
    ),
    **shared("seed speed stop-time set theory dark text"),
}


def execute(arguments: argparse.Namespace) -> None:
    """Play a game against a law or another person; without a game, list all."""
    if arguments.game is None:
        print_table("Games", {name: title_of(name)[1] for name in games()})
        tell(f"\nPlay one:  mars2d play {games()[0]}")
        return
    experiment = open_experiment(arguments.game, options_of(arguments), seed=arguments.seed)
    people = _people(arguments, experiment)
    require_display(f"play {arguments.game}: people need a window, and there is no display")
    speed = 1.0 if arguments.speed is None else arguments.speed
    look = preferences_of(arguments)
    show.show_experiment(experiment, speed, preferences=look, humans=people, play=True)


def _people(arguments: argparse.Namespace, experiment: Experiment) -> tuple[int, ...]:
    """Return the robots, by index, that people play, each by a role or a robot.

    Raises InputError where nobody wins and none is named.
    """
    scenario, game = experiment.scenario, arguments.game
    wanted = [part.strip() for text in arguments.role for part in text.split(",")]
    if not wanted and not contests_of(scenario):
        names = [str(robot.name) for robot in scenario.robots]
        shown = ", ".join(names[:MOST_NAMES]) + (", ..." if len(names) > MOST_NAMES else "")
        raise InputError(
            f"{game}: it has no roles, as no add-on says who has won: name the robot to drive, "
            f"--role ROBOT; there are {shown}"
        )
    return robots_named(scenario, wanted, "--role")
