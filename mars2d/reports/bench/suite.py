"""The suite: scenes and starts, each timed in turns with the yardstick."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import NamedTuple

from mars2d.record.record import Record
from mars2d.reports.bench import start
from mars2d.reports.bench.overlap import deepest
from mars2d.reports.bench.report import Figures, Row
from mars2d.reports.bench.scenes import SCENES, Scene
from mars2d.reports.bench.worlds import SETTINGS, world_of
from mars2d.reports.bench.yardstick import Bare
from mars2d.world.world import World

__all__ = ["FULL", "NAMES", "QUICK", "STEPS", "Effort", "Job", "jobs", "warmed_up"]

START = "start"
"""The name of the part that times starts."""

NAMES = (*SCENES, START)
"""The parts of the suite."""

YARDSTICK = "S2"
"""The scene of the bare loop by which all is measured."""

STEPS = {"S1": 600, "S2": 150, "S3": 40, "S4": 15}
"""Control steps in a round of each scene."""

WARM_UP = 5.0
"""For how long robots move and meet before the first round, simulated seconds."""

LEAST = 2
"""Rounds, on however slow a machine."""


class Effort(NamedTuple):
    """How much is done for a row.

    rounds: where they take no longer than `time` [s], else fewer. yardstick: control steps of the
    bare loop in each.
    """

    rounds: int
    time: float
    yardstick: int


Job = Callable[[Effort], Row]

FULL = Effort(rounds=15, time=8.0, yardstick=500)
QUICK = Effort(rounds=5, time=0.5, yardstick=200)


def jobs(names: Iterable[str]) -> dict[str, Job]:
    """Return what measures each row of these parts of the suite, by the rows' names."""
    found: dict[str, Job] = {}
    for name in names:
        if name == START:
            found |= {command: partial(_start, command) for command in start.COMMANDS}
        else:
            scene = SCENES[name]()
            for setting in SETTINGS:
                found[f"{name} {setting}"] = partial(_scene, scene, setting)
    return found


def _scene(scene: Scene, setting: str, effort: Effort) -> Row:
    """Time a scene at one setting, and look how deep its robots got into each other."""
    max_overlap, steps = SETTINGS[setting], STEPS[scene.name]
    world = warmed_up(scene, max_overlap)

    def timed() -> float:
        nonlocal world
        if scene.proximity:  # Algorithm 2 may back into a corner, and then stays there
            world = warmed_up(scene, max_overlap)
        return _time(world.step, steps) / steps

    rounds = _rounds(timed, effort)
    record = world.record
    size = _size(record) / record.effort.size
    figures = Figures(scene.sampling_time, max_overlap, deepest(scene, record.pose), size)
    return Row(f"{scene.name} {setting}", scene.title, rounds, figures)


def warmed_up(scene: Scene, max_overlap: float) -> World:
    """Return a world of a scene whose robots have moved and met."""
    world = world_of(scene, max_overlap)
    _time(world.step, round(WARM_UP / scene.sampling_time))
    return world


def _start(name: str, effort: Effort) -> Row:
    """Time a command in new processes."""
    arguments = start.COMMANDS[name]
    with start.with_bytecode() as environment:
        start.seconds(arguments, environment)  # which compiles, and fills the disk's cache
        rounds = _rounds(lambda: start.seconds(arguments, environment), effort)
    return Row(name, "from shell to shell", rounds)


def _rounds(timed: Callable[[], float], effort: Effort) -> tuple[tuple[float, float], ...]:
    """Time something in turns with the bare loop: (seconds of its control step, seconds) a round.

    The bare loop is timed before and after, since how busy a machine is changes.
    """
    bare = Bare(SCENES[YARDSTICK]())
    steps = effort.yardstick
    _time(bare, steps)
    rounds: list[tuple[float, float]] = []
    before, end = _time(bare, steps), time.perf_counter() + effort.time
    while len(rounds) < LEAST or (len(rounds) < effort.rounds and time.perf_counter() < end):
        taken = timed()
        after = _time(bare, steps)
        rounds.append(((before + after) / 2 / steps, taken))
        before = after
    return tuple(rounds)


def _time(step: Callable[[], None], steps: int) -> float:
    """Return how long so many calls take, seconds."""
    began = time.perf_counter()
    for _ in range(steps):
        step()
    return time.perf_counter() - began


def _size(record: Record) -> int:
    """Return how many bytes a record's numbers take."""
    columns = (record.time, record.command_time, record.pose, record.command, record.effort)
    others = (record.prop_pose, record.contacts, *record.sensors.values())
    return sum(values.nbytes for values in columns + others)
