"""The machinery behind a World: the control step, and how a running world is changed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, partial
from time import perf_counter
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mars2d.addons.communication import Communication
from mars2d.bodies.delay import DelayLine
from mars2d.bodies.team import Drives
from mars2d.core.arrays import locked
from mars2d.core.description import whole
from mars2d.core.errors import InputError, LawError
from mars2d.core.hints import described
from mars2d.core.interfaces import WorldLike
from mars2d.core.scene import Scene
from mars2d.record.columns import DiskError
from mars2d.record.contact import met, met_or_parted
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.sensing import Device, Sensing
from mars2d.sensors.surroundings import Surroundings
from mars2d.world.channel import Channel
from mars2d.world.laws import Laws, refuse, robot_command, team_command
from mars2d.world.operator import Operator
from mars2d.world.record import Record
from mars2d.world.room import Room
from mars2d.world.state import Addons, Hooks, State
from mars2d.world.views import VIEWS, Mind, PropView, RobotView

Float = NDArray[np.float64]
Control = Callable[[Any], Any]
T = TypeVar("T")

REST = 32
"""After so many control steps the engine rests, see `Motion.rest`: a fork repeats fewer of them."""


class Simulation(State):
    """A live simulation: its state, and everything that steps and changes it.

    Users have a `World`, which passes their calls on to here. Laws have a `WorldView`, which leads
    nowhere else.

    declared: the scenario with its `random_starts`. operator: does to the world what is done from
    outside. laws: of the team and of single robots. drives: limit commands, and turn them to
    motion. watch: called with the world between sensing and control. world: the World that add-ons
    and watchers are called with. view: the world as laws may see it. seconds: of the wall clock
    that physics, laws and sensing, with add-ons, have taken by now. endless: whether the stop time
    does not end it, as in a fork. error: of a law, sensor or add-on, which has ended it.
    """

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        filename: str,
        record: bool,
        options: Mapping[str, Any],
    ) -> None:
        """Put the bodies where they start. `begin` adds laws, add-ons and sensors."""
        self.declared, scenario = scenario, scenario.started(seed)
        super().__init__(scenario, seed, record, options)
        self.filename = whole(filename)
        self.watch: Callable[[Any], None] | None = None
        self.seconds = {"physics": 0.0, "laws": 0.0, "sensing": 0.0}
        self.endless = False
        self.error: LawError | None = None
        self._drawn = Scene()  # by the add-ons, at the end
        self._stepping = True  # until `begin` is done
        self.observed = -1  # the iteration that add-ons and sensors were last called for
        self.operator = Operator(self)
        n = len(scenario.robots)
        drives = {str(robot.name): robot.drive for robot in scenario.robots}
        still = locked(np.zeros((scenario.inputs, n)))
        self.drives = Drives(drives, scenario.sampling_time, self.stream, still)
        delay = scenario.command_delay + self.drives.dead_time
        self._delay = DelayLine(delay, scenario.sampling_time, still) if delay.any() else None
        self._inputs = [drive.inputs for drive in drives.values()]
        self.props = tuple(PropView(self, i) for i in range(len(scenario.props)))
        self.minds = [Mind(str(robot.name), self.stream) for robot in scenario.robots]
        self.robots = [RobotView(self, i, mind) for i, mind in enumerate(self.minds)]
        self.laws = Laws(still, self._inputs)
        self._channel: Channel | None = None

    def begin(
        self, world: WorldLike, view: WorldLike, team_view: Any, control: Control | None
    ) -> None:
        """Take the laws, the add-ons and the sensors, and call the add-ons' `on_start`.

        world: what add-ons and watchers are called with. view: ``robot.world`` of a law that sees
        all. team_view: what the team's law is called with.
        """
        self.world, self.view, self._team_view = world, view, team_view
        self._take_scenario({}, control)
        live = vars(self.addons).values()
        talk = next((addon for addon in live if isinstance(addon, Communication)), None)
        self._channel = None if talk is None else Channel(self, talk)
        self._hooks.call("on_start", world)
        around = self.surroundings  # sensors know all of the world, whatever the laws see
        self.sensing = Sensing(
            [
                Device(sensor, view, around, self.stream)
                for robot, view in zip(self.scenario.robots, self.robots, strict=True)
                for sensor in robot.sensors
            ]
        )
        self._stepping = False
        if self.over:  # an add-on has stopped it at once
            self._close()

    def _take_scenario(self, there: dict[str, Any], control: Control | None) -> None:
        """Take the scenario's workspace, add-ons and laws; those that are there already go on.

        there: the live add-ons that stay, by name.
        """
        scenario = self.scenario
        self._room: Room | None = None
        if scenario.workspace is not None and scenario.on_exit == "stop":
            self._room = Room(scenario.workspace, len(scenario.robots))
        self.laws.renew(
            control,
            self._team_view,
            [robot.controller for robot in scenario.robots],
            lambda i: VIEWS[scenario.robots[i].sees](self, i, self.minds[i]),
        )
        self.addons = Addons.of(scenario.addons, there, self.stream)
        self._hooks = Hooks(self.addons)

    # -- what there is -------------------------------------------------------------------------

    @property
    def channel(self) -> Channel:
        """What carries the robots' messages. Raises LawError if they have nothing to talk by."""
        if self._channel is None:
            raise LawError("robots can't talk: add Communication() to Scenario.addons")
        return self._channel

    @property
    def drives_at_once(self) -> bool:
        """Whether its drives follow commands at once and exactly, so that they keep nothing."""
        return self.drives.exact and self._delay is None

    @property
    def calls(self) -> tuple[int, int]:
        """What changes with each control step, and with each law that is asked."""
        return self.iteration, self.laws.calls

    @property
    def record(self) -> Record:
        """The record so far; the present state is its last row once the run is over."""
        return Record.of(
            self.recorder.record(
                self.seed,
                self.over_message if self.over else "not over",
                self.finished,
                self.filename,
                Scene([*self._drawn.shapes]),
                self.operator.log,
            )
        )

    @property
    def readings(self) -> dict[str, list[tuple[int, Any]]]:
        """The last readings by the sensors' names: (robot, reading)."""
        readings: dict[str, list[tuple[int, Any]]] = {}
        for device in self.sensing.devices:
            if device.reading is not None:
                readings.setdefault(device.key, []).append((device.robot, device.reading))
        return readings

    @cached_property
    def surroundings(self) -> Surroundings:
        """What answers sensors and add-ons."""
        return Surroundings(self)

    def draw_addons(self, scene: Scene) -> None:
        """Let the add-ons draw the world as it is now."""
        self._hooks.call("on_draw", self.world, scene)

    # -- the control step ------------------------------------------------------------------------

    def step(self, command: Any = None) -> None:
        """Do one control step, see `WorldView.step`."""
        if self.over:
            raise InputError(f"the experiment is over: {self.over_message}")
        self._alone(self._control_step, command)

    def follow(self, command: Float) -> Float:
        """Do one control step under a command (m, n) that is known from before.

        The laws are asked all the same, so that they remember what they did then. Returns the
        commands (m, n) that the laws ask for now, limited by the drives.
        """
        return self._alone(self._follow, command)

    def _follow(self, command: Any) -> Float:
        asked = self._saturate(self._decide(None))
        self._carry_out(self._saturate(self.operator.command(command.copy())))
        return asked

    def observe(self) -> None:
        """Call the add-ons and read the sensors, see `WorldView.observe`."""
        if self.observed != self.iteration and not self.over:
            self._alone(self._observe)
            if self.over:  # an add-on has stopped it
                self._close()

    def stop(self, why: str) -> None:
        """End the experiment with the present control step."""
        if not self.over:
            self.over, self.over_message = True, whole(str(why))
            if not self._stepping:
                self._close()

    def break_off(self, why: str) -> None:
        """End the experiment at once, without a last control step, as after an error."""
        if not self.over:
            self.over, self.over_message, self.broken_off = True, whole(str(why)), True

    def _alone(self, act: Callable[..., T], *arguments: Any) -> T:
        """Act on the world. Refuse to from within such an act; an error ends the experiment."""
        self.refuse_within_step("step")
        self._stepping = True
        try:
            return act(*arguments)
        except (LawError, DiskError) as error:
            if isinstance(error, LawError):
                self.error = error
                error.where = error.where or self.filename or None
                error.time = self.time if error.time is None else error.time
            self.break_off(f"Error: {error}")
            error.record = self.record if self.recorder.keeps else None
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

    def refuse_within_step(self, call: str) -> None:
        """Raise InputError within a step, where a call would interfere with it."""
        if self._stepping:
            raise InputError(
                f"world.{call}() was called from within a step: by a law, sensor or add-on"
            )

    def _close(self) -> None:
        """Do the control step that ends the experiment."""
        self._alone(self._control_step, None)

    def _control_step(self, command: Any) -> None:
        """Do one pass of the loop of MARS's Algorithm 1."""
        self._carry_out(self._saturate(self._decide(command)))

    def decide(self, command: Any) -> Float:
        """Do the first part of a control step, before the drives are asked; see `Abreast`."""
        return self._alone(self._decide, command)

    def carry_out(self, command: Float, twist: Float) -> None:
        """Do the second part, under a command that drives can follow, and the twists (3, n)."""
        self._alone(self._carry_out, command, twist)

    def _decide(self, command: Any) -> Float:
        """Observe, and return the commands (m, n) that are wanted."""
        self._observe()
        if self.watch is not None:
            self.watch(self.world)
        start = perf_counter()
        if command is None or isinstance(command, Mapping):
            wanted = self.laws.commands(self._named(command or {}))
        else:
            wanted = team_command(command, self.command, partial(refuse, "World.step(command)"))
        self.seconds["laws"] += perf_counter() - start
        return self.operator.command(wanted)

    def _carry_out(self, command: Float, twist: Float | None = None) -> None:
        """Issue a command (m, n), and move under it, unless it ends here."""
        self.command = locked(command)
        self._write_row()
        self._check_workspace()
        self._check_contacts()
        if self.iteration >= self.scenario.last_iteration and not self.endless:
            self.stop(f"finished after {self.time:g} s")
        if self.over:
            self._hooks.call("on_stop", self.world)
            self.draw_addons(self._drawn)
        else:
            self._drive(twist)
        if self._channel is not None:
            self._channel.transmit()

    def _observe(self) -> None:
        if self.observed != self.iteration:
            self.observed, start = self.iteration, perf_counter()
            if self._channel is not None:
                self._channel.deliver()
            self.sensing.hide()
            if len(self.contacts) and self._hooks.defines("on_contact"):
                for contact in self.contacts[met_or_parted(self.contacts)]:
                    self._hooks.call("on_contact", self.world, contact)
            self._hooks.call("on_step", self.world)
            self.sensing.step(self.iteration)
            self._hooks.call("on_sensed", self.world)
            self.seconds["sensing"] += perf_counter() - start

    def _named(self, commands: Mapping[Any, Any]) -> dict[int, tuple[float, ...]]:
        """Return the commands that are given for some robots, by index."""
        found: dict[int, tuple[float, ...]] = {}
        for robot, command in commands.items():
            i = self.scenario.index_of("World.step", robot)
            say = partial(refuse, f"World.step: the command of {robot}")
            found[i] = robot_command(command, self._inputs[i], say)
        return found

    def _saturate(self, command: Float) -> Float:
        """Limit the commands (m, n) to those that each drive can follow after the last ones."""
        return self.drives.limit(command, self.command)

    def _write_row(self) -> None:
        time = self.time
        velocity, prop_velocity, work = self.look()
        self.recorder.write(
            self.sensing.recorded(),
            time=time,
            pose=self.pose,
            command=self.command,
            command_time=time + self.scenario.command_delay,
            prop_pose=self.prop_pose,
            effort=self.effort,
            velocity=velocity,
            prop_velocity=prop_velocity,
            work=work,
        )

    def _check_workspace(self) -> None:
        """End the experiment when a robot's centre has left the workspace, if that is asked for."""
        gone = self._room.left(self.pose[:2]) if self._room is not None else ()
        if gone:
            name, (x, y) = self.scenario.robots[gone[0]].name, self.pose[:2, gone[0]]
            self.stop(f"Out of bounds: {name} left the workspace at ({x:.3g}, {y:.3g})")

    def _check_contacts(self) -> None:
        """End the experiment after a touch by which it ends."""
        scenario = self.scenario
        if scenario.stop_on is None or not len(self.contacts):
            return
        for contact in self.contacts[met(self.contacts)]:
            a, b = int(contact["a"]), int(contact["b"])
            if scenario.ends_by(a, b):
                names = f"{scenario.body_name(a)} and {scenario.body_name(b)}"
                self.stop(f"Contact: {names} touched at {contact['time']:.4g} s")
                return

    def _drive(self, twist: Float | None) -> None:
        """Move the robots for one sampling time under the commands in effect, or twists (3, n)."""
        time = self.time
        self.driven = []
        start = perf_counter()
        for part, now in self._twists() if twist is None else [(self.sampling_time, twist)]:
            self.driven.append((part, now))
            self.operator.drive(self.engine, now, part, time)
            time += part
        reached = self.drives.reached()
        if reached is not None:
            self.engine.ask(reached)
        self.seconds["physics"] += perf_counter() - start
        self.contacts = locked(self.engine.take_contacts())
        self.recorder.write_contacts(self.contacts)
        self.take_poses()
        self.effort = locked(self.engine.take_effort())
        self.iteration += 1
        if self.iteration % REST == 0:
            self.engine.rest()

    def _twists(self) -> Iterator[tuple[float, Float]]:
        """Yield the twists (3, n) that the drives ask for, each with the seconds that it holds."""
        self.drives.draw()
        now = [(self.sampling_time, self.command)]
        for part, command in now if self._delay is None else self._delay.send(self.command):
            yield from self.drives.drive(command, part)

    # -- changes while it runs -------------------------------------------------------------------

    def go_on(
        self,
        scenario: Scenario,
        control: Control | None,
        moved: Mapping[int, tuple[float, float, float]] | None,
    ) -> None:
        """Go on with another scenario, checked before; laws and add-ons that stay remember.

        moved: poses of bodies that stand still elsewhere, by index; None: all move on as they do.
        """
        same = {addon.key for addon in self.scenario.addons if addon in scenario.addons}
        self.scenario = scenario
        self.drives.renew({str(robot.name): robot.drive for robot in scenario.robots})
        there = {key: addon for key, addon in vars(self.addons).items() if key in same}
        self._take_scenario(there, control)
        if moved is not None:
            self.move(moved)

    def move(self, moved: Mapping[int, tuple[float, float, float]]) -> None:
        """Go on with some bodies standing still at other poses, by index."""
        self.engine = self.engine.changed(self.scenario, moved)
        self._take_engine()

    def resume(self) -> None:
        """Go on with an engine that was put here, also from within a step of the one before."""
        for array in (self.command, self.effort, self.contacts):  # copies can be written
            locked(array)
        self._take_engine()
        self._stepping = False
