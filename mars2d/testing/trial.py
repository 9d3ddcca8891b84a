"""Trials: runs of a part in a small world or a scenario, which can be compared."""

from __future__ import annotations

import pickle
import random
import re
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import pi
from typing import Any

import numpy as np

from mars2d.addons.base import Addon
from mars2d.bodies.props.box import Box
from mars2d.core.deadline import Deadline
from mars2d.core.errors import InputError, Late
from mars2d.core.hints import described
from mars2d.core.plane import Outline, Point
from mars2d.core.scene import Scene
from mars2d.core.usercode import stack_of, users_line
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.world.world import World

STEPS = 50
"""Control steps of a trial."""

MIN_STEPS = 5

MAX_RUN_TIME = 1.0
"""Seconds after which a slow run ends early, but not before `MIN_STEPS` steps."""

OVER = "whether the experiment is over"


def small_world(
    sensors: Sequence[Sensor] = (),
    addons: Sequence[Addon] = (),
    controller: Callable[[Any], Any] | None = None,
    sees: str = "full",
    sampling_time: float = 0.1,
) -> Scenario:
    """Return a room with three robots, a wall in the middle, an obstacle, a box and a beacon.

    sensors: those of the first two robots, and of the third if a law is given. controller: the law
    of all robots; by default the first two wander, and the law of the team drives the third.
    """
    carrier = Robot(sensors=sensors, controller=controller or bystander, sees=sees)
    third = carrier if controller else Robot()
    return Scenario(
        title="A trial",
        robots=[carrier.at(-1.5, 0.2, 0.1), carrier.at(0.7, -0.6, 2.0), third.at(1.4, 1.2, -2.3)],
        props=[Box(pose=(-0.6, 1.0, 0.4))],
        workspace=[(-2.5, -2), (-2.5, 2), (2.5, 2), (2.5, -2)],
        on_exit="wall",
        sampling_time=sampling_time,
        stop_time=(STEPS - 1) * sampling_time,
        addons=[Room(name="room_of_the_trial"), *addons],
    )


class Room(Addon):
    """The furniture of the small world: a wall, a triangle, a beacon, a floor that is half grey."""

    def obstacles(self) -> tuple[Outline, ...]:
        """Return a wall and a triangle."""
        return ((-0.2, -1.9), (-0.2, -0.7)), ((1.6, -1.4), (2.1, -1.4), (1.9, -0.9))

    def beacons(self) -> dict[str, Point]:
        """Return one lamp."""
        return {"lamp": (0.3, 1.5)}

    def ground(self, point: Point) -> tuple[float, float, float] | None:
        """Return grey for the right half."""
        return (0.5, 0.5, 0.5) if point[0] > 0 else None


def bystander(robot: Any) -> tuple[float, float]:
    """Wander at random: the default law of a trial's robots."""
    return 0.3, robot.rng.uniform(-1.5, 1.5)


def shepherd(world: Any) -> Any:
    """Let all robots wander at random: the default law of a trial's team."""
    still = np.zeros((2, len(world.robots)))
    still[0], still[1] = 0.2, world.rng.uniform(-pi / 2, pi / 2)
    return still


@dataclass
class Run:
    """One run of a trial.

    rows: the contents of the world after each control step, by name, in causal order. error: the
    one that ended the run.
    """

    rows: list[dict[str, bytes]] = field(default_factory=list)
    error: InputError | None = None


@dataclass(frozen=True)
class Trial:
    """A world of a scenario and its team's law that can be run repeatedly; made anew by `make`.

    name: of what is tried. make: a function of the seed. deadline: of each control step.
    """

    name: str
    make: Callable[[int], World]
    deadline: Deadline

    def run(
        self,
        look: Callable[[World], None] = lambda _: None,
        *,
        noise: int = 1,
        beside: bool = False,
        draw: bool = False,
    ) -> Run:
        """Run once.

        look: called with the world after each step. noise: the seed of Python's and numpy's shared
        generators, which must not matter. beside: whether a second world, of another seed, takes
        its steps in turn. draw: whether add-ons draw at each step, as in a window.
        """
        run, start = Run(), time.monotonic()
        with _shared_generators(noise):
            try:
                self.deadline.alive()
                worlds = [self.make(seed) for seed in ((1, 2) if beside else (1,))]
                for step in range(STEPS):
                    if step >= MIN_STEPS and time.monotonic() - start > MAX_RUN_TIME:
                        break
                    for world in worlds:
                        self.deadline.alive()
                        if draw:
                            world.observe()
                            if world.frame.draw_addons is not None:
                                world.frame.draw_addons(Scene())
                        if not world.over:
                            world.step()
                    run.rows.append(_row(worlds[0]))
                    look(worlds[0])
                    if worlds[0].over:
                        break
            except Late:
                run.error = InputError(
                    f"{self.name} did not come to an end within {self.deadline.patience:g} s, and "
                    "was broken off. Is there a loop that never ends? A law that waits yields at "
                    "each step"
                )
                run.error.where = self.deadline.arrived() or None
            except InputError as error:
                run.error = error
            except Exception as error:  # whatever a user's object raises
                run.error = InputError(described(error))
                run.error.where = users_line(stack_of(error))
        return run


def difference(one: Run, other: Run, ours: Callable[[str], bool]) -> str:
    """Return the first difference of two runs, as "step 3 (pose robot0)"; "" if there is none.

    ours: whether a name in `Run.rows` counts. A run that was ended early counts as far as it goes.
    """
    for step, (mine, its) in enumerate(zip(one.rows, other.rows, strict=False)):
        for what in mine | its:
            if ours(what) and mine.get(what) != its.get(what):
                return f"step {step} on ({what})"
    return ""


def contents(value: Any) -> bytes:
    """Return bytes that are equal for equal contents."""
    try:
        return pickle.dumps(value)
    except Exception:  # whatever a user's object raises
        return re.sub(r" at 0x\w+", "", repr(value)).encode()


def _row(world: World) -> dict[str, bytes]:
    """Return the contents of a world after a control step, by name, in causal order."""
    robots = world.scenario.robots
    found: dict[str, Any] = {
        f"add-on {key}.{attribute}": value
        for key, addon in vars(world.addons).items()
        for attribute, value in vars(addon).items()
    }
    for key, readings in world.frame.readings.items():
        found |= {f"sensor {key} of {robots[i].name}": value for i, value in readings}
    found |= {f"command {robots[i].name}": c for i, c in enumerate(world.command.T)}
    found |= {f"pose {robots[i].name}": p for i, p in enumerate(world.pose.T)}
    return {name: contents(value) for name, value in found.items()} | {OVER: bytes([world.over])}


def untouchable(world: World, besides: str = "") -> dict[str, bytes]:
    """Return the contents, by name, of everything that sensors and drawings must not change.

    besides: the key of an add-on that may change itself.
    """
    found: dict[str, Any] = {
        OVER: (world.over, world.over_message),
        "the poses": (world.pose, world.prop_pose),
        "the commands": world.command,
        "the random stream of the team's law": world.rng,
    }
    for robot in world.robots:
        found[f"the memory of {robot.name}"] = vars(robot.memory)
        found[f"the random stream of {robot.name}"] = robot.rng
    for key, addon in vars(world.addons).items():
        if key != besides:
            found[f"the add-on {key}"] = vars(addon)
    return {name: contents(value) for name, value in found.items()}


def changed(before: dict[str, bytes], world: World, besides: str = "") -> str:
    """Return the name of what changed first since `untouchable`, or ""."""
    now = untouchable(world, besides)
    return next((name for name, value in before.items() if now.get(name) != value), "")


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
