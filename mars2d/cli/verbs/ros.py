"""The verb ``ros``."""

from __future__ import annotations

import argparse

from mars2d.cli.arguments import add_options, options_of
from mars2d.core.errors import InputError
from mars2d.core.streams import check_seed
from mars2d.core.terminal import tell
from mars2d.scenario.experiment import open_experiment
from mars2d.world.world import World


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the experiment, and the speed."""
    add = parser.add_argument
    add("experiment", metavar="EXPERIMENT", help="a .py or .toml file, or the name of an example")
    add_options(parser)
    add("--seed", type=int, default=0, metavar="N", help="the seed of all random streams")
    add("--speed", type=float, default=1.0, metavar="X", help="simulated seconds per second")


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment as a node of ROS 2: clock, frames, odometry, scans; it takes cmd_vel."""
    from mars2d.world.ros.bridge import Bridge

    if not 0 < arguments.speed < 1e6:
        raise InputError(f"--speed {arguments.speed:g}: expected a number above 0")
    seed = check_seed(arguments.seed)
    experiment = open_experiment(arguments.experiment, options_of(arguments), seed=seed)
    world = World(experiment.scenario, experiment.control, seed, filename=experiment.filename)
    Bridge(world, arguments.speed).run()
    tell(world.over_message)
