"""Hands on a running world: they drive robots, put bodies elsewhere, pull them, hold them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import ceil, cos, dist, hypot, sin, sqrt
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.plane import Point
from mars2d.physics.engine import Engine
from mars2d.physics.kinematics import Kinematics
from mars2d.record.interventions import Change, Intervention, Place, Pull, Steer
from mars2d.scenario.placement import obstruction
from mars2d.scenario.scenario import Scenario

if TYPE_CHECKING:
    from mars2d.world.world import World

__all__ = ["Hands", "fixed", "forceless"]

Float = NDArray[np.float64]

SLICE = 0.01
"""How often a spring that pulls is looked at, seconds."""

STIFFNESS = 24.0
"""How quickly a spring draws in what it pulls: the natural frequency of critical damping, rad/s."""

STRONGEST, FASTEST = 1e6, 100.0
"""Bounds of what may pull, N and m/s; quicker ones need ever more substeps."""

ROUNDING = 1e-9
"""How far off a body a point of it may be, in parts of the body's reach."""

TINY = 1e-12
"""No length or force is divided by less."""


class Hands:
    """What is done to a world from outside, besides what its laws command.

    log: all of it but the commands, in order, as data; see `mars2d.record.interventions`.
    """

    def __init__(self, world: World) -> None:
        """Take the world; nothing is done to it yet."""
        self._world = world
        self._driven: dict[int, tuple[float, float]] = {}
        self._steered: set[int] = set()  # of whom the log says so
        self._pulls: dict[int, Pull] = {}
        self._held: list[int] = []
        self._force: dict[int, float] = {}
        self.log: list[Intervention] = []

    # -- commands -----------------------------------------------------------------------------

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law or a hand says."""
        index = self._world.scenario.index_of("World.hold", robot)
        if index not in self._held:
            self._held.append(index)

    def steer(self, robot: str | int, command: ArrayLike | None) -> None:
        """Give a robot this command (2,) from now on in place of its law's; None: its law's again.

        Its law is asked all the same, so that it knows what goes on when it takes over again.
        """
        index = self._world.scenario.index_of("Hands.steer", robot)
        if command is None:
            self._drive_no_more(index)
            return
        pair = command.tolist() if isinstance(command, np.ndarray) else command
        if not isinstance(pair, (tuple, list)) or len(pair) != 2:
            raise wrong("Hands.steer(command)", command, "two numbers, or None")
        first, second = (real("Hands.steer(command)", number, "a number") for number in pair)
        if index not in self._steered:
            self._note(Steer(self._world.iteration, index, driven=True))
        self._driven[index] = first, second

    def _drive_no_more(self, robot: int) -> None:
        self._driven.pop(robot, None)
        if robot in self._steered:
            self._note(Steer(self._world.iteration, robot, driven=False))

    def _note(self, steer: Steer) -> None:
        """Tell that a robot is driven from now on, or no more."""
        (self._steered.add if steer.driven else self._steered.discard)(steer.robot)
        self.log.append(steer)

    def let_go(self) -> None:
        """Let go of all that is driven or pulled."""
        for robot in sorted(self._steered):
            self._drive_no_more(robot)
        for pull in self.pulls:
            self._pull(replace(pull, row=self._world.iteration, target=None))

    @property
    def driven(self) -> Sequence[int]:
        """The robots that hands drive, by index."""
        return tuple(self._driven)

    def command(self, wanted: Float) -> Float:
        """Return the commands (2, n) that are given in place of those that laws want."""
        if not (self._driven or self._held):
            return wanted
        given = wanted.copy()
        for robot, command in self._driven.items():
            given[:, robot] = command
        given[:, self._held] = 0.0
        return given

    # -- bodies -------------------------------------------------------------------------------

    def place(self, body: str | int, pose: Sequence[float]) -> None:
        """Put a robot or prop at a pose (x, y [m], theta [rad]), where it stands still at first.

        body: its name or index in `Scenario.bodies`. Sensors have read before that. Raises
        InputError where it would overlap something, and for what a joint holds.
        """
        world = self._world
        index = world.scenario.body_index_of("Hands.place", body)
        place = Place(world.iteration, index, checks.pose("Hands.place(pose)", pose))
        fault = fixed(world.scenario, index)
        if fault:
            raise InputError(fault)
        world.observe()
        poses = np.hstack([world.pose, world.prop_pose])
        poses[:, index] = place.pose
        fault = obstruction(world.scenario, poses, index)
        if fault:
            name = world.scenario.bodies[index].name
            raise InputError(f"{name} can't be put there: it would {fault}")
        world.rebuild(world.motion.moved({index: place.pose}))
        self.log.append(place)

    def pull(
        self,
        body: str | int,
        grip: Point,
        target: Point | None,
        force: float = 20.0,
        speed: float = 2.0,
    ) -> None:
        """Pull a robot or prop by a spring from now on, until another word of it.

        grip: the point of the body that is held, in its frame [m]. target: where it is pulled to
        [m]; None lets go. force: the most that the spring pulls with, N. speed: the most at which
        it draws, m/s. Raises InputError where no forces act, as with physics="stop".
        """
        world = self._world
        index = world.scenario.body_index_of("Hands.pull", body)
        fault = forceless(world.scenario, index)
        if fault:
            raise InputError(fault)
        pull = Pull(
            world.iteration,
            index,
            checks.point("Hands.pull(grip)", grip),
            None if target is None else checks.point("Hands.pull(target)", target),
            real("Hands.pull(force)", force),
            real("Hands.pull(speed)", speed),
        )
        center, radius = world.scenario.bodies[index].shape.bound
        if dist(pull.grip, center) > radius * (1 + ROUNDING):
            raise wrong("Hands.pull(grip)", grip, f"a point of the body, within {radius:g} m")
        if not 0 < pull.force <= STRONGEST:
            raise wrong("Hands.pull(force)", force, f"a number > 0 and <= {STRONGEST:g} [N]")
        if not 0 < pull.speed <= FASTEST:
            raise wrong("Hands.pull(speed)", speed, f"a number > 0 and <= {FASTEST:g} [m/s]")
        self._pull(pull)

    def _pull(self, pull: Pull) -> None:
        """Keep what is said last of a body; of what is said in one control step, only that."""
        said = [i for i in self.log if isinstance(i, Pull) and i.body == pull.body]
        if said and said[-1].row == pull.row:
            last = said.pop()
            self.log = [i for i in self.log if i is not last]
        before = said[-1] if said else None
        going_on = None if before is None or before.target is None else before
        if pull.target is None:
            self._pulls.pop(pull.body, None)
        else:
            self._pulls[pull.body] = pull
        same = going_on is not None and replace(going_on, row=pull.row) == pull
        if not same and (pull.target is not None or going_on is not None):
            self.log.append(pull)

    @property
    def pulls(self) -> Sequence[Pull]:
        """What is pulled now."""
        return tuple(self._pulls.values())

    def force(self, body: int) -> float:
        """Return how strongly a body was pulled at the end of the last control step, N."""
        return self._force.get(body, 0.0)

    def redo(self, intervention: Intervention) -> None:
        """Do again what was done to another world of the same run."""
        if isinstance(intervention, Place):
            self.place(intervention.body, intervention.pose)
        elif isinstance(intervention, Change):
            self._world.change(
                intervention.scenario, intervention.control, dict(intervention.moved)
            )
        elif isinstance(intervention, Steer):
            self._note(intervention)
        else:
            self._pull(intervention)

    # -- motion -------------------------------------------------------------------------------

    def drive(
        self, engine: Engine | Kinematics, twist: Float, duration: float, time: float
    ) -> None:
        """Let an engine move everything for `duration` seconds, with what is pulled."""
        self._force = {}
        if not (self._pulls and isinstance(engine, Engine)):
            engine.drive(twist, duration, time)
            return
        count = ceil(duration / min(SLICE, self._longest_slice(engine)))
        h = duration / count
        for k in range(count):
            poses, velocities = engine.pose, engine.velocity
            engine.let_go()
            for pull in self._pulls.values():
                self._tug(engine, pull, poses[:, pull.body], velocities[:, pull.body])
            engine.drive(twist, h, time + k * h)
        engine.let_go()

    def _longest_slice(self, engine: Engine) -> float:
        """Return how long springs may act unchanged at most, seconds."""
        bodies = self._world.scenario.bodies
        most = max(
            min(pull.force / bodies[pull.body].inertia.mass, 4 * STIFFNESS * pull.speed)
            for pull in self._pulls.values()
        )
        return engine.step_under(most)

    def _tug(self, engine: Engine, pull: Pull, pose: Float, velocity: Float) -> None:
        """Let a spring act on a body as it is pulled now."""
        fx, fy, torque = self._spring(pull, pose, velocity)
        self._force[pull.body] = hypot(fx, fy)
        if not engine.bears(pull.body, hypot(fx, fy), abs(torque)):
            engine.pull(pull.body, (fx, fy), torque)

    def _spring(self, pull: Pull, pose: Float, velocity: Float) -> tuple[float, float, float]:
        """Return the force [N] and the torque [N m] of a spring on a body at a pose (3,)."""
        assert pull.target is not None
        mass, moment = self._world.scenario.bodies[pull.body].inertia
        x, y, theta = pose.tolist()
        vx, vy, spin = velocity.tolist()
        c, s = cos(theta), sin(theta)
        ax, ay = c * pull.grip[0] - s * pull.grip[1], s * pull.grip[0] + c * pull.grip[1]
        wx, wy = pull.target[0] - x - ax, pull.target[1] - y - ay
        way = max(hypot(wx, wy), TINY)
        felt = 1.0 / (1.0 / mass + (ax * ax + ay * ay) / moment)  # at the grip, across the arm
        # No faster than it can be braked again before it is there.
        speed = min(STIFFNESS / 2 * way, pull.speed, sqrt(pull.force / felt * way))
        fx = 2 * STIFFNESS * felt * (speed / way * wx - (vx - spin * ay))
        fy = 2 * STIFFNESS * felt * (speed / way * wy - (vy + spin * ax))
        share = min(1.0, pull.force / max(hypot(fx, fy), TINY))
        return share * fx, share * fy, share * (ax * fy - ay * fx)


def forceless(scenario: Scenario, body: int) -> str:
    """Return why a body can't be pulled, in words, or ""."""
    if scenario.physics == "contact":
        return ""
    return (
        f"{scenario.bodies[body].name} can't be pulled: with physics = {scenario.physics!r} no "
        "forces act; put it elsewhere instead"
    )


def fixed(scenario: Scenario, body: int) -> str:
    """Return why a body can't be put elsewhere, in words, or ""."""
    if all(body not in (tie.a, tie.b) for tie in scenario.ties):
        return ""
    return (
        f"{scenario.bodies[body].name} can't be put elsewhere: a joint holds it; it can be pulled"
    )
