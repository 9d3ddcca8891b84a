"""The menu of a right click: what can be done with a body, a wall or the floor."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mars2d.core.plane import Point
from mars2d.record.frame import Frame
from mars2d.window.director import Director
from mars2d.window.menu import Entry

__all__ = ["entries_of_body", "entries_of_place"]

Actions = Mapping[str, Callable[[], None]]


def entries_of_body(frame: Frame, body: int, director: Director, actions: Actions) -> list[Entry]:
    """Return what can be done with a body: an index of `Scenario.bodies`, which is selected."""
    scenario = frame.scenario
    x, y, theta = frame.body_pose(body)
    entries = [
        Entry(str(scenario.bodies[body].name)),
        Entry("Follow with the camera", actions["follow"], "L"),
        Entry("Copy its pose", lambda: director.copy(f"({x:.6g}, {y:.6g}, {theta:.6g})")),
    ]
    if director.timeline is None:
        return entries
    if body < len(scenario.robots):
        entries.append(Entry("Drive by hand", actions["drive"], "H"))
    return [
        *entries,
        Entry("Put back to its start", lambda: director.put_back(body)),
        Entry("Twice as heavy", lambda: director.scale_mass(body, 2.0)),
        Entry("Half as heavy", lambda: director.scale_mass(body, 0.5)),
        Entry("Remove, and start anew", lambda: director.remove(body)),
    ]


def entries_of_place(point: Point, thing: str, director: Director, actions: Actions) -> list[Entry]:
    """Return what can be done at a point [m] of the floor, or of the thing of this name."""
    x, y = point
    entries = [
        Entry(thing or f"({x:.3g}, {y:.3g}) m"),
        Entry("Show all", actions["fit"], "F"),
        Entry("Copy the point", lambda: director.copy(f"({x:.6g}, {y:.6g})")),
    ]
    if director.timeline is not None:
        entries += [
            Entry("Draw walls and more", actions["edit"], "E"),
            Entry("Undo what was done by hand", actions["undo"], "Ctrl Z"),
        ]
    return entries
