"""The verb ``new``."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path

from mars2d.cli.arguments import option
from mars2d.core.errors import InputError, shown
from mars2d.core.files import atomic_write
from mars2d.core.terminal import tell

TEMPLATE = '''\
"""{title}: two robots keep clear of the walls and of each other."""

import mars2d
from mars2d import Robot, Scenario
from mars2d.sensors import Proximity


def walk(robot):
    if robot.sense.proximity:
        return 0.0, 1.5  # something is ahead: turn on the spot, m/s and rad/s
    return 0.4, 0.1  # else go on, bending a little to the left


walker = Robot(sensors=[Proximity(range=0.5, field_of_view=2.0)], controller=walk, sees="sensors")

scenario = Scenario(
    title="{title}",
    robots=[walker.at(-3, 0, 0), walker.at(3, 1, 3.14)],
    on_exit="wall",
    stop_time=60,
)

if __name__ == "__main__":  # for the Run button of an editor
    mars2d.run(scenario, speed=1)
'''

ARGUMENTS = {"name": option("NAME", "the file to write, as walk or walk.py")}


def execute(arguments: argparse.Namespace) -> None:
    """Write a first experiment to change."""
    path = Path(arguments.name)
    if path.suffix == "":
        path = path.parent / f"{path.name}.py"
    stem = path.stem if path.name != ".py" else ""
    if path.suffix != ".py" or not stem.isidentifier() or stem == "mars2d":
        raise InputError(
            f"NAME = {shown(arguments.name)}: expected a name of letters, digits and underscores, "
            "as my_walk"
        )
    if path.exists():
        raise InputError(f"{path}: there is such a file already; choose another name")
    with atomic_write(path) as file:
        file.write(TEMPLATE.format(title=stem.replace("_", " ").capitalize()).encode())
    tell(f"{path}: written; run it: {shlex.join(['mars2d', 'run', str(path)])}")
