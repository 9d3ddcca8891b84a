"""Entries of menus: what can be done with a body or on the floor, plots, layers, leaving."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import dist

import numpy as np

from mars2d.core.plane import Point
from mars2d.core.usercode import name_of
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.record.frame import Frame
from mars2d.window.panels.scopes import Scopes
from mars2d.window.panels.trace import FEW, What
from mars2d.window.run.keys import key_of
from mars2d.window.run.tools import Tools
from mars2d.window.screen.picking import Selection
from mars2d.window.screen.player import Player
from mars2d.window.screen.source import Playback
from mars2d.window.widgets.menu import Entry

Actions = Mapping[str, Callable[[], None]]

TITLES = {
    "follow": "Follow with the camera", "scopes": "Plot over time", "drive": "Drive by hand",
    "push": "Push with a force ...", "fit": "Show all", "stopwatch": "Stopwatch",
    "printed": "Show what is printed", "edit": "Draw walls and more",
    "undo": "Undo what was done by hand", "figure": "Save the plots as a figure",
}  # fmt: skip
MOTION = {"Speed": "speed", "x": "x", "y": "y", "Heading": "theta"}
CONTACT = {"Contact force": "force", "Contact impulse": "impulse"}
DYNAMICS = {"Kinetic energy": "kinetic", "Momentum": "momentum.each"}
OF_ALL = {"Energy, and what has made it": "energy", "Momentum, of all": "momentum"}
NEAREST = 5
"""The most bodies whose distance is offered: the nearest."""


def layer_entries(layers: Layers, switch: Callable[..., None]) -> list[Entry]:
    """Return an entry for each layer that people may switch; switch: toggles one of them alone."""
    return [
        Entry(
            each.title, partial(switch, each.name, alone=True), each.key.upper(),
            getattr(layers, each.name),
        )
        for each in LAYERS
        if each.switch
    ]  # fmt: skip


class Offers:
    """What the menus of a run window offer: with what is selected, on the floor, to plot.

    acts: the effects of actions, by name.
    """

    def __init__(
        self, player: Player, selection: Selection, tools: Tools, scopes: Scopes, acts: Actions
    ) -> None:
        self._player, self._selection, self._tools = player, selection, tools
        self._scopes, self._acts = scopes, acts
        self._live = not isinstance(player.source, Playback)

    def _entries(self, *names: str, live: Sequence[str] = ()) -> list[Entry]:
        """Return entries of actions; live: of those that need a run that can be changed."""
        names = (*names, *(live if self._live else ()))
        return [Entry(TITLES[name], self._acts[name], key_of(name)) for name in names]

    def at(self, point: Point) -> list[Entry]:
        """Return what can be done with the selected body; without one, at a point [m]."""
        body, scenario = self._selection.body, self._player.source.scenario
        if body is not None:
            robot = body < len(scenario.robots)
            live = ["drive", "push"] if robot else ["push"]
            title = Entry(str(scenario.bodies[body].name))
            return [title, *self._entries("follow", "scopes", live=live)]
        measure = partial(self._tools.measure_from, point)
        return [
            Entry(f"({point[0]:.3g}, {point[1]:.3g}) m"),
            *self._entries("fit"),
            Entry("Measure from here", measure, key_of("ruler")),
            *self._entries("stopwatch", "printed", live=["edit", "undo"]),
        ]

    def plots(self) -> list[Entry]:
        """Return the quantities to plot of the selected body, or of all robots."""
        frame, body, scopes = self._player.frame, self._selection.body, self._scopes
        scenario = frame.scenario
        bodies = tuple(range(len(scenario.robots))) if body is None else (body,)
        who = "All robots" if body is None else str(scenario.bodies[body].name)

        def entry(title: str, what: What, of: tuple[int, ...]) -> Entry:
            return Entry(title, partial(scopes.switch, what, of), "", scopes.shows(what, of))

        (save,) = self._entries("figure")  # which is there before, too: others stay put
        entries = [save if scopes.is_open else save._replace(act=None, tone="note"), Entry(who)]
        entries += [entry(title, what, bodies) for title, what in _columns(frame, body).items()]
        entries.append(Entry("All bodies"))
        entries += [entry(title, what, ()) for title, what in OF_ALL.items()]
        return entries + [entry(name_of(each), each, ()) for each in scopes.functions]


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
    here = frame.body_pose(body)[:2]
    others = [other for other in range(len(scenario.bodies)) if other != body]
    others.sort(key=lambda other: dist(here, frame.body_pose(other)[:2]))
    names = [str(scenario.bodies[other].name) for other in others[:NEAREST]]
    return found | {f"Distance to {name}": f"distance.{name}" for name in names}
