"""Entries of menus: what can be done with a body, a wall or the floor, with runs, on leaving."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from mars2d.core.plane import Point
from mars2d.record.frame import Frame
from mars2d.window.run.director import Director
from mars2d.window.screen.player import AtContact, Player
from mars2d.window.widgets.menu import Entry
from mars2d.world.world import World

AT_CONTACT: dict[AtContact, str] = {
    "go on": "Go on", "stop": "Stop", "slow": "Go slowly for a second",
}  # fmt: skip
"""What can happen when a contact begins, in words."""

Actions = Mapping[str, Callable[[], None]]


def entries_of_body(frame: Frame, body: int, director: Director, actions: Actions) -> list[Entry]:
    """Return what can be done with a body: an index of `Scenario.bodies`, which is selected."""
    scenario = frame.scenario
    x, y, theta = frame.body_pose(body)
    entries = [
        Entry(str(scenario.bodies[body].name)),
        Entry("Follow with the camera", actions["follow"], "L"),
        Entry("Plot over time", actions["scopes"], "Q"),
        Entry("Copy its pose", lambda: director.copy(f"({x:.6g}, {y:.6g}, {theta:.6g})")),
    ]
    if director.timeline is None:
        return entries
    if body < len(scenario.robots):
        entries.append(Entry("Drive by hand", actions["drive"], "H"))
    return [
        *entries,
        Entry("Push with a force ...", actions["push"], "W"),
        Entry("Put back to its start", lambda: director.put_back(body)),
        Entry("Twice as heavy", lambda: director.scale_mass(body, 2.0)),
        Entry("Half as heavy", lambda: director.scale_mass(body, 0.5)),
        Entry("Remove, and start again", lambda: director.remove(body)),
    ]


def entries_of_place(
    point: Point,
    thing: str,
    director: Director,
    actions: Actions,
    measure: Callable[[Point], object],
) -> list[Entry]:
    """Return what can be done at a point [m] of the floor, or of the thing of this name.

    measure: begins to measure there.
    """
    x, y = point
    entries = [
        Entry(thing or f"({x:.3g}, {y:.3g}) m"),
        Entry("Show all", actions["fit"], "F"),
        Entry("Measure from here", lambda: measure(point), "F8"),
        Entry("Stopwatch", actions["stopwatch"], "F9"),
        Entry("Show what is printed", actions["printed"], "F6"),
        Entry("Copy the point", lambda: director.copy(f"({x:.6g}, {y:.6g})")),
    ]
    if director.timeline is not None:
        entries += [
            Entry("Draw walls and more", actions["edit"], "E"),
            Entry("Undo what was done by hand", actions["undo"], "Ctrl Z"),
        ]
    return entries


def entries_of_contacts(player: Player, actions: Actions) -> list[Entry]:
    """Return how to get to contacts, and what happens there."""

    def choose(choice: AtContact) -> Entry:
        def act() -> None:
            player.at_contact = choice

        return Entry(AT_CONTACT[choice], act, "", player.at_contact == choice)

    return [
        Entry("On to the next contact", actions["contact"], "N"),
        Entry("Back to the contact before", actions["contact_back"], "Shift N"),
        Entry("When a contact begins"),
        *map(choose, AT_CONTACT),
    ]


def entries_of_runs(director: Director, show: Callable[[World], None]) -> list[Entry]:
    """Return the other branches and the earlier runs, which `show` shows."""
    others = [Entry(words, partial(show, world)) for words, world in director.others()]
    return [Entry("Go to"), *others]


def entries_of_leaving(save: Callable[[], None], leave: Callable[[], None]) -> list[Entry]:
    """Return what can be done with a run in which hands did something, before it is gone."""
    return [
        Entry("This run was changed by hand, and is not saved"),
        Entry("Save it, and leave", save),
        Entry("Leave without it", leave, "Ctrl Q"),
        Entry("Stay", lambda: None, "Esc"),
    ]
