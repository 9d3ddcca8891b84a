"""The operator of a running world: drives robots, moves and pulls bodies, changes the scenario."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import ceil, dist, sqrt
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.description import real, wrong
from mars2d.core.errors import InputError
from mars2d.core.plane import Point
from mars2d.physics.engine import Engine, Kinematics
from mars2d.record.interventions import Change, Intervention, Place, Pull, Push, Steer
from mars2d.scenario.changes import check_same, moves_alike, obstruction, with_poses
from mars2d.scenario.scenario import Scenario
from mars2d.world.laws import refuse, robot_command

if TYPE_CHECKING:
    from mars2d.world.simulation import Simulation

Float = NDArray[np.float64]
Load = tuple[float, float, float]
"""A force (x, y) [N] and a torque [N m] on a body."""

SLICE = 0.01
"""The longest time that the force of a spring stays the same, seconds."""

STIFFNESS = 24.0
"""The natural frequency of a spring that pulls, critically damped, rad/s."""

MAX_FORCE, MAX_SPEED = 1e6, 100.0
"""The bounds of a pull, N and m/s; quicker ones need ever more substeps."""

ROUNDING = 1e-9
"""The rounding error of a point of a body, in parts of the body's radius."""

TINY = 1e-12
"""The smallest length or force that is a divisor."""


