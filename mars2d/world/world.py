"""World: a live simulation, for whoever runs it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from mars2d.core.description import wrong
from mars2d.core.streams import check_seed
from mars2d.core.through import through
from mars2d.record.energy import Energy, Momentum
from mars2d.record.recorder import Recorder
from mars2d.scenario.scenario import Scenario
from mars2d.world.operator import Operator
from mars2d.world.simulation import Simulation
from mars2d.world.team_view import TeamPositionsView, WorldView

Watcher = Callable[["World"], None]
"""A function that is called with the world at each control step."""


class World(WorldView):
    """One live simulation. Worlds share nothing: two in one process are independent.

    >>> from mars2d import Robot, Scenario
    >>> world = World(Scenario(robots=[Robot(pose=(0, 0, 0))], sampling_time=1.0))
    >>> world.step([[0.2], [0.0]])
    >>> world.pose[:, 0].tolist()
    [0.2, 0.0, 0.0]

    scenario: what is simulated. control: the law of the whole team, a function or generator of the
    world; a robot's own controller overrides its column. seed: of all random streams. filename:
    the experiment's file, for the record. watch: called with the world once a control step, between
    sensing and control: to draw, to wait, to count. options: the options that the experiment was
    opened with, for the record. record: False keeps no record, as learners want; `world.history` is
    empty then.

    Laws are given a `WorldView`, which has no more than that class; add-ons and watchers are given
    the World.
    """

    def __init__(
        self,
        scenario: Scenario,
        control: Callable[[World], Any] | None = None,
        seed: int = 0,
        *,
        filename: str = "",
        watch: Watcher | None = None,
        options: Mapping[str, Any] | None = None,
        record: bool = True,
    ) -> None:
        if not isinstance(scenario, Scenario):
            raise wrong("World.scenario", scenario, "a Scenario")
        super().__init__(Simulation(scenario, check_seed(seed), filename, record, options or {}))
        self.watch = watch
        view = WorldView(self._simulation)
        positions = self.scenario.sees == "positions"
        team_view = TeamPositionsView(self._simulation) if positions else view
        self._simulation.begin(self, view, team_view, control)

    def reset(self, seed: int | None = None, scenario: Scenario | None = None) -> None:
        """Start again, as a new World would: the run after it is the same to the bit.

        seed, scenario: those from now on; None: those of the present run. The law of the team and
        the watcher stay. What was kept of the run before, such as its robots, record
        and add-ons, does not change any more. Raises InputError within a step.
        """
        before = self._simulation
        before.refuse_within_step("reset")
        World.__init__(
            self,
            before.declared if scenario is None else scenario,
            before.laws.function,
            before.seed if seed is None else seed,
            filename=before.filename,
            watch=before.watch,
            options=before.recorder.options,
            record=before.recorder.keeps,
        )

    @property
    def watch(self) -> Watcher | None:
        """Called with the world once a control step; may be set again."""
        return self._simulation.watch

    @watch.setter
    def watch(self, watch: Watcher | None) -> None:
        self._simulation.watch = watch

    simulation: Simulation = through("_simulation")
    """The machinery behind it, for programs that rebuild or follow a run."""

    control: Callable[[World], Any] | None = through("_simulation.laws.function")
    """The law of the team."""
    energy: Energy = through("_simulation.energy")
    """The kinetic energies of robots and props, and the work since the start, J."""
    momentum: Momentum = through("_simulation.momentum")
    """The momenta of robots and props, N s, and the angular one of all, N m s."""
    recorder: Recorder = through("_simulation.recorder")
    """Writes the rows of the record."""
    operator: Operator = through("_simulation.operator")
    """Drives robots, puts bodies elsewhere, pulls and holds them."""

    def change(
        self,
        scenario: Scenario,
        control: Callable[[World], Any] | None = None,
        moved: Mapping[int, tuple[float, float, float]] | None = None,
        options: Mapping[str, Any] | None = None,
    ) -> None:
        """Go on with another scenario from now on: other obstacles, masses, friction, drives, laws.

        Bodies stay where they are, and laws that are the same keep what they remember. control: the
        law of the team from now on, `world.control` for the one that it has. moved: poses of bodies
        that are put elsewhere with it, by index in `Scenario.bodies`. options: the parameters that
        make the difference, for the record. Raises InputError where a change in `scenario` needs a
        new start, such as another robot, sensor or sampling time, and where a body would be in an
        obstacle.
        """
        self._simulation.operator.change(scenario, control, moved, options)

    def break_off(self, why: str) -> None:
        """End the experiment at once, without a last control step, as after an error."""
        self._simulation.break_off(why)

    def _repr_svg_(self) -> str:
        """Return a picture of this instant, for a notebook."""
        from mars2d.output.pages.notebook import world_svg

        return world_svg(self)
