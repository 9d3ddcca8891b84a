"""The editor's actions: one table for its keys, its buttons and its help."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from mars2d.bodies.props import Ball, Bar, Box, Gate, Puck
from mars2d.window.editor import tools
from mars2d.window.editor.desk import Desk
from mars2d.window.editor.tools import Chain, Place
from mars2d.window.widgets.actions import Action

if TYPE_CHECKING:
    from mars2d.window.editor.editor import Editor

TOOLS: tuple[tuple[str, str, str, Callable[[Desk], tools.Tool], str], ...] = (
    ("select", "V", "select, move and turn", tools.Select,
     "M6 3l12 9-6 1-3 6Z"),
    ("robot", "R", "robot; drag to turn it",
     partial(Place, make=tools.robot), "M4 12a8 8 0 1 0 16 0a8 8 0 1 0-16 0M12 12l5-5"),
    ("box", "B", "box; drag for its size",
     partial(Place, make=partial(tools.prop, Box)), "M5 5h14v14H5Z"),
    ("bar", "L", "bar; drag from end to end",
     partial(Place, make=partial(tools.prop, Bar)), "M3 17 17 3l4 4L7 21Z"),
    ("gate", "T", "bar on a hinge; drag from the hinge",
     partial(Place, make=partial(tools.prop, Gate)),
     "M2.5 12a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0M7.5 12H21M18 5a9 9 0 0 1 0 14"),
    ("ball", "O", "ball; drag for its size",
     partial(Place, make=partial(tools.prop, Ball)),
     "M5 12a7 7 0 1 0 14 0a7 7 0 1 0-14 0M9.5 9.5h.1"),
    ("puck", "U", "puck; drag for its size",
     partial(Place, make=partial(tools.prop, Puck)),
     "M4 10a8 4 0 1 0 16 0a8 4 0 1 0-16 0M4 10v4a8 4 0 0 0 16 0v-4"),
    ("solid", "S", "prop, corner by corner; Enter closes it",
     partial(Chain, kind="prop", make=tools.solid), "M6 20 3 9l8-5 2 6 8 1-5 9Z"),
    ("wall", "W", "wall, corner by corner; Enter ends it",
     partial(Chain, kind="wall"), "M3 19l5-11 7 4 6-8M8 8h.1M15 12h.1"),
    ("polygon", "P", "obstacle, corner by corner; Enter closes it",
     partial(Chain, kind="outline"), "M4 16l9 4 8-9-8-2-4-6Z"),
    ("rectangle", "K", "rectangular obstacle; drag for its size",
     partial(Place, make=tools.block), "M3 7h18v10H3ZM3 12l5-5M3 17 13 7M8 17 18 7M13 17l8-8"),
    ("waypoint", "Y", "waypoints; click a robot for its own",
     partial(tools.PlaceWaypoint, make=tools.waypoint),
     "M4 19h.1M9 13h.1M14 14h.1M17 10h.1M16 5a3 3 0 1 0 6 0a3 3 0 1 0-6 0"),
    ("beacon", "N", "beacon", partial(Place, make=tools.beacon),
     "M9 12a3 3 0 1 0 6 0a3 3 0 1 0-6 0M12 3v3m0 12v3M3 12h3m12 0h3"),
)  # fmt: skip
"""Of each tool: its name, its key, what to do, how it is made, and the path of its icon."""

SNAP = "M4 8h16M4 16h16M8 4v16M16 4v16"


def actions_of(editor: Editor) -> dict[str, tuple[Action, ...]]:
    """Return all that can be done in an editor, in the groups of the help."""
    desk, dialogs, looks = editor.desk, editor.dialogs, editor.looks.actions
    fit, zoom = editor.viewpoint.fit, editor.zoom

    def key(
        name: str, keys: str, words: str, act: Callable[[], object] | None = None,
        *also: str, **more: Any,
    ) -> Action:  # fmt: skip
        labels = ("←", "→", "↑", "↓") if keys == "arrows" else (keys,)
        return Action(name, words, labels, act, also, **more)

    def chosen(name: str) -> bool:
        return name == editor.tool_name

    here = (
        key("now", "Enter", "go on from now with the drawing", partial(dialogs.apply, "now"),
            title="Go on", on=lambda: True),
        key("start", "Shift Enter", "run the drawing from the start",
            partial(dialogs.apply, "start"), title="From the start"),
    )  # fmt: skip
    file = (
        key("save", "Ctrl S", "save as a scenario file (TOML)", dialogs.save,
            title="Save", on=lambda: desk.changed),
        key("leave", "Ctrl Q", "leave; asks first if something would be lost", dialogs.leave,
            "Ctrl W"),
    )  # fmt: skip
    run = key("run", "F5", "save and run; closing the run returns here", editor.run, "Ctrl R",
              title="Run", on=lambda: not desk.changed)  # fmt: skip
    return {
        "Tools": tuple(
            key(name, letter, words, partial(editor.choose, name), title=name.capitalize(),
                icon=icon, on=partial(chosen, name))
            for name, letter, words, _, icon in TOOLS
        ),
        "Change": (
            key("pose", "=", "type x y, x y degrees, or a name: there goes the selection",
                editor.ask_pose),
            key("nudge", "arrows", "move the selection by a grid step; with Shift by a tenth",
                repeats=True),
            Action("rotate", "turn the selection by 15 degrees; with Shift by one",
                   ("Ctrl ←", "Ctrl →"), repeats=True),
            key("delete", "Del", "remove the selection, or its corner", desk.remove, "Backspace"),
            key("duplicate", "Ctrl D", "duplicate the selection, or its corner", desk.duplicate),
            key("workspace", "M", "select the workspace, or make one", editor.select_workspace),
            key("all", "Ctrl A", "select all", lambda: editor.select(desk.draft.items())),
            key("next", "Tab", "select the next item", editor.select_next),
            key("more", "Shift Tab", "select the next item, too",
                partial(editor.select_next, too=True)),
            key("properties", "F2", "choose a property to change",
                editor.properties.focus),
            key("undo", "Ctrl Z", "undo", editor.undo,
                title="Undo", when=lambda: desk.has(-1), repeats=True),
            key("redo", "Ctrl Y", "redo", partial(desk.go, 1), "Ctrl Shift Z",
                title="Redo", when=lambda: desk.has(1), repeats=True),
        ),
        "Look": (
            key("snap", "G", "snap to the grid on and off", desk.snap_or_not,
                title="Snap", icon=SNAP, on=lambda: desk.snaps),
            key("names", "I", "names on and off", editor.switch_names),
            key("fit", "F", "fit the workspace into the window", lambda: fit(desk.draft.sketch)),
            key("nearer", "Ctrl +", "zoom in", partial(zoom, 2.0), "Ctrl =", "Ctrl [+]"),
            key("farther", "Ctrl \N{MINUS SIGN}", "zoom out", partial(zoom, -2.0), "Ctrl [-]"),
            key("help", "F1", "all keys on and off", editor.help.turn),
            key("escape", "Esc", "leave the tool, deselect", editor.escape),
            key("dark", "D", "dark or light", looks["dark"]),
            key("text", "Z", "size of text and lines: for the back row", looks["text"]),
        ),
        "File": (*here, *file) if editor.live else (*file, run),
        "Mouse": (
            key("click", "Click", "select; with Shift one more"),
            key("drag", "Drag", "move; from an empty place, select all in the rectangle"),
            key("turn", "Ring", "its handle turns; with Shift in steps of 15 degrees"),
            key("corner", "Corner", "moves a corner, or resizes a box; the dots add a corner"),
            key("zoom", "Wheel", "zoom about the pointer"),
            key("pan", "Space drag", "move the picture; so does the middle button"),
        ),
    }  # fmt: skip
