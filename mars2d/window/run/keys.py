"""The actions of the run window: one table makes its keys, its buttons and its help."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from mars2d.output.controls import CONTROLS, PAUSE
from mars2d.output.layers.table import LAYERS
from mars2d.window.widgets.actions import Action


def _action(name: str, label: str, does: str, *also: str, repeats: bool = False) -> Action:
    """Return an action with its key, a line of help, and the title and icon of its button."""
    control = CONTROLS.get(name)
    title, icon = (control.title, control.icon) if control else ("", "")
    lit = PAUSE if name == "pause" else ""
    return Action(name, does, (label,), None, also, title, icon, lit, repeats=repeats)


TIME = (
    _action("pause", "Space", "pause, go on; with --speed 0, one step"),
    _action("step", "→", "one step, then pause", repeats=True),
    _action("back", "←", "one step back", repeats=True),
    _action("within", "Shift →", "the next moment within a step, as at a contact", repeats=True),
    _action("within_back", "Shift ←", "the moment before within a step", repeats=True),
    _action("leap", "PgDn", "ten steps, then pause", repeats=True),
    _action("leap_back", "PgUp", "ten steps back", repeats=True),
    _action("start", "Home", "go to the start"),
    _action("newest", "End", "go to the newest step"),
    _action("contact", "N", "next contact"),
    _action("contact_back", "Shift N", "previous contact"),
    _action("contacts", "K", "stop at contacts, or go on"),
    _action("faster", "+", "faster", "=", repeats=True),
    _action("slower", "\N{MINUS SIGN}", "slower", repeats=True),
    _action("restart", "R", "restart at time 0, with the file as it is now"),
    _action("branch", "B", "switch to another branch"),
)

_SEE = (
    _action("sensors", "S", "sensors on and off; if a robot is selected, only its own"),
    _action("messages", "M", "messages between robots on and off"),
    _action("forces", "X", "contacts, forces and slipping on and off"),
    _action("theory", "Y", "theoretical predictions on and off"),
    _action("layers", "A", "choose layers"),
    _action("scopes", "Q", "choose plots over time"),
    _action("predictions", "F3", "predictions and measurements on and off"),
    _action("lesson", "F4", "the question, prediction and more of the file on and off"),
    _action("printed", "F6", "what laws print on and off"),
    _action("ruler", "F8", "measure between two clicks, or from the selected body"),
    _action("stopwatch", "F9", "start, stop and put away a stopwatch of the run's time"),
    _action("less_time", ",", "less time in the plots", repeats=True),
    _action("more_time", ".", "more time in the plots", repeats=True),
    _action("turn_on", "Shift PgDn", "further rows of panels", repeats=True),
    _action("turn_back", "Shift PgUp", "earlier rows of panels", repeats=True),
    _action("select", "Tab", "select the next robot or prop, and inspect it"),
    _action("follow", "L", "let the camera follow the selected body, or all robots"),
    _action("fit", "F", "fit the workspace into the window", "Ctrl 0"),
    _action("nearer", "Ctrl +", "zoom in", "Ctrl =", "Ctrl [+]", repeats=True),
    _action("farther", "Ctrl \N{MINUS SIGN}", "zoom out", "Ctrl [-]", repeats=True),
    _action("screen", "F11", "full screen on and off"),
    _action("dark", "D", "dark or light"),
    _action("text", "Z", "size of text and lines: for the back row"),
)
SEE = (
    *(
        _action(layer.name, layer.key.upper(), f"{layer.title.lower()} on and off")
        for layer in LAYERS
        if layer.key and layer.name not in {each.name for each in _SEE}
    ),
    *_SEE,
)

LEAVE = _action("leave", "Ctrl Q", "close the window", "Ctrl W")

DO = (
    _action("parameters", "F2", "sliders of parameters on and off"),
    _action("slider", "Shift F2", "to the sliders: arrows, a number and Enter, Esc"),
    _action("offer", "F10", "the menu of the selected robot or prop, or of the floor"),
    _action("drive", "H", "drive the selected robot by hand: arrow keys, WASD, controller"),
    _action("push", "W", "push the selected robot or prop with so many newtons, for so long"),
    _action("edit", "E", "draw walls, robots and more, while paused"),
    _action("source", "F7", "open the file in your own editor, at the line of an error"),
    _action("undo", "Ctrl Z", "undo the last manual action"),
    _action("picture", "P", "save a picture", "Ctrl S"),
    _action("film", "V", "start and stop a film"),
    _action("help", "F1", "all keys on and off"),
    _action("escape", "Esc", "close the menu or the help, let go, deselect"),
    LEAVE,
)

ACTIONS = (*TIME, *SEE, *DO)

MOUSE = (
    _action("zoom", "Wheel", "zoom about the pointer; over plots, in time"),
    _action("pick", "Click", "select and inspect a robot or prop; on the floor, deselect"),
    _action("carry", "Drag it", "pull a robot or prop; while paused, move it"),
    _action("aim", "Shift drag", "push a robot or prop with the newtons at the arrow"),
    _action("menu", "Right click", "open a menu of actions"),
    _action("turn", "Right drag", "turn a robot or prop, while paused"),
    _action("pan", "Drag", "on the floor, move the picture; on the time bar, go to a time"),
)

GROUPS: Mapping[str, Sequence[Action]] = {"Time": TIME, "See": SEE, "Do": DO}
"""Those with keys, in the groups of the help."""

HOME = (
    Action("search", "search by letters that are typed", ("A to Z",)),
    Action("choose", "choose a card", ("← → ↑ ↓",)),
    Action("right", labels=("→",), also=("Tab",), repeats=True),
    Action("left", labels=("←",), repeats=True),
    Action("up", labels=("↑",), repeats=True),
    Action("down", labels=("↓",), repeats=True),
    Action("turn_back", "further up", ("PgUp",), also=("Home",), repeats=True),
    Action("turn_on", "further down", ("PgDn",), also=("End",), repeats=True),
    Action("open", "open the chosen card; a game: play it", ("Enter",)),
    Action("watch", "watch a game that laws play", ("Shift Enter",)),
    _action("dark", "Ctrl D", "dark or light"),
    _action("text", "Ctrl Z", "size of text and lines: for the back row"),
    _action("screen", "F11", "full screen on and off"),
    _action("help", "F1", "all keys on and off"),
    _action("escape", "Esc", "close the help, or forget what was typed"),
    LEAVE,
)
"""The actions of the home."""

_BY_NAME = {action.name: action for action in ACTIONS}


def key_of(name: str) -> str:
    """Return the label of an action's key; "" without one."""
    return _BY_NAME[name].labels[0] if name in _BY_NAME else ""


def bound(
    names: Iterable[str],
    acts: Mapping[str, Callable[[], None]],
    on: Callable[[str], bool],
    table: Iterable[Action] = ACTIONS,
) -> list[Action]:
    """Return the actions of some names with their effects; on: whether one's setting is on."""
    known = {action.name: action for action in table}
    return [replace(known[name], act=acts[name], on=partial(on, name)) for name in names]
