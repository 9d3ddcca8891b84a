"""Changes that a person makes to a run: moving bodies, driving a robot, drawing, branching."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pygame

from mars2d.core.errors import InputError, counted
from mars2d.scenario.changes import carried, with_poses
from mars2d.scenario.controllers import standing_still
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.scenario import Scenario
from mars2d.window.run.driver import ARROWS, LETTERS, Driver
from mars2d.window.screen.looks import Looks
from mars2d.window.screen.player import Player
from mars2d.window.screen.source import RECORDING
from mars2d.window.widgets.notes import Notes
from mars2d.world.branch import Progress
from mars2d.world.timeline import Timeline
from mars2d.world.world import World

if TYPE_CHECKING:
    from mars2d.window.editor import Editor, Outcome


class Director:
    """Changes a player's run at the instant that is shown, or says why it can't be changed.

    A change in the past makes a new branch of the run. show_way_back: shows the progress of going
    back, and returns whether to continue.
    """

    def __init__(self, player: Player, notes: Notes, show_way_back: Progress) -> None:
        self._player, self._notes, self._show_way_back = player, notes, show_way_back
        self.timeline = player.source if isinstance(player.source, Timeline) else None
        self.drivers: Sequence[Driver] = (Driver(),)  # one for each person
        if self.timeline is not None:
            player.error = self.timeline.error

    @contextmanager
    def _showing(self, timeline: Timeline) -> Iterator[None]:
        """Show what is done to the run meanwhile; say that a branch begins, and a doubt."""
        back, branch, others = timeline.needs_way_back, timeline.branch, len(timeline.others)
        try:
            yield
        finally:
            self._player.error = timeline.error
            if back or not (self._player.playing and timeline.newest):
                self._player.settle()  # otherwise time goes on from where it is
        if timeline.branches and len(timeline.others) > others:
            self._notes.say("a new branch begins here; B shows what was run before")
        if timeline.branch is not branch and timeline.branch.doubt:
            self._notes.say(timeline.branch.doubt, "warning")

    def _do(self, act: Callable[[Timeline], object]) -> bool:
        """Do something to the run, or say why it can't be done; return whether it was."""
        timeline = self._live()
        if timeline is None:
            return False
        try:
            with self._showing(timeline):
                act(timeline)
        except InputError as error:
            self._notes.say(str(error), "warning")
            return False
        return True

    def change(self, act: Callable[[World], None]) -> bool:
        """Do something to the world; return whether it was possible."""
        return self._do(lambda timeline: timeline.change(act, self._show_way_back))

    def step_within(self, way: int) -> None:
        """Show the next moment within a control step, or for -1 the one before."""
        timeline, player = self._live(), self._player
        if timeline is None or player.step_within(way):
            return
        if way < 0:
            player.back()
        elif player.frame.time > timeline.frame.time:  # this is the last moment, the next row
            player.step()
        try:
            moments = timeline.within(self._show_way_back)
        except InputError as error:
            self._notes.say(str(error), "warning")
            return
        player.look_within(moments)
        player.step_within(len(moments) - 1 if way < 0 else 1)

    def _live(self) -> Timeline | None:
        """Return the timeline; None, with a note, for a recording."""
        if self.timeline is None:
            self._notes.say(RECORDING, "warning")
        return self.timeline

    def other_branch(self) -> None:
        """Show the branch that was run before a change, or an earlier run."""

        def show(timeline: Timeline) -> None:
            if not timeline.others:
                raise InputError("there is no other branch: change something in the past first")
            other = timeline.others[0]
            kind = "another branch" if other in timeline.branches else "an earlier run"
            timeline.show(other)
            timeline.world.operator.let_go()
            self._player.settle()
            end = timeline.newest * timeline.scenario.sampling_time
            again = "goes back" if len(timeline.others) == 1 else "shows the next one"
            self._notes.say(f"{kind}, run until {end:.6g} s; B {again}")

        self._do(show)

    def undo(self) -> None:
        """Undo the last thing done by hand."""

        def undo(timeline: Timeline) -> None:
            at = timeline.undo(self._show_way_back).row * timeline.scenario.sampling_time
            self.release()
            self._player.pause()
            self._notes.say(f"undone, at {at:.6g} s")

        self._do(undo)

    def set(self, name: str, value: float, restart: bool = True) -> str:
        """Set a parameter; return why the run starts again, or "".

        restart: whether it may. Raises InputError where it can't have that value, and for a
        recording; LawError where a law or a sensor fails with it.
        """
        if self.timeline is None:
            raise InputError(RECORDING)
        with self._showing(self.timeline):
            return self.timeline.set({name: value}, self._show_way_back, restart=restart)

    # -- robots driven by hand ----------------------------------------------------------------

    @property
    def driven(self) -> tuple[int, ...]:
        """The robots that are driven by hand, by index."""
        return tuple(driver.robot for driver in self.drivers if driver.robot is not None)

    @property
    def drives(self) -> bool:
        """Whether a robot is driven by hand."""
        return bool(self.driven)

    @property
    def status(self) -> str:
        """The driven robots and their controllers, in words; "" without any."""
        return ", ".join(filter(None, (driver.status for driver in self.drivers)))

    def handle(self, event: pygame.Event) -> bool:
        """Handle an event; return whether it is for those who drive alone."""
        taken = [driver.handle(event) for driver in self.drivers]
        return any(taken)

    def drive(self, robot: int) -> None:
        """Start to drive a body by hand, if it is a robot."""
        timeline = self._live()
        if timeline is None:
            return
        scenario = timeline.scenario
        if robot >= len(scenario.robots):
            self._notes.say(f"{scenario.bodies[robot].name} has no drive", "warning")
            return
        self.seat((robot,))
        mine = scenario.robots[robot]
        turns = ", Q and E turn it" * mine.drive.second_stick
        self._notes.say(
            f"arrow keys or WASD drive {mine.name}{turns}, Shift slowly; H or Esc lets go"
        )

    def seat(self, robots: Sequence[int]) -> None:
        """Let one person or two drive these robots from now on, and no others."""
        self.let_go()
        one, two = Driver(ARROWS, 0, 2), Driver(LETTERS, 1, 2)
        self.drivers = (Driver(),) if len(robots) < 2 else (one, two)
        for driver, robot in zip(self.drivers, robots, strict=False):
            mine = self._player.source.scenario.robots[robot]
            driver.take(robot, str(mine.name), turns=mine.drive.second_stick)

    def release(self) -> None:
        """Stop driving, as far as keys are concerned."""
        for driver in self.drivers:
            driver.release()

    def let_go(self) -> None:
        """Stop driving by hand: the robots' laws drive them again."""
        robots = self.driven
        self.release()
        if self.timeline is not None:
            for robot in robots:
                self.timeline.world.operator.steer(robot, None)

    def steer(self, seconds: float) -> None:
        """Give the driven robots the commands of the keys.

        In the past only commands other than 0 count, and only while time passes: to look back
        changes nothing. seconds: since the last call.
        """
        timeline = self.timeline
        if timeline is None or timeline.over:
            return
        robots = timeline.scenario.robots
        commands = {
            driver.robot: driver.command(robots[driver.robot].drive, seconds)
            for driver in self.drivers
            if driver.robot is not None
        }

        def steer(world: World) -> None:
            for robot, command in commands.items():
                world.operator.steer(robot, command)

        passes = self._player.playing or self._player.manual
        if not timeline.needs_way_back:
            steer(timeline.world)
        elif passes and any(map(any, commands.values())) and not self.change(steer):
            self.let_go()

    def say_who_stands_still(self) -> None:
        """Say which robots of a drawn scenario nothing moves, or that nothing moves any."""
        if self.timeline is None:
            return
        experiment, path = self.timeline.experiment, self.timeline.experiment.source.path
        robots = experiment.scenario.robots
        idle = standing_still(experiment.scenario, experiment.control)
        drawn = path is not None and path.suffix == ".toml"
        all_idle = len(idle) == len(robots) and not experiment.scenario.props
        if not idle or not (drawn or all_idle):
            return
        first, want = next(iter(idle.items()))
        name, more = robots[first].name, counted(len(idle) - 1, "more robot")
        stand = f", and {more} stand" if len(idle) > 1 else " stands"
        self._notes.say(f"{name}{stand} still: {name} lacks {want}", "warning")

    # -- drawing ------------------------------------------------------------------------------

    def scenario_now(self) -> Scenario:
        """Return the scenario with all bodies at their poses of now."""
        frame = self._player.frame
        try:
            return with_poses(frame.scenario, frame.all_poses)
        except InputError as error:  # bodies of a dense crowd may overlap
            self._notes.say(f"bodies are shown where they were at the start: {error}", "warning")
            return frame.scenario

    def editor(self, looks: Looks) -> Editor | None:
        """Return an editor of the scenario as it is now."""
        from mars2d.window.editor import Editor  # few runs need it, and it is slow to import

        timeline = self._live()
        if timeline is None:
            return None
        self._player.pause()
        self.let_go()
        path, control = timeline.experiment.source.path, timeline.world.control
        return Editor(self.scenario_now(), looks, path=path, live=True, control=control)

    def apply(self, outcome: Outcome) -> None:
        """Continue with the drawn scenario, from now or from the start."""
        laws = {robot.name: robot.controller for robot in self._player.frame.scenario.robots}
        robots = outcome.scenario.robots
        given = frozenset(
            r.name for r in robots if r.controller is not laws.get(r.name, r.controller)
        )

        def start(timeline: Timeline) -> None:
            timeline.restart(timeline.experiment.redrawn(outcome.scenario, given))
            self._notes.say("started again with what was drawn; Space goes on")

        def draw(world: World) -> None:
            pairs = zip(self.scenario_now().bodies, outcome.scenario.bodies, strict=True)
            moved = {i: b.pose for i, (a, b) in enumerate(pairs) if a.pose != b.pose}
            # In the past this is another world, whose own laws go on.
            drawn = carried(world.scenario, outcome.scenario, given)
            world.operator.change(drawn, world.control, moved, given=given)

        if outcome.when == "start":
            self._do(start)
        elif self.change(draw):
            self._notes.say("what was drawn holds from now on; Space goes on")

    def next_start(self) -> None:
        """Start again with the next seed."""

        def start(timeline: Timeline) -> None:
            now = timeline.experiment
            seed = now.options.get("seed", now.seed or 0) + 1
            options = {name: value for name, value in now.options.items() if name != "seed"}
            law = None if now.alone else now.control
            again = open_experiment(now.source.path or now.scenario, options, law, seed)
            timeline.restart(again)
            self._notes.say(f"start {seed}")

        self._do(start)
