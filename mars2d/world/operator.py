"""The operator of a running world: drives robots, moves and pulls bodies, changes the scenario."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from math import ceil, dist, sqrt
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mars2d.core import checks
from mars2d.core.arithmetic import cosine_sine, norm
from mars2d.core.description import bounded, wrong
from mars2d.core.errors import InputError
from mars2d.core.plane import Point
from mars2d.physics.engine import Engine, Kinematics
from mars2d.record.interventions import Change, Intervention, Place, Pull, Push, Steer, Triple
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
FORCE = bounded(f"a number > 0 and <= {MAX_FORCE:g} [N]", above=0, high=MAX_FORCE)
SPEED = bounded(f"a number > 0 and <= {MAX_SPEED:g} [m/s]", above=0, high=MAX_SPEED)
DURATION = bounded("a number > 0 [s]", above=0)

ROUNDING = 1e-9
"""The rounding error of a point of a body, in parts of the body's radius."""

TINY = 1e-12
"""The smallest length or force that is a divisor."""


class Operator:
    """Changes a world from outside, besides the commands of its laws.

    log: all of it but the commands, in order, as data; see `mars2d.record.interventions`. held: the
    robots that stand still until the end, by index. driven: the commands (m,) of robots that are
    driven, by index. pulls: those that act now, by body.
    """

    def __init__(self, world: Simulation) -> None:
        """Take the world; nothing is done to it yet."""
        self._world = world
        self.log: list[Intervention] = []
        self.held: list[int] = []
        self.driven: dict[int, tuple[float, ...]] = {}
        self.pulls: dict[int, Pull] = {}
        self._steered: set[int] = set()  # those that the log says are driven
        self._pushes: list[Push] = []
        self._force: dict[int, float] = {}

    def redo(self, log: Sequence[Intervention], scenario_of: Callable[[Change], Scenario]) -> None:
        """Do again what the log of another world of this run says of the present row.

        scenario_of: returns the scenario of a change, with laws that fit this world.
        """
        row, by_row = self._world.iteration, attrgetter("row")
        for each in log[bisect_left(log, row, key=by_row) : bisect_right(log, row, key=by_row)]:
            again = each
            if isinstance(each, Change):
                control = self._world.laws.function
                again = replace(each, scenario=scenario_of(each), control=control)
            self.do(again)

    def do(self, what: Intervention) -> None:
        """Do something at this instant, and log it."""
        if isinstance(what, Pull):
            self._pull(what)
            return
        if isinstance(what, Place):
            self._place(what)
        elif isinstance(what, Change):
            self._change(what)
        elif isinstance(what, Push):
            self._pushes.append(what)
        else:
            (self._steered.add if what.driven else self._steered.discard)(what.robot)
        self.log.append(what)

    # -- commands -----------------------------------------------------------------------------

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law or the operator commands."""
        index = self._world.scenario.index_of("World.hold", robot)
        if index not in self.held:
            self.held.append(index)

    def steer(self, robot: str | int, command: ArrayLike | None) -> None:
        """Give a robot this command (m,) from now on in place of its law's; None: its law's again.

        Its law is asked all the same, so that it is up to date when it takes over again.
        """
        index = self._world.scenario.index_of("Operator.steer", robot)
        if command is None:
            self.driven.pop(index, None)
        else:
            inputs = self._world.scenario.robots[index].drive.inputs
            say = partial(refuse, "Operator.steer: the command")
            self.driven[index] = robot_command(command, inputs, say)
        if (index in self._steered) != (index in self.driven):
            self.do(Steer(self._world.iteration, index, driven=index in self.driven))

    def let_go(self) -> None:
        """Let go of all robots that are driven and all bodies that are pulled; pushes go on."""
        for robot in sorted(self._steered):
            self.steer(robot, None)
        for pull in [*self.pulls.values()]:
            self._pull(replace(pull, row=self._world.iteration, target=None))

    def command(self, wanted: Float) -> Float:
        """Return the laws' commands (m, n), replaced for robots that are driven or held."""
        if not (self.driven or self.held):
            return wanted
        given = wanted.copy()
        for robot, command in self.driven.items():
            given[: len(command), robot] = command
        given[:, self.held] = 0.0
        return given

    # -- bodies -------------------------------------------------------------------------------

    def place(self, body: str | int, pose: Sequence[float]) -> None:
        """Put a robot or prop at a pose (x, y [m], theta [rad]), where it stands still at first.

        body: its name or index in `Scenario.bodies`. Sensors are read before. Raises InputError
        where it would overlap something, and for a body that a joint holds.
        """
        index = self._world.scenario.body_index_of("Operator.place", body)
        where = checks.pose("Operator.place(pose)", pose)
        self.do(Place(self._world.iteration, index, where))

    def _place(self, place: Place) -> None:
        world, body = self._world, place.body
        if fault := fixed(world.scenario, body):
            raise InputError(fault)
        world.observe()
        if fault := obstruction(world.scenario, self._poses({body: place.pose}), body):
            name = world.scenario.bodies[body].name
            raise InputError(f"{name} can't be put there: it would {fault}")
        world.move({body: place.pose})

    def _poses(self, moved: Mapping[int, Triple]) -> Float:
        """Return the poses (3, n + p) of all bodies, with some that were moved."""
        poses = np.hstack([self._world.pose, self._world.prop_pose])
        for body, pose in moved.items():
            poses[:, body] = pose
        return poses

    def change(
        self,
        scenario: Scenario,
        control: Callable[[Any], Any] | None = None,
        moved: Mapping[int, Triple] | None = None,
        options: Mapping[str, Any] | None = None,
        given: frozenset[str | None] = frozenset(),
    ) -> None:
        """Go on with another scenario, see `World.change`.

        given: the names of robots that get other laws by hand; these hold if the run is repeated.
        """
        where, made = tuple((moved or {}).items()), tuple((options or {}).items())
        self.do(Change(self._world.iteration, scenario, where, control, made, given))

    def _change(self, change: Change) -> None:
        world, scenario, moved = self._world, change.scenario, dict(change.moved)
        check_same(world.scenario, scenario)
        if change.control is not None:
            checks.function("control", change.control, "the world")
        world.observe()
        stays = not moved and scenario.surfaces == world.scenario.surfaces
        moves_on = stays and moves_alike(world.scenario, scenario)
        changed = scenario if stays else with_poses(scenario, self._poses(moved))
        world.go_on(changed, change.control, None if moves_on else moved)

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
        to = None if target is None else checks.point("Operator.pull(target)", target)
        most = FORCE("Operator.pull(force)", force), SPEED("Operator.pull(speed)", speed)
        self.do(Pull(self._world.iteration, index, point, to, *most))

    def push(
        self, body: str | int, force: Point, duration: float, grip: Point = (0.0, 0.0)
    ) -> None:
        """Push a robot or prop by a constant force from now on, for a duration [s].

        force: (x, y), N. grip: the point of the body at which it acts, in its frame [m]. Pushes of
        one body add up. Raises InputError as `pull` does.
        """
        index, point = self._gripped("Operator.push", body, grip)
        acts = checks.point("Operator.push(force)", force)
        if not 0 < norm(*acts) <= MAX_FORCE:
            raise wrong("Operator.push(force)", force, f"more than 0 and up to {MAX_FORCE:g} [N]")
        lasts = DURATION("Operator.push(duration)", duration)
        self.do(Push(self._world.iteration, index, point, acts, lasts))

    def _gripped(self, call: str, body: str | int, grip: Point) -> tuple[int, Point]:
        """Return the index of a body that forces can move, and a point of it."""
        scenario = self._world.scenario
        index = scenario.body_index_of(call, body)
        if fault := forceless(scenario, index):
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
            self.log.remove(said.pop())
        before = said[-1] if said and said[-1].target is not None else None
        if pull.target is None:
            self.pulls.pop(pull.body, None)
        else:
            self.pulls[pull.body] = pull
        said_so = None if before is None else replace(before, row=pull.row)
        if pull != said_so and (before or pull.target is not None):
            self.log.append(pull)

    def force(self, body: int) -> float:
        """Return the force on a body at the end of the last control step, N."""
        return self._force.get(body, 0.0)

    # -- motion -------------------------------------------------------------------------------

    def drive(
        self, engine: Engine | Kinematics, twist: Float, duration: float, time: float
    ) -> None:
        """Let an engine move everything for `duration` seconds, under pulls and pushes."""
        self._force = {}
        if not ((self.pulls or self._pushes) and isinstance(engine, Engine)):
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
        if not (self.pulls or pushes):
            engine.drive(twist, duration, time)
            return
        count = ceil(duration / min(SLICE, self._longest_slice(engine, pushes)))
        h = duration / count
        for k in range(count):
            poses, velocities = engine.pose, engine.velocity
            engine.let_go()
            loads = {
                body: self._spring(pull, poses[:, body], velocities[:, body])
                for body, pull in self.pulls.items()
            }
            for push in pushes:
                theta = poses[2, push.body] + velocities[2, push.body] * h / 2  # in the middle
                fx, fy, torque = _pushed(push, float(theta))
                x, y, turning = loads.get(push.body, (0.0, 0.0, 0.0))
                loads[push.body] = fx + x, fy + y, torque + turning
            for body, (fx, fy, torque) in loads.items():
                self._force[body] = norm(fx, fy)
                if not engine.withstands(body, norm(fx, fy), abs(torque)):
                    engine.pull(body, (fx, fy), torque)
            engine.drive(twist, h, time + k * h)
        engine.let_go()

    def _longest_slice(self, engine: Engine, pushes: Sequence[Push]) -> float:
        """Return the longest time that forces may act unchanged, seconds."""
        bodies = self._world.scenario.bodies
        most = [
            min(pull.force / bodies[pull.body].inertia.mass, 4 * STIFFNESS * pull.speed)
            for pull in self.pulls.values()
        ]
        most += [norm(*push.force) / bodies[push.body].inertia.mass for push in pushes]
        return engine.step_under(max(most))

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
