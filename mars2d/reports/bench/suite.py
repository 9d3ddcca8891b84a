"""The suite: scenes and starts, each timed in turns with the yardstick."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from mars2d.reports.bench.report import Figures, Row
from mars2d.reports.bench.scenes import SCENES, Scene
from mars2d.reports.bench.worlds import SETTINGS, deepest, world_of
from mars2d.reports.bench.yardstick import Bare
from mars2d.world.record import Record
from mars2d.world.world import World

START = "start"
"""The name of the part that times starts."""

NAMES = (*SCENES, START)
"""The parts of the suite."""

COMMANDS: dict[str, Sequence[str]] = {
    "import mars2d": ("-c", "import mars2d"),
    "mars2d run random_walk --headless": ("-m", "mars2d", "run", "random_walk", "--headless"),
}
"""The starts that are timed, as arguments of Python."""

YARDSTICK = "S2"
"""The scene of the bare loop that all rows are compared with."""

STEPS = {"S1": 600, "S2": 150, "S3": 40, "S4": 15, "P1": 40, "P2": 40, "P3": 40}
"""Control steps in a round of each scene."""

WARM_UP = 5.0
"""The simulated time before the first round, in which robots move and meet, seconds."""

MIN_ROUNDS = 2
"""The number of rounds on a very slow machine."""


class Effort(NamedTuple):
    """The amount of work for a row.

    rounds: their number, or fewer if they take longer than `time` [s]. yardstick: the number of
    control steps of the bare loop in each.
    """

    rounds: int
    time: float
    yardstick: int


Job = Callable[[Effort], Row]

FULL = Effort(rounds=15, time=8.0, yardstick=500)
QUICK = Effort(rounds=5, time=0.5, yardstick=200)


def jobs(names: Iterable[str]) -> dict[str, Job]:
    """Return the jobs that measure these parts of the suite, by the names of their rows."""
    found: dict[str, Job] = {}
    for name in names:
        if name == START:
            found |= {command: partial(_start, command) for command in COMMANDS}
        else:
            scene = SCENES[name]()
            for setting in SETTINGS:
                found[f"{name} {setting}"] = partial(_scene, scene, setting)
    return found


def _scene(scene: Scene, setting: str, effort: Effort) -> Row:
    """Time a scene at one setting, and measure the overlaps of its bodies."""
    max_overlap, steps = SETTINGS[setting], STEPS[scene.name]
    world = warmed_up(scene, max_overlap)

    def timed() -> float:
        nonlocal world
        if scene.proximity:  # Algorithm 2 may back into a corner and stay there
            world = warmed_up(scene, max_overlap)
        return _time(world.step, steps) / steps

    rounds = _rounds(timed, effort)
    record = world.record
    size = _size(record) / record.effort.size
    poses = np.concatenate([record.pose, record.prop_pose], axis=2)
    figures = Figures(scene.sampling_time, max_overlap, deepest(scene, poses), size)
    return Row(f"{scene.name} {setting}", scene.title, rounds, figures)


def warmed_up(scene: Scene, max_overlap: float) -> World:
    """Return a world of a scene whose robots have moved and met."""
    world = world_of(scene, max_overlap)
    _time(world.step, round(WARM_UP / scene.sampling_time))
    return world


def _start(name: str, effort: Effort) -> Row:
    """Time a command in new processes."""
    arguments = COMMANDS[name]
    with with_bytecode() as environment:
        seconds(arguments, environment)  # compiles the modules, and fills the disk's cache
        rounds = _rounds(lambda: seconds(arguments, environment), effort)
    return Row(name, "from shell to shell", rounds)


@contextmanager
def with_bytecode() -> Iterator[dict[str, str]]:
    """Yield an environment in which modules are compiled once, as `pip install` compiles them.

    The compiled modules are kept in a temporary folder, not in the folders of packages.
    """
    with TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        yield environment | {"PYTHONPYCACHEPREFIX": folder}


def seconds(arguments: Sequence[str], environment: dict[str, str]) -> float:
    """Return the time that Python takes with these arguments, from its start to its end [s].

    Raises CalledProcessError if it fails.
    """
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments],
        check=True, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    return time.perf_counter() - start


def _rounds(timed: Callable[[], float], effort: Effort) -> tuple[tuple[float, float], ...]:
    """Return times in turns with the bare loop: for each round (its control step, `timed`) [s].

    The bare loop is timed before and after each round, since the load of a machine changes.
    """
    bare = Bare(SCENES[YARDSTICK]())
    steps = effort.yardstick
    _time(bare, steps)
    rounds: list[tuple[float, float]] = []
    before, end = _time(bare, steps), time.perf_counter() + effort.time
    while len(rounds) < MIN_ROUNDS or (len(rounds) < effort.rounds and time.perf_counter() < end):
        taken = timed()
        after = _time(bare, steps)
        rounds.append(((before + after) / 2 / steps, taken))
        before = after
    return tuple(rounds)


def _time(step: Callable[[], None], steps: int) -> float:
    """Return the time that a number of calls takes, seconds."""
    began = time.perf_counter()
    for _ in range(steps):
        step()
    return time.perf_counter() - began


def _size(record: Record) -> int:
    """Return the size of a record's numbers, bytes."""
    columns = (record.time, record.command_time, record.pose, record.command, record.effort)
    others = (record.prop_pose, record.contacts, *record.sensors.values())
    return sum(values.nbytes for values in columns + others)
