"""Trials: runs of a part in a small world or a scenario, which can be compared."""

from __future__ import annotations

import pickle
import random
import re
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mars2d.addons import Addon, Beacon, Floor, Map
from mars2d.bodies.props.rectangles import Box
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, Late
from mars2d.core.hints import described
from mars2d.core.usercode import users_line
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.world.world import World

STEPS = 50
"""Control steps of a trial."""

MAX_RUN_TIME = 1.0
"""Seconds after which a slow run ends early."""

ControlLaw = Callable[[Any], Any]

Placed = tuple[Scenario, ControlLaw | None]
"""A scenario, and the law of its team."""


def wander(robot: Any) -> tuple[float, ...]:
    """Wander at random: the law of robots that carry what is tried."""
    turn = robot.rng.uniform(-1.5, 1.5)
    return (0.3, turn, 0.1, 0.1)[: len(robot.drive.inputs)]


def small_world(
    sensors: Sequence[Sensor] = (),
    addons: Sequence[Addon] = (),
    law: ControlLaw | None = wander,
    sees: str = "full",
    *,
    sampling_time: float = 0.1,
    x: float = 0.0,
) -> Scenario:
    """Return a room with three robots, a wall in the middle, an obstacle, a box and a beacon.

    sensors, law, sees: of all robots; without a law, the team has one. x: of the room's centre,
    metres; what stands in it stays about the origin.
    """
    robot = Robot(sensors=sensors, controller=law, sees=sees)
    poses = (x - 1.5, 0.2, 0.1), (x + 0.7, -0.6, 2.0), (x + 1.4, 1.2, -2.3)
    furniture = (
        Map(
            [[(-0.2, -1.9), (-0.2, -0.7)], [(1.6, -1.4), (2.1, -1.4), (1.9, -0.9)]],
            name="trial_walls",
        ),
        Beacon(at=(0.3, 1.5), name="trial_lamp"),
        Floor(patches=[([(0, -3), (3, -3), (3, 3), (0, 3)], "gray")], name="trial_floor"),
    )
    return Scenario(
        title="A trial",
        robots=[robot.at(*pose) for pose in poses],
        props=[Box(pose=(x - 0.6, 1.0, 0.4))],
        workspace=[(x - 2.5, -2), (x - 2.5, 2), (x + 2.5, 2), (x + 2.5, -2)],
        on_exit="wall",
        sampling_time=sampling_time,
        stop_time=(STEPS - 1) * sampling_time,
        addons=[*furniture, *addons],
    )


def looker(hook: str, look: Callable[[World], None]) -> Addon:
    """Return an add-on with one hook, which calls a function of the world."""
    kind: type[Addon] = type("Looker", (Addon,), {hook: lambda _, world: look(world)})
    return kind(name="trial_looker")


@dataclass
class Run:
    """One run. rows: `state` after each control step. error: the one that ended the run."""

    rows: list[dict[str, bytes]] = field(default_factory=list)
    error: InputError | None = None


def run(
    name: str,
    place: Callable[[], Placed],
    deadline: Deadline,
    looks_on: Addon | None = None,
    *,
    noise: int = 1,
    beside: bool = False,
) -> Run:
    """Run a scenario, which `place` returns with its team's law, once.

    name: of what is tried. deadline: of each control step. looks_on: an add-on beside those of the
    scenario. noise: the seed of Python's and numpy's shared generators, which must not matter.
    beside: whether a second world, of another seed, takes its steps in turn.
    """
    made, start = Run(), time.monotonic()
    worlds: list[World] = []
    with _shared_generators(noise):
        try:
            deadline.alive()
            for seed in (1, 2) if beside else (1,):
                scenario, control = place()
                addons = [*scenario.addons, looks_on] if looks_on else scenario.addons
                worlds.append(World(scenario.replace(addons=addons), control, seed))
            for _ in range(STEPS):
                if worlds[0].over or time.monotonic() - start > MAX_RUN_TIME:
                    break
                for world in worlds:
                    deadline.alive()
                    if not world.over:
                        world.step()
                made.rows.append(state(worlds[0]))
        except Late:
            made.error = InputError(
                f"{name} did not come to an end within {deadline.patience:g} s, and was broken "
                "off. Is there a loop that never ends? A law that waits yields at each step"
            )
            made.error.where = deadline.arrived() or None
        except InputError as error:
            made.error = error
        except Exception as error:  # whatever a user's object raises
            made.error = InputError(described(error))
            made.error.where = users_line(traceback.extract_tb(error.__traceback__))
    return made


def state(world: World) -> dict[str, bytes]:
    """Return the contents of a world by name, in causal order."""
    robots = world.robots
    found: dict[str, Any] = {
        f"add-on {key}.{attribute}": value
        for key, addon in vars(world.addons).items()
        if not key.startswith("trial_")
        for attribute, value in vars(addon).items()
    }
    for key, readings in world.frame.readings.items():
        found |= {f"sensor {key} of {robots[i].name}": value for i, value in readings}
    found |= {f"command {robot.name}": world.command[:, i] for i, robot in enumerate(robots)}
    for i, robot in enumerate(robots):
        found[f"pose {robot.name}"] = world.pose[:, i]
        found[f"the memory of {robot.name}"] = vars(robot.memory)
        found[f"the random stream of {robot.name}"] = robot.rng
    found["the random stream of the team's law"] = world.rng
    found["the poses of props"] = world.prop_pose
    found["whether the experiment is over"] = world.over
    return {name: contents(value) for name, value in found.items()}


def contents(value: Any) -> bytes:
    """Return bytes that are equal for equal contents."""
    try:
        return pickle.dumps(value)
    except Exception:  # whatever a user's object raises
        return re.sub(r" at 0x\w+", "", repr(value)).encode()


def difference(one: Run, other: Run) -> tuple[int, str] | None:
    """Return the first control step at which two runs differ, and in what, or None.

    An early end counts as far as it goes.
    """
    for step, (mine, its) in enumerate(zip(one.rows, other.rows, strict=False)):
        if mine != its:
            return step, next(name for name in mine | its if mine.get(name) != its.get(name))
    return None


@contextmanager
def _shared_generators(seed: int) -> Iterator[None]:
    """Seed Python's and numpy's shared generators, and restore their states afterwards."""
    before = random.getstate(), np.random.get_state()  # noqa: NPY002 - it is what laws misuse
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        random.setstate(before[0])
        np.random.set_state(before[1])  # noqa: NPY002