class Operator:
    """Changes a world from outside, besides the commands of its laws.

    log: all of it but the commands, in order, as data; see `mars2d.record.interventions`.
    """

    def __init__(self, world: Simulation) -> None:
        """Take the world; nothing is done to it yet."""
        self._world = world
        self._driven: dict[int, tuple[float, ...]] = {}
        self._steered: set[int] = set()  # those that the log says are driven
        self._pulls: dict[int, Pull] = {}
        self._pushes: list[Push] = []
        self._held: list[int] = []
        self._force: dict[int, float] = {}
        self.log: list[Intervention] = []

    # -- commands -----------------------------------------------------------------------------

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law or the operator commands."""
        index = self._world.scenario.index_of("World.hold", robot)
        if index not in self._held:
            self._held.append(index)

    @property
    def held(self) -> Sequence[int]:
        """The robots that stand still until the end, by index."""
        return tuple(self._held)

    def steer(self, robot: str | int, command: ArrayLike | None) -> None:
        """Give a robot this command (m,) from now on in place of its law's; None: its law's again.

        Its law is asked all the same, so that it is up to date when it takes over again.
        """
        index = self._world.scenario.index_of("Operator.steer", robot)
        if command is None:
            self._drive_no_more(index)
            return
        inputs = self._world.scenario.robots[index].drive.inputs
        numbers = robot_command(command, inputs, partial(refuse, "Operator.steer: the command"))
        if index not in self._steered:
            self._note(Steer(self._world.iteration, index, driven=True))
        self._driven[index] = numbers

    def _drive_no_more(self, robot: int) -> None:
        self._driven.pop(robot, None)
        if robot in self._steered:
            self._note(Steer(self._world.iteration, robot, driven=False))

    def _note(self, steer: Steer) -> None:
        """Log that a robot is driven from now on, or no more."""
        (self._steered.add if steer.driven else self._steered.discard)(steer.robot)
        self.log.append(steer)

    def let_go(self) -> None:
        """Let go of all robots that are driven and all bodies that are pulled; pushes go on."""
        for robot in sorted(self._steered):
            self._drive_no_more(robot)
        for pull in self.pulls:
            self._pull(replace(pull, row=self._world.iteration, target=None))

    @property
    def driven(self) -> Sequence[int]:
        """The robots that are driven, by index."""
        return tuple(self._driven)

    def command(self, wanted: Float) -> Float:
        """Return the laws' commands (m, n), replaced for robots that are driven or held."""
        if not (self._driven or self._held):
            return wanted
        given = wanted.copy()
        for robot, command in self._driven.items():
            given[: len(command), robot] = command
        given[:, self._held] = 0.0
        return given

    # -- bodies -------------------------------------------------------------------------------

    def place(self, body: str | int, pose: Sequence[float]) -> None:
        """Put a robot or prop at a pose (x, y [m], theta [rad]), where it stands still at first.

        body: its name or index in `Scenario.bodies`. Sensors are read before. Raises InputError
        where it would overlap something, and for a body that a joint holds.
        """
        world = self._world
        index = world.scenario.body_index_of("Operator.place", body)
        place = Place(world.iteration, index, checks.pose("Operator.place(pose)", pose))
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
        world.move({index: place.pose})
        self.log.append(place)

    def change(
        self,
        scenario: Scenario,
        control: Callable[[Any], Any] | None = None,
        moved: Mapping[int, tuple[float, float, float]] | None = None,
        options: Mapping[str, Any] | None = None,
        given: frozenset[str | None] = frozenset(),
    ) -> None:
        """Go on with another scenario, see `World.change`.

        given: the names of robots that get other laws by hand; these hold if the run is repeated.
        """
        world, moved = self._world, dict(moved or {})
        check_same(world.scenario, scenario)
        if control is not None:
            checks.function("control", control, "the world")
        world.observe()
        stays = not moved and scenario.surfaces == world.scenario.surfaces
        moves_on = stays and moves_alike(world.scenario, scenario)
        if stays:
            changed = scenario
        else:
            poses = np.hstack([world.pose, world.prop_pose])
            for body, pose in moved.items():
                poses[:, body] = pose
            changed = with_poses(scenario, poses)
        made = tuple((options or {}).items())
        where = tuple(moved.items())
        self.log.append(Change(world.iteration, scenario, where, control, made, given))
        world.go_on(changed, control, None if moves_on else moved)

    def pull(
        self,
        body: str | int,
        grip: Point,
        target: Point | None,
        force: float = 20.0,
        speed: float = 2.0,
    ) -> None:
        """Pull a robot or prop by a spring from now on, until it is called again.

        grip: the point of the body that is held, in its frame [m]. target: the point that it is
        pulled to [m]; None lets go. force: of the spring at most, N. speed: of the grip at most,
        m/s. Raises InputError where no forces act, as with physics="stop".
        """
        index, point = self._gripped("Operator.pull", body, grip)
        pull = Pull(
            self._world.iteration,
            index,
            point,
            None if target is None else checks.point("Operator.pull(target)", target),
            real("Operator.pull(force)", force),
            real("Operator.pull(speed)", speed),
        )
        if not 0 < pull.force <= MAX_FORCE:
            raise wrong("Operator.pull(force)", force, f"a number > 0 and <= {MAX_FORCE:g} [N]")
        if not 0 < pull.speed <= MAX_SPEED:
            raise wrong("Operator.pull(speed)", speed, f"a number > 0 and <= {MAX_SPEED:g} [m/s]")
        self._pull(pull)

    def push(
        self, body: str | int, force: Point, duration: float, grip: Point = (0.0, 0.0)
    ) -> None:
        """Push a robot or prop by a constant force from now on, for a duration [s].

        force: (x, y), N. grip: the point of the body at which it acts, in its frame [m]. Pushes of
        one body add up. Raises InputError as `pull` does.
        """
        index, point = self._gripped("Operator.push", body, grip)
        acts = checks.point("Operator.push(force)", force)
        lasts = real("Operator.push(duration)", duration)
        if not 0 < norm(*acts) <= MAX_FORCE:
            raise wrong("Operator.push(force)", force, f"more than 0 and up to {MAX_FORCE:g} [N]")
        if lasts <= 0:
            raise wrong("Operator.push(duration)", duration, "a number > 0 [s]")
        self._push(Push(self._world.iteration, index, point, acts, lasts))

    def _push(self, push: Push) -> None:
        self._pushes.append(push)
        self.log.append(push)

    def _gripped(self, call: str, body: str | int, grip: Point) -> tuple[int, Point]:
        """Return the index of a body that forces can move, and a point of it."""
        scenario = self._world.scenario
        index = scenario.body_index_of(call, body)
        fault = forceless(scenario, index)
        if fault:
            raise InputError(fault)
        point = checks.point(f"{call}(grip)", grip)
        center, radius = scenario.bodies[index].shape.bound
        if dist(point, center) > radius * (1 + ROUNDING):
            raise wrong(f"{call}(grip)", grip, f"a point of the body, within {radius:g} m")
        return index, point

    def _pull(self, pull: Pull) -> None:
        """Keep the last pull of a body, and log it in place of others of the same control step."""
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
        """The pulls that act now."""
        return tuple(self._pulls.values())

    def force(self, body: int) -> float:
        """Return the force on a body at the end of the last control step, N."""
        return self._force.get(body, 0.0)

    def redo(self, intervention: Intervention) -> None:
        """Repeat an intervention in another world of the same run."""
        if isinstance(intervention, Place):
            self.place(intervention.body, intervention.pose)
        elif isinstance(intervention, Change):
            moved, options = dict(intervention.moved), dict(intervention.options)
            scenario, given = intervention.scenario, intervention.given
            self.change(scenario, intervention.control, moved, options, given)
        elif isinstance(intervention, Steer):
            self._note(intervention)
        elif isinstance(intervention, Push):
            self._push(intervention)
        else:
            self._pull(intervention)

    # -- motion -------------------------------------------------------------------------------

    def drive(
        self, engine: Engine | Kinematics, twist: Float, duration: float, time: float
    ) -> None:
        """Let an engine move everything for `duration` seconds, under pulls and pushes."""
        self._force = {}
        if not ((self._pulls or self._pushes) and isinstance(engine, Engine)):
            engine.drive(twist, duration, time)
            return
        dt, begin = self._world.sampling_time, 0.0
        left = {push: push.row * dt + push.duration - time for push in self._pushes}
        ends = {end for end in left.values() if TINY < end < duration - TINY}
        for end in [*sorted(ends), duration]:
            pushes = [push for push in self._pushes if left[push] - begin > TINY]
            self._drive_under(engine, twist, end - begin, time + begin, pushes)
            begin = end

    def _drive_under(
        self, engine: Engine, twist: Float, duration: float, time: float, pushes: Sequence[Push]
    ) -> None:
        """Do so while the pulls and the same pushes act."""
        if not (self._pulls or pushes):
            engine.drive(twist, duration, time)
            return
        count = ceil(duration / min(SLICE, self._longest_slice(engine, pushes)))
        h = duration / count
        for k in range(count):
            poses, velocities = engine.pose, engine.velocity
            engine.let_go()
            loads = {
                body: self._spring(pull, poses[:, body], velocities[:, body])
                for body, pull in self._pulls.items()
            }
            for push in pushes:
                own, others = _pushed(push, float(poses[2, push.body])), loads.get(push.body)
                loads[push.body] = own if others is None else _sum(own, others)
            for body, load in loads.items():
                self._load(engine, body, *load)
            engine.drive(twist, h, time + k * h)
        engine.let_go()

    def _longest_slice(self, engine: Engine, pushes: Sequence[Push]) -> float:
        """Return the longest time that forces may act unchanged, seconds."""
        bodies = self._world.scenario.bodies
        most = [
            min(pull.force / bodies[pull.body].inertia.mass, 4 * STIFFNESS * pull.speed)
            for pull in self._pulls.values()
        ]
        most += [norm(*push.force) / bodies[push.body].inertia.mass for push in pushes]
        return engine.step_under(max(most))

    def _load(self, engine: Engine, body: int, fx: float, fy: float, torque: float) -> None:
        """Let a force and a torque act on a body, unless it withstands them."""
        self._force[body] = norm(fx, fy)
        if not engine.withstands(body, norm(fx, fy), abs(torque)):
            engine.pull(body, (fx, fy), torque)

    def _spring(self, pull: Pull, pose: Float, velocity: Float) -> Load:
        """Return the force [N] and the torque [N m] of a spring on a body at a pose (3,)."""
        assert pull.target is not None
        mass, moment = self._world.scenario.bodies[pull.body].inertia
        x, y, theta = pose.tolist()
        vx, vy, spin = velocity.tolist()
        c, s = cosine_sine(theta)
        ax, ay = c * pull.grip[0] - s * pull.grip[1], s * pull.grip[0] + c * pull.grip[1]
        lead = self._world.scenario.bodies[pull.body].lead
        lx, ly = ax - c * lead, ay - s * lead
        wx, wy = pull.target[0] - x - ax, pull.target[1] - y - ay
        way = max(norm(wx, wy), TINY)
        felt = 1.0 / (1.0 / mass + (lx * lx + ly * ly) / moment)  # at the grip, across the arm
        # No faster than it can brake before the target.
        speed = min(STIFFNESS / 2 * way, pull.speed, sqrt(pull.force / felt * way))
        fx = 2 * STIFFNESS * felt * (speed / way * wx - (vx - spin * ay))
        fy = 2 * STIFFNESS * felt * (speed / way * wy - (vy + spin * ax))
        share = min(1.0, pull.force / max(norm(fx, fy), TINY))
        return share * fx, share * fy, share * (ax * fy - ay * fx)


def _pushed(push: Push, theta: float) -> Load:
    """Return the force [N] and the torque [N m] of a push on a body at an angle."""
    (x, y), (fx, fy) = push.grip, push.force
    c, s = cosine_sine(theta)
    return fx, fy, (c * x - s * y) * fy - (s * x + c * y) * fx


def _sum(one: Load, other: Load) -> Load:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


def forceless(scenario: Scenario, body: int) -> str:
    """Return the reason why a body can't be pulled, or ""."""
    if scenario.physics == "contact":
        return ""
    return (
        f"{scenario.bodies[body].name} can't be pulled: with physics = {scenario.physics!r} no "
        "forces act; pause, and put it elsewhere"
    )


def fixed(scenario: Scenario, body: int) -> str:
    """Return the reason why a body can't be put elsewhere, or ""."""
    if all(body not in (tie.a, tie.b) for tie in scenario.ties):
        return ""
    return (
        f"{scenario.bodies[body].name} can't be put elsewhere: a joint holds it; it can be pulled"
    )
