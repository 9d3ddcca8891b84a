"""The views of the world that the law of a team is given: all of it, or positions only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NoReturn, Self, cast

import numpy as np
from numpy.typing import NDArray

from mars2d.core.arithmetic import cosines_sines
from mars2d.core.errors import LawError
from mars2d.core.plane import Outline
from mars2d.core.through import through
from mars2d.record.frame import Frame
from mars2d.record.interventions import leaps_of
from mars2d.record.recorder import History
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.surroundings import Surroundings
from mars2d.world.fork import forked
from mars2d.world.record import Record
from mars2d.world.simulation import Simulation
from mars2d.world.state import Addons, Uncopied
from mars2d.world.views import PositionsView, PropView, RobotView, alone, unknown, unseen

Float = NDArray[np.float64]

MOST_SHOWN = 20
"""The most bodies that a world is printed with."""


def printed(world: WorldView | TeamPositionsView, bodies: Sequence[RobotView | PropView]) -> str:
    """Return the text of a world: the time, and a line for each of the first bodies."""
    lines = [f"  {body}" for body in bodies[:MOST_SHOWN]]
    if len(bodies) > MOST_SHOWN:
        lines.append(f"  and {len(bodies) - MOST_SHOWN} more")
    return "\n".join([f"<{type(world).__name__} at {world.time:g} s:", *lines]) + ">"


class WorldView(Uncopied):
    """A running world, as a law with full information sees and uses it.

    A law can stop the world and hold a robot; nothing here leads to the machinery that changes it.
    `World` adds the rest, for whoever runs the world.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def __getattr__(self, name: str) -> NoReturn:
        unknown(self, "a world", name)

    def __repr__(self) -> str:
        return printed(self, [*self.robots, *self.props])

    # -- the experiment ------------------------------------------------------------------------

    scenario: Scenario = through("_simulation.scenario")
    """What is simulated now."""
    seed: int = through("_simulation.seed")
    """The seed of all random streams."""
    filename: str = through("_simulation.filename")
    """The experiment's file, or ""."""
    sampling_time: float = through("_simulation.sampling_time")
    """The time from one command to the next, seconds."""
    workspace: Outline | None = through("_simulation.scenario.workspace")
    """The polygon in which the robots move, or None."""
    bounds: tuple[float, float, float, float] = through("_simulation.scenario.bounds")
    """(xmin, xmax, ymin, ymax) of the workspace, metres."""
    obstacles: tuple[Outline, ...] = through("_simulation.engine.obstacles")
    """The outlines of all obstacles; obstacle k is -1 - k in contacts."""

    # -- this instant --------------------------------------------------------------------------

    iteration: int = through("_simulation.iteration")
    """The number of control steps done."""
    time: float = through("_simulation.time")
    """The simulated time, seconds: iteration x sampling time."""
    over: bool = through("_simulation.over")
    """Whether the experiment is over."""
    over_message: str = through("_simulation.over_message")
    """Why the experiment is over."""
    finished: bool = through("_simulation.finished")
    """Whether the experiment is over, and was not broken off."""
    pose: Float = through("_simulation.pose")
    """The poses (3, n): x, y [m], theta [rad, not wrapped]. Read only; new at each step."""
    position: Float = through("_simulation.position")
    """The positions (2, n): x, y [m]. Read only; new at each step."""
    velocity: Float = through("_simulation.velocity")
    """The robots' velocities (3, n) at this instant: x', y' [m/s], theta' [rad/s]."""
    prop_pose: Float = through("_simulation.prop_pose")
    """The poses of the props' centres of mass (3, p): x, y [m], theta [rad]. Read only."""
    prop_velocity: Float = through("_simulation.prop_velocity")
    """The velocities of the props (3, p): x', y' [m/s], theta' [rad/s]."""
    effort: Float = through("_simulation.effort")
    """The largest share of its bounds that each drive used in the last step, (n,), 0 to 1.

    It is 0 for a robot that nothing holds or pushes. At 1 the wheels slip.
    """
    command: Float = through("_simulation.command")
    """The last command (m, n) that was issued, after saturation; zeros at first. Read only."""
    contacts: NDArray[np.void] = through("_simulation.contacts")
    """The contacts since the last step, rows of dtype `mars2d.record.CONTACT`."""

    @property
    def geometric_center(self) -> Float:
        """The geometric centres (2, n) [m]: `Robot.center_offset` behind those of rotation."""
        offset = np.array([robot.center_offset for robot in self.scenario.robots])
        x, y, theta = self.pose
        c, s = cosines_sines(theta)
        return np.array([x - offset * c, y - offset * s])

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return the robots that ``Scenario.neighbours`` makes a robot's neighbours now."""
        return self._simulation.neighbour_indices(robot)

    # -- its parts -----------------------------------------------------------------------------

    robots: list[RobotView] = through("_simulation.robots")
    """The robots, with everything known of them."""
    props: tuple[PropView, ...] = through("_simulation.props")
    """The props."""
    addons: Addons = through("_simulation.addons")
    """The add-ons by name: ``world.addons.map``."""
    surroundings: Surroundings = through("_simulation.surroundings")
    """Answers sensors and add-ons: rays, distances, lines of sight, beacons."""
    rng: np.random.Generator = through("_simulation.rng")
    """The random stream of the team's law."""

    def stream(self, name: str) -> np.random.Generator:
        """Return a new random stream that depends on the seed and `name` alone."""
        return self._simulation.stream(name)

    # -- the run so far ------------------------------------------------------------------------

    history: History = through("_simulation.history")
    """The rows so far."""
    record: Record = through("_simulation.record")
    """The record so far."""

    @property
    def frame(self) -> Frame:
        """This instant, to be drawn; the readings are the last ones, see `observe`."""
        now = self._simulation
        return Frame(
            scenario=now.scenario,
            time=now.time,
            iteration=now.iteration,
            pose=now.pose,
            path=now.history.pose[: now.iteration],
            readings=now.readings,
            over_message=now.over_message,
            draw_addons=now.draw_addons,
            prop_pose=now.prop_pose,
            contacts=now.contacts,
            effort=now.effort,
            contact_log=now.recorder.contacts,
            prop_path=now.history.prop_pose[: now.iteration],
            messages=now.recorder.in_flight(now.time),
            command_path=now.history.command[: now.iteration],
            message_log=now.recorder.messages,
            exact_velocity=np.hstack([now.velocity, now.prop_velocity]),
            work=now.work,
            leaps=leaps_of(now.operator.log),
            read_row=now.observed,
        )

    # -- what may be done ----------------------------------------------------------------------

    def stop(self, why: str) -> None:
        """End the experiment, with the present control step, and say why."""
        self._simulation.stop(why)

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law says: it is out of the game.

        robot: its index or name. Raises InputError if there is none.
        """
        self._simulation.operator.hold(robot)

    def step(self, command: Any = None) -> None:
        """Do one control step.

        command: (m, n) to use in place of what the laws would command; or a dict of commands (m,)
        for some robots, by name or index, while the laws command the others: ``{"red": (1, 0)}``.
        Raises LawError when a law, sensor or add-on fails, and InputError for a command of another
        shape, within a step, as a law would call it, and when the experiment is over already.

        Add-ons and sensors see the instant before the step. `observe` shows them the one after it,
        such as a capture that the step has brought.
        """
        self._simulation.step(command)

    def fork(self, *, laws: bool = True) -> Self:
        """Return an independent world that goes on from this instant, to try out what would happen.

        It has no stop time, so that a plan may look beyond the end of the run. It records nothing
        and calls no watcher; whatever is done there changes nothing here. All
        that remembers is copied: laws that are objects, the robots' memories, add-ons, sensors,
        random streams. Functions are shared, with the variables around them. laws: False leaves the
        laws out, so robots stand still but for what `step` commands. Under the same commands all
        moves as here, to the bit. A law may call this, for a plan.

        Raises InputError, which names the law, add-on or sensor that can't be copied, such as a
        generator that runs.
        """
        return cast(Self, forked(self._simulation, laws=laws).world)

    def observe(self) -> None:
        """Call the add-ons and read the sensors for the present instant, as the next step would.

        All robots are sensed before any is commanded. To call it again does nothing.
        """
        self._simulation.observe()


class RobotPositionView(PositionsView):
    """A robot, as a team's law sees it that sees positions only."""

    pose = unseen("robot.pose", "positions", "robot.position")
    velocity = unseen("robot.velocity", "positions", "robot.position")
    contacts = unseen("robot.contacts", "positions", "robot.position")
    world = unseen("robot.world", "positions")


class TeamPositionsView:
    """A running world, as a team's law sees it that sees positions only."""

    def __init__(self, simulation: Simulation) -> None:
        """Take what is behind the world, of which only this is shown."""
        self._simulation = simulation
        self.robots = tuple(
            RobotPositionView(simulation, i, mind) for i, mind in enumerate(simulation.minds)
        )

    def __getattr__(self, name: str) -> NoReturn:
        if hasattr(WorldView, name) and not name.startswith("__"):
            raise LawError(
                f"this law sees positions only: world.{name} is not available; "
                "there is world.position"
            )
        unknown(self, "a world", name, "robots")

    time, sampling_time, iteration = WorldView.time, WorldView.sampling_time, WorldView.iteration
    workspace, bounds, obstacles = WorldView.workspace, WorldView.bounds, WorldView.obstacles
    command, effort = WorldView.command, WorldView.effort
    addons, rng, stop = WorldView.addons, WorldView.rng, WorldView.stop

    def __repr__(self) -> str:
        return printed(self, self.robots)

    @property
    def position(self) -> Float:
        """The positions (2, n): x, y [m]."""
        return alone(self._simulation.position)
