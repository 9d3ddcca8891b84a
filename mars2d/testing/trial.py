"""Trials: runs of a part in a small world or a scenario, which can be compared."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
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
from mars2d.testing.state import fingerprint
from mars2d.world.world import World

STEPS = 50
"""Control steps of a trial."""

MIN_STEPS = 5

MAX_RUN_TIME = 1.0
"""Seconds after which a slow run ends early, but not before `MIN_STEPS` steps."""


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
        robots=[
            carrier.at(-1.5, 0.2, 0.1),
            carrier.at(0.7, -0.6, 2.0),
            third.at(1.4, 1.2, -2.3),
        ],
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
        wall = ((-0.2, -1.9), (-0.2, -0.7))
        return wall, ((1.6, -1.4), (2.1, -1.4), (1.9, -0.9))

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

    rows: for each control step, fingerprints of the world's state by name, in causal order. error:
    the one that ended the run. late: the line that took longer than `patience` seconds. scenes:
    fingerprints of the add-ons' drawings.
    """

    rows: list[dict[str, str]] = field(default_factory=list)
    error: InputError | None = None
    late: str | None = None
    patience: float = 0.0
    world: World | None = None
    scenes: list[str] = field(default_factory=list)

    @property
    def failed(self) -> bool:
        """Whether it did not run to its end."""
        return self.error is not None or self.late is not None


def as_input_error(error: Exception) -> InputError:
    """Return an exception as an InputError that points at the user's line."""
    if isinstance(error, InputError):
        return error
    result = InputError(described(error))
    result.where = users_line(stack_of(error))
    return result


@dataclass(frozen=True)
class Difference:
    """The first difference of two runs: the control step, its time, and a name in `Run.rows`."""

    step: int
    time: float
    what: str


def difference(one: Run, other: Run, sampling_time: float) -> Difference | None:
    """Return the first difference of two runs, or None if they are equal."""
    for step, (mine, its) in enumerate(zip(one.rows, other.rows, strict=False)):
        for what in mine | its:
            if mine.get(what) != its.get(what):
                return Difference(step, step * sampling_time, what)
    if len(one.rows) != len(other.rows):
        step = min(len(one.rows), len(other.rows))
        return Difference(step, step * sampling_time, "the end")
    return None


@dataclass(frozen=True)
class Trial:
    """A scenario and its team's law, which can be run repeatedly.

    deadline: a run that it breaks off is late. timed: whether slow runs end early; False for runs
    that are compared with another one. looked: called with the world after each step.
    """

    scenario: Scenario
    control: Callable[[Any], Any] | None
    deadline: Deadline
    steps: int = STEPS
    timed: bool = True
    looked: Callable[[World], None] | None = None

    def run(self, seed: int = 1, *, noise: int = 1, draw: bool = False) -> Run:
        """Run once.

        noise: the seed of Python's and numpy's shared random generators, which must not matter.
        draw: whether add-ons draw at each step, as in a window.
        """
        result = Run()
        with _global_generators(noise):
            self._go([(seed, result)], draw)
        return result

    def interleaved(self, seed: int = 1) -> Run:
        """Run two worlds with different seeds in alternation; return the first one's run."""
        result = Run()
        with _global_generators(1):
            self._go([(seed, result), (seed + 1, Run())], draw=False)
        return result

    def shortened(self, run: Run) -> Trial:
        """Return this trial with as many steps as a run has done."""
        return replace(self, steps=max(len(run.rows), 1), timed=False)

    def _go(self, seeded: list[tuple[int, Run]], draw: bool) -> None:
        run = seeded[0][1]
        start = time.monotonic()
        try:
            for seed, each in seeded:
                self.deadline.alive()
                each.world = World(self.scenario, self.control, seed)
            for step in range(self.steps):
                if self.timed and step >= MIN_STEPS and time.monotonic() - start > MAX_RUN_TIME:
                    break
                for _, each in seeded:
                    self.deadline.alive()
                    self._step(each, draw)
                if run.world is None or run.world.over:
                    break
        except Late:
            run.late, run.patience = self.deadline.arrived(), self.deadline.patience
        except Exception as error:  # whatever a user's object raises
            run.error = as_input_error(error)

    def _step(self, run: Run, draw: bool) -> None:
        world = run.world
        if world is None or world.over:
            return
        if draw:
            scene = Scene()
            world.observe()
            draw_addons = world.frame.draw_addons
            if draw_addons is not None and not world.over:
                draw_addons(scene)
            run.scenes.append(fingerprint([coordinates(shape) for shape in scene.shapes]))
            if world.over:
                return
        world.step()
        run.rows.append(_row(world))
        if self.looked is not None:
            self.looked(world)


