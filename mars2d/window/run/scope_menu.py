"""The menu of quantities to plot over time, of a body or of all robots."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import dist
from typing import Any

import numpy as np

from mars2d.core.usercode import name_of
from mars2d.record.frame import Frame
from mars2d.window.panels.scopes import Scopes
from mars2d.window.panels.trace import FEW, What
from mars2d.window.run.toolbar import Toolbar
from mars2d.window.screen.player import Player
from mars2d.window.screen.selection import Selection
from mars2d.window.widgets.menu import Entry
from mars2d.world.record import Record
from mars2d.world.timeline import Timeline

MOTION = {"Speed": "speed", "x": "x", "y": "y", "Heading": "theta"}
CONTACT = {"Contact force": "force", "Contact impulse": "impulse"}
DYNAMICS = {"Kinetic energy": "kinetic", "Momentum": "momentum.each"}
OF_ALL = {"Energy, and what has made it": "energy", "Momentum, of all": "momentum"}
NEAREST = 14
"""The most bodies whose distance is offered: the nearest."""


class ScopeMenu:
    """The menu of the run window that chooses plots; at first those that the file names are shown.

    player: of the run, whose file may name plots, its `scopes`.
    """

    def __init__(
        self,
        scopes: Scopes,
        toolbar: Toolbar,
        player: Player,
        selection: Selection,
        actions: Mapping[str, Callable[[], None]],
    ) -> None:
        """Show the plots that the file names; actions: "figure" and "table", which save them."""
        self._actions = actions
        self._scopes, self._toolbar = scopes, toolbar
        self._player, self._selection = player, selection
        robots = tuple(range(len(player.frame.scenario.robots)))
        for what in self._named:
            scopes.switch(what, robots if isinstance(what, str) else ())

    @property
    def _named(self) -> Sequence[What]:
        """The plots that the file names."""
        source = self._player.source
        return source.experiment.source.scopes if isinstance(source, Timeline) else ()

    @property
    def functions(self) -> list[Callable[[Record], object]]:
        """The functions among the plots that the file names."""
        return [what for what in self._named if not isinstance(what, str)]

    def open(self) -> None:
        """Open the menu for the selected body, or for all robots."""

        def entries() -> list[Entry]:
            plots = entries_of_scopes(
                self._player.frame, self._selection.body, self._scopes, self.functions, distances
            )
            figure = Entry("Save the plots as a figure", self._actions["figure"])
            table = Entry("Save their numbers as CSV", self._actions["table"])
            return [*plots, figure, table] if self._scopes.is_open else plots

        def distances() -> None:
            body, menu = self._selection.body or 0, self._toolbar.menu
            there = partial(entries_of_distances, self._player.frame, body, self._scopes)
            menu.open("distances", there, menu.corner)

        self._toolbar.open("scopes", entries)


def entries_of_scopes(
    frame: Frame,
    body: int | None,
    scopes: Scopes,
    functions: Sequence[Callable[[Any], Any]],
    distances: Callable[[], None],
) -> list[Entry]:
    """Return the quantities to plot of a body, an index of `Scenario.bodies`, or of all robots.

    functions: those of the experiment's file that it names as its scopes. distances: opens the
    menu of distances.
    """
    scenario = frame.scenario
    bodies = tuple(range(len(scenario.robots))) if body is None else (body,)
    who = "All robots" if body is None else str(scenario.bodies[body].name)

    def entry(title: str, what: What, of: tuple[int, ...]) -> Entry:
        return Entry(title, partial(scopes.switch, what, of), "", scopes.shows(what, of))

    entries = [Entry(who)]
    entries += [entry(title, what, bodies) for title, what in _columns(frame, body).items()]
    if body is not None and len(scenario.bodies) > 1:
        entries.append(Entry("Distance to ...", distances))
    entries.append(Entry("All bodies"))
    entries += [entry(title, what, ()) for title, what in OF_ALL.items()]
    entries += [entry(name_of(function), function, ()) for function in functions]
    return entries


def entries_of_distances(frame: Frame, body: int, scopes: Scopes) -> list[Entry]:
    """Return the bodies whose distance to a body can be plotted, the nearest first."""
    bodies = frame.scenario.bodies
    here = frame.body_pose(body)[:2]
    others = [other for other in range(len(bodies)) if other != body]
    others.sort(key=lambda other: dist(here, frame.body_pose(other)[:2]))
    entries = [Entry(f"Distance of {bodies[body].name} to")]
    for other in others[:NEAREST]:
        what = f"distance.{bodies[other].name}"
        act = partial(scopes.switch, what, (body,))
        entries.append(Entry(str(bodies[other].name), act, "", scopes.shows(what, (body,))))
    return entries


def _columns(frame: Frame, body: int | None) -> dict[str, str]:
    """Return the columns of a body or of all robots, by their titles."""
    scenario = frame.scenario
    found = dict(MOTION)
    robots = scenario.robots if body is None else scenario.robots[body : body + 1]
    drives = {robot.drive.inputs for robot in robots}
    if len(drives) == 1:
        found |= {f"Command {part.name}": f"command.{part.name}" for part in drives.pop()}
    if robots:
        found["Effort of the drive"] = "effort"
    found |= (CONTACT if scenario.physics == "contact" else {}) | DYNAMICS
    if body is None:
        return found
    for sensor in (sensor for robot in robots for sensor in robot.sensors):
        reading = dict(frame.readings.get(sensor.key, ())).get(body)
        if sensor.recorded and reading is not None and np.asarray(reading).size <= FEW:
            found[sensor.key] = sensor.key
    return found
