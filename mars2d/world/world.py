"""The live simulation: a world that is stepped."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cached_property, partial
from types import SimpleNamespace
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.base import HOOKS, Addon, hooks_of
from mars2d.addons.communication import Communication
from mars2d.bodies.team import Drives
from mars2d.core import checks
from mars2d.core.delay import DelayLine
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, LawError, UnknownNameError, described, nearest
from mars2d.core.plane import Outline, outside_polygon
from mars2d.core.scene import Scene
from mars2d.core.streams import check_seed, stream
from mars2d.core.usercode import called
from mars2d.physics.engine import Engine
from mars2d.physics.kinematics import Kinematics
from mars2d.physics.motion import Start
from mars2d.physics.settings import versions
from mars2d.record.columns import Column, DiskError, Storage
from mars2d.record.contact import CONTACT
from mars2d.record.frame import Frame
from mars2d.record.interventions import Change
from mars2d.record.record import Record
from mars2d.record.recorder import History, Recorder
from mars2d.scenario.changes import check_same, with_poses
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.sensing import Device, Sensing
from mars2d.world.channel import Channel
from mars2d.world.laws import Law, commands, team_command
from mars2d.world.operator import Hands
from mars2d.world.surroundings import Around
from mars2d.world.views import VIEWS, Mind, PropView, RobotView, TeamPositionsView

__all__ = ["World"]

ENGINES: dict[str, type[Engine | Kinematics]] = {
    "contact": Engine,
    "stop": Kinematics,
    "ideal": Kinematics,
}
"""What moves the bodies, by Scenario.physics."""

Float = NDArray[np.float64]
Watcher = Callable[["World"], None]


class Addons(SimpleNamespace):
    """The add-ons of a world by name: ``world.addons.map``."""

    def __getattr__(self, name: str) -> NoReturn:
        raise UnknownNameError(f"this world has no add-on {name!r}{nearest(name, vars(self))}")


class World:
    """One live simulation. Worlds share nothing: two in one process are independent.

    >>> from mars2d import Robot, Scenario
    >>> world = World(Scenario(robots=[Robot(pose=(0, 0, 0))], sampling_time=1.0))
    >>> world.step([[0.2], [0.0]])
    >>> world.pose[:, 0].tolist()
    [0.2, 0.0, 0.0]

    scenario: what is simulated. control: the law of the whole team, a function or generator of the
    world; a robot's own controller overrides its column. seed: of all random streams. filename:
    the experiment's file, for the record. watch: called with the world once a control step, between
    sensing and control: to draw, to wait, to count. storage: what keeps the columns of the record,
    in memory or, with `mars2d.record.columns.Scratch`, in files.

    over: whether the experiment is over, and over_message why. watch may be set anew.
    """

    def __init__(
        self,
        scenario: Scenario,
        control: Callable[[World], Any] | None = None,
        seed: int = 0,
        *,
        filename: str = "",
        watch: Watcher | None = None,
        storage: Storage = Column,
    ) -> None:
        if not isinstance(scenario, Scenario):
            raise wrong("World.scenario", scenario, "a Scenario")
        self.scenario = scenario
        self.seed = check_seed(seed)
        self.filename = filename
        self.watch = watch
        self.iteration = 0
        self.over = False
        self.over_message = ""
        self._finished = True  # unless broken off
        self._drawn = Scene()  # by the add-ons, at the end
        self._stepping = True  # until all is built
        self._observed = -1  # the iteration that add-ons and sensors were last called for
        self._engine = ENGINES[scenario.physics](scenario)
        self.recorder = Recorder(scenario, storage, versions)
        self.history = History(self.recorder)
        self.hands = Hands(self)
        self._workspace = None if scenario.workspace is None else np.array(scenario.workspace)
        n = len(scenario.robots)
        drives = {str(robot.name): robot.drive for robot in scenario.robots}
        self._drives = Drives(drives, scenario.sampling_time, self.stream)
        delay = scenario.command_delay + self._drives.dead_time
        self._delay = DelayLine(delay, scenario.sampling_time, n)
        self._still = np.zeros((2, n))
        self._command = _frozen(self._still)
        self._take_state()
        self._velocity_at = -1, self._pose
        self._contacts = np.empty(0, dtype=CONTACT)
        self._effort = _frozen(np.zeros(n))
        self.props = tuple(PropView(self, i) for i in range(len(scenario.props)))
        self._minds = [Mind(self, str(robot.name)) for robot in scenario.robots]
        self.robots = [RobotView(self, i, mind) for i, mind in enumerate(self._minds)]
        self._neighbours: tuple[int, Sequence[Sequence[int]]] = (-1, ())
        self._driven: list[tuple[float, Float]] = []
        self._own: list[tuple[int, Law]] = []
        self._central: Law | None = None
        self._build_laws(control)
        self._build_addons()
        self._build_sensors()
        self._stepping = False
        if self.over:  # an add-on has stopped it at once
            self._close()

    def _build_sensors(self) -> None:
        """Put the sensors on the robots; they know all of the world, whatever the laws see."""
        around = self.surroundings
        self._sensing = Sensing(
            [
                Device(sensor, view, around, self.stream)
                for robot, view in zip(self.scenario.robots, self.robots, strict=True)
                for sensor in robot.sensors
            ]
        )

    def _build_laws(self, control: Callable[[World], Any] | None) -> None:
        """Take the laws of the scenario and of the team; those that are there already go on."""
        own = dict(self._own)
        self._own = []
        for i, robot in enumerate(self.scenario.robots):
            if robot.controller is not None:
                law = own.get(i)
                if law is None or law.function is not robot.controller:
                    law = Law(robot.controller, VIEWS[robot.sees](self, i, self._minds[i]))
                self._own.append((i, law))
        if control is None:
            self._central = None
        elif self._central is None or self._central.function is not control:
            checks.law("control", control, "the world")
            partial = self.scenario.sees == "positions"
            seen = TeamPositionsView(self, self._minds) if partial else self
            self._central = Law(control, seen, self._still)

    def _take_addons(self, there: Mapping[str, Addon]) -> None:
        """Take the scenario's add-ons; those that are there already, by name, go on."""
        live = {
            a.key: there.get(a.key) or a.live(rng=self.stream(f"add-on {a.key}"))
            for a in self.scenario.addons
        }
        self.addons = Addons(**live)
        # Only hooks that an add-on has of its own are called.
        self._hooks = {
            hook: [(key, getattr(a, hook)) for key, a in live.items() if hook in hooks_of(a)]
            for hook in HOOKS
        }

    def _build_addons(self) -> None:
        self._take_addons({})
        live = vars(self.addons).values()
        talk = next((a for a in live if isinstance(a, Communication)), None)
        self._channel = None if talk is None else Channel(self, talk, self.recorder)
        self._call("on_start", self)

    # -- what laws, sensors and add-ons may ask ------------------------------------------------

    @property
    def time(self) -> float:
        """The simulated time, seconds: iteration x sampling time."""
        return self.iteration * self.scenario.sampling_time

    @property
    def finished(self) -> bool:
        """Whether the experiment is over, and was not broken off."""
        return self.over and self._finished

    @property
    def sampling_time(self) -> float:
        """The time from one command to the next, seconds."""
        return self.scenario.sampling_time

    @property
    def pose(self) -> Float:
        """The poses (3, n): x, y [m], theta [rad, not wrapped]. Read only; new at each step."""
        return self._pose

    @property
    def position(self) -> Float:
        """The positions (2, n): x, y [m]. Read only; new at each step."""
        return self._pose[:2]

    @property
    def velocity(self) -> Float:
        """The robots' velocities (3, n) at this instant: x', y' [m/s], theta' [rad/s]."""
        return self._velocity[:, : self._pose.shape[1]]

    @property
    def prop_pose(self) -> Float:
        """The poses of the props' centres of mass (3, p): x, y [m], theta [rad]. Read only."""
        return self._prop_pose

    @property
    def prop_velocity(self) -> Float:
        """The velocities of the props (3, p): x', y' [m/s], theta' [rad/s]."""
        return self._velocity[:, self._pose.shape[1] :]

    @property
    def _velocity(self) -> Float:
        """The velocities of all bodies (3, N), asked of the engine once a control step."""
        if self._velocity_at[0] != self.iteration:
            self._velocity_at = self.iteration, _frozen(self._engine.velocity)
        return self._velocity_at[1]

    @property
    def effort(self) -> Float:
        """The largest share of its bounds that each drive used in the last step, (n,), 0 to 1.

        Of a robot that nothing holds or pushes it is 0. At 1 the wheels slip.
        """
        return self._effort

    @property
    def geometric_center(self) -> Float:
        """The geometric centres (2, n) [m]: `Robot.center_offset` behind those of rotation."""
        offset = np.array([robot.center_offset for robot in self.scenario.robots])
        x, y, theta = self._pose
        return np.array([x - offset * np.cos(theta), y - offset * np.sin(theta)])

    @property
    def command(self) -> Float:
        """The last command (2, n) that was issued, after saturation; zeros at first. Read only."""
        return self._command

    @property
    def contacts(self) -> NDArray[np.void]:
        """The contacts since the last step, one row a pair, of dtype `mars2d.record.CONTACT`."""
        return self._contacts

    @property
    def workspace(self) -> Outline | None:
        """The polygon in which the robots move, or None."""
        return self.scenario.workspace

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """(xmin, xmax, ymin, ymax) of the workspace, metres."""
        return self.scenario.bounds

    @property
    def obstacles(self) -> tuple[Outline, ...]:
        """The outlines of all obstacles; obstacle k is -1 - k in contacts."""
        return self._engine.space.obstacles

    @cached_property
    def rng(self) -> np.random.Generator:
        """The random stream of the team's law."""
        return self.stream("control")

    def stream(self, name: str) -> np.random.Generator:
        """Return a new random stream that depends on the seed and `name` alone."""
        return stream(self.seed, name)

    def stop(self, why: str) -> None:
        """End the experiment, with the present control step, and say why."""
        if not self.over:
            self.over, self.over_message = True, str(why)
            if not self._stepping:
                self._close()

    def hold(self, robot: str | int) -> None:
        """Let a robot stand still from now on, whatever its law says: it is out of the game.

        robot: its index or name. Raises InputError if there is none.
        """
        self.hands.hold(robot)

    def break_off(self, why: str) -> None:
        """End the experiment at once, without a last control step, as after an error."""
        if not self.over:
            self.over, self.over_message, self._finished = True, str(why), False

    def neighbour_indices(self, robot: int) -> Sequence[int]:
        """Return whom ``Scenario.neighbours`` makes neighbours of a robot now, by index."""
        asked, found = self._neighbours
        rule = self.scenario.neighbours
        if asked < 0 or (asked != self.iteration and not rule.fixed):
            with called("Scenario.neighbours", rule.of):
                found = rule.of(self.position)
            self._neighbours = self.iteration, found
        return found[robot]

    @property
    def channel(self) -> Channel:
        """What carries the robots' messages. Raises LawError if they have nothing to talk by."""
        if self._channel is None:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self._channel

    @cached_property
    def surroundings(self) -> Around:
        """What answers sensors and add-ons: rays, distances, what hides what, beacons."""
        return Around(self, self._engine.space)

    @property
    def driven(self) -> Sequence[tuple[float, Float]]:
        """What the drives asked of the wheels in the last control step; see Surroundings."""
        return self._driven

    # -- the control step ----------------------------------------------------------------------

    def step(self, command: Any = None) -> None:
        """Do one control step.

        command: (2, n) to use in place of what the laws would command. Raises LawError when a law,
        sensor or add-on fails, and InputError when the experiment is over already.
        """
        if self.over:
            raise InputError(f"the experiment is over: {self.over_message}")
        with self._busy():
            self._control_step(command)

    def follow(self, command: Any) -> Float:
        """Do one control step under a command (2, n) that is known from before.

        The laws are asked all the same, so that they remember what they did then. Returns the
        commands (2, n) that would be given by what they ask for.
        """
        with self._busy():
            return self._control_step(command, ask=True)

    def observe(self) -> None:
        """Call the add-ons and read the sensors for the present instant, as the next step would.

        All robots are sensed before any is commanded. To be called again does nothing.
        """
        if self._observed != self.iteration and not self.over:
            with self._busy():
                self._observe()
            if self.over:  # an add-on has stopped it
                self._close()

    @contextmanager
    def _busy(self) -> Iterator[None]:
        """Refuse to be entered from within; what breaks a step off ends the experiment."""
        if self._stepping:
            raise InputError(
                "world.step() was called from within a step: by a law, sensor or add-on"
            )
        self._stepping = True
        try:
            yield
        except (LawError, DiskError) as error:
            if isinstance(error, LawError):
                error.where = error.where or self.filename or None
            self.break_off(f"Error: {error}")
            error.record = self.record
            raise
        except InputError:  # of what was given to step(): it may be called again
            raise
        except KeyboardInterrupt:
            self.break_off("Interrupted by Ctrl-C")
            raise
        except BaseException as error:  # a step that was not finished can't be gone on from
            self.break_off(f"Error: {described(error)}")
            raise
        finally:
            self._stepping = False

    def _close(self) -> None:
        """Do the control step that ends the experiment."""
        with self._busy():
            self._control_step(None)

    def _control_step(self, command: Any, *, ask: bool = False) -> Float:
        """Do what MARS's Algorithm 1 does in one pass of its loop; return what laws ask for."""
        self._observe()
        if self.watch is not None:
            self.watch(self)
        wanted = asked = self._still if command is None else self._given(command)
        if ask or command is None:
            asked = self._ask_laws()
            wanted = asked if command is None else wanted
        if ask:
            asked = self._saturate(self.hands.command(asked))
        self._command = _frozen(self._saturate(self.hands.command(wanted)))
        self._write_row()
        self._check_workspace()
        if self.iteration >= self.scenario.last_iteration:
            self.stop(f"Time is over: {self.time:g} s")
        if self.over:
            self._call("on_stop", self)
            self._draw_addons(self._drawn)
        else:
            self._drive()
        if self._channel is not None:
            self._channel.transmit()
        return asked

    def _observe(self) -> None:
        if self._observed != self.iteration:
            self._observed = self.iteration
            if self._channel is not None:
                self._channel.deliver()
            self._sensing.hide()
            self._call("on_step", self)
            self._sensing.step(self.iteration)
            self._call("on_sensed", self)

    @property
    def _readings(self) -> dict[str, list[tuple[int, Any]]]:
        """The readings at this control step by the sensors' names: (robot, reading)."""
        readings: dict[str, list[tuple[int, Any]]] = {}
        for device in self._sensing.devices:
            if device.reading is not None:
                readings.setdefault(device.key, []).append((device.robot, device.reading))
        return readings

    def _call(self, hook: str, *args: Any) -> None:
        for key, method in self._hooks[hook]:
            with called(f"add-on {key!r}", method):
                method(*args)

    def _ask_laws(self) -> Float:
        return commands(self._central, self._own, self._still)

    def _given(self, command: Any) -> Float:
        def refuse(message: str) -> NoReturn:
            raise InputError(f"World.step(command) {message.replace('returned', 'was given', 1)}")

        return team_command(command, self._still.shape[1], refuse)

    def _saturate(self, command: Float) -> Float:
        """Limit the commands (2, n) to what each robot's drive can do after the last ones."""
        return self._drives.limit(command, self._command)

    def _write_row(self) -> None:
        takes_effect = self.time + self.scenario.command_delay
        self.recorder.write(
            self.time,
            pose=self._pose,
            command=self._command,
            command_time=takes_effect,
            prop_pose=self._prop_pose,
            effort=self._effort,
            readings=self._sensing.recorded(),
        )

    def _check_workspace(self) -> None:
        """End the experiment when a robot's centre has left the workspace, if that is asked for."""
        if self._workspace is None or self.scenario.on_exit != "stop":
            return
        x, y = self._pose[:2]
        outside = np.flatnonzero(outside_polygon(x, y, self._workspace))
        if len(outside):
            i = int(outside[0])
            name = self.scenario.robots[i].name
            self.stop(f"Out of bounds: {name} left the workspace at ({x[i]:.3g}, {y[i]:.3g})")

    def _drive(self) -> None:
        """Move the robots for one sampling time under the commands in effect."""
        self._sensing.close()
        time = self.time
        self._drives.draw()
        self._driven = []
        for duration, command in self._delay.send(self._command):
            twist = self._drives.twist(command)
            self._driven.append((duration, twist))
            self.hands.drive(self._engine, twist, duration, time)
            time += duration
        self._contacts = _frozen(self._engine.take_contacts())
        self.recorder.write_contacts(self._contacts)
        self._take_state()
        self._effort = _frozen(self._engine.take_effort())
        self.iteration += 1

    def _take_state(self) -> None:
        """Take the poses of robots and props from the engine."""
        n = len(self.scenario.robots)
        pose = _frozen(self._engine.pose)
        self._pose, self._prop_pose = pose[:, :n], pose[:, n:]

    # -- changes while it runs --------------------------------------------------------------------

    @property
    def control(self) -> Callable[[World], Any] | None:
        """The law of the team."""
        return None if self._central is None else self._central.function

    @property
    def motion(self) -> Start:
        """How everything moves at this instant."""
        return self._engine.motion

    def change(
        self,
        scenario: Scenario,
        control: Callable[[World], Any] | None = None,
        moved: Mapping[int, tuple[float, float, float]] | None = None,
    ) -> None:
        """Go on with another scenario from now on: other obstacles, another workspace, other laws.

        Bodies stay where they are, and laws that are the same keep what they remember. control: the
        law of the team from now on, `world.control` for the one that it has. moved: poses of bodies
        that are put elsewhere with it, by index in `Scenario.bodies`. Raises InputError where
        something in `scenario` is different that needs a new start, such as a robot, a sensor or
        the sampling time, and where a body would be in an obstacle.
        """
        moved = dict(moved or {})
        check_same(self.scenario, scenario)
        if control is not None:
            checks.law("control", control, "the world")
        self.observe()
        start = self.motion.moved(moved)
        moves_on = not moved and scenario.surfaces == self.scenario.surfaces
        changed = scenario if moves_on else with_poses(scenario, start.state[:, :3].T)
        self.hands.log.append(Change(self.iteration, scenario, tuple(moved.items()), control))
        same = {a.key for a in self.scenario.addons if a in changed.addons}
        self.scenario = changed
        self._workspace = None if changed.workspace is None else np.array(changed.workspace)
        self._take_addons({key: a for key, a in vars(self.addons).items() if key in same})
        self._build_laws(control)
        if moves_on:
            self.surroundings.renew(self._engine.space)
        else:
            self.rebuild(start)

    def rebuild(self, start: Start) -> None:
        """Go on with everything moving like this."""
        self._engine = ENGINES[self.scenario.physics](self.scenario, start)
        self._take_state()
        self._velocity_at = -1, self._pose
        self.surroundings.renew(self._engine.space)

    # -- what comes out ------------------------------------------------------------------------

    @property
    def record(self) -> Record:
        """The record so far."""
        return self.recorder.record(
            self.seed,
            self.over_message if self.over else "not over",
            self.finished,
            self.filename,
            Scene([*self._drawn.shapes]),
            self.hands.log,
        )

    @property
    def frame(self) -> Frame:
        """What is seen now; the readings are the last ones, see `observe`."""
        return Frame(
            scenario=self.scenario,
            time=self.time,
            iteration=self.iteration,
            pose=self._pose,
            path=self.history.pose[: self.iteration],
            readings=self._readings,
            over_message=self.over_message,
            draw_addons=self._draw_addons,
            prop_pose=self._prop_pose,
            contacts=self._contacts,
            effort=self._effort,
            contact_log=self.recorder.contacts,
            prop_path=self.history.prop_pose[: self.iteration],
            effort_path=self.history.effort[: self.iteration],
            messages=self.recorder.in_flight(self.time),
            command_path=self.history.command[: self.iteration],
            message_log=self.recorder.messages,
            reading_path=partial(self.recorder.readings, self.iteration),
        )

    def _repr_svg_(self) -> str:
        """Return a picture of what is seen now, for a notebook."""
        from mars2d.output.pages.notebook import world_svg

        return world_svg(self)

    def _draw_addons(self, scene: Scene) -> None:
        self._call("on_draw", self, scene)


def _frozen(array: NDArray[Any]) -> NDArray[Any]:
    """Return a view that can't be written."""
    view = array.view()
    view.flags.writeable = False
    return view