def _row(world: World) -> dict[str, str]:
    """Return fingerprints of the state after a control step, by name, in causal order."""
    row = {
        f"add-on {key}.{attribute}": fingerprint(value)
        for key, addon in vars(world.addons).items()
        for attribute, value in vars(addon).items()
    }
    for key, readings in world.frame.readings.items():
        row |= {f"sensor {key} of {_name(world, i)}": fingerprint(v) for i, v in readings}
    row |= {f"command {_name(world, i)}": fingerprint(c) for i, c in enumerate(world.command.T)}
    row |= {f"pose {_name(world, i)}": fingerprint(p) for i, p in enumerate(world.pose.T)}
    return row


def _name(world: World, index: int) -> str:
    return str(world.scenario.robots[index].name)


def coordinates(shape: Any) -> list[Any]:
    """Return the kind of a scene's shape and the values of its slots."""
    return [type(shape).__name__, *(getattr(shape, name) for name in type(shape).__slots__)]


OVER = "whether the experiment is over"


def changes(before: dict[str, str], world: World, besides: str = "") -> str:
    """Return the names of the parts of a world that changed since `prints`, as text."""
    now = prints(world, besides)
    changed = [name for name, contents in before.items() if now.get(name) != contents]
    return OVER if OVER in changed else ", ".join(changed)  # the end changes more than itself


def prints(world: World, besides: str = "") -> dict[str, str]:
    """Return fingerprints, by name, of everything that sensors and drawings must not change.

    besides: the key of an add-on that may change itself.
    """
    found: dict[str, Any] = {
        "the poses": (world.pose, world.prop_pose),
        "the commands": world.command,
        OVER: (world.over, world.over_message),
        "the random stream of the team's law": world.rng,
    }
    for robot in world.robots:
        found[f"the memory of {robot.name}"] = vars(robot.memory)
        found[f"the random stream of {robot.name}"] = robot.rng
    for key, addon in vars(world.addons).items():
        if key != besides:
            found[f"the add-on {key}"] = vars(addon)
    return {name: fingerprint(value) for name, value in found.items()}


@contextmanager
def _global_generators(seed: int) -> Iterator[None]:
    """Seed Python's and numpy's shared generators, and restore their states afterwards."""
    before = random.getstate(), np.random.get_state()  # noqa: NPY002 - it is what laws misuse
    random.seed(seed)
    np.random.seed(seed)  # noqa: NPY002
    try:
        yield
    finally:
        random.setstate(before[0])
        np.random.set_state(before[1])  # noqa: NPY002


@contextmanager
def drawn_at_random(note: Callable[[str], None]) -> Iterator[None]:
    """Call `note` with the name of each shared generator that is used inside the block."""
    python, numpy = random.getstate(), _numpy_state()
    try:
        yield
    finally:
        if random.getstate() != python:
            note("random")
        if _numpy_state() != numpy:
            note("numpy.random")


def _numpy_state() -> tuple[Any, ...]:
    _, keys, *rest = np.random.get_state()  # noqa: NPY002
    return (np.asarray(keys).tobytes(), *rest)
