"""The keys of the run window: one table for commands and for the help."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pygame

from mars2d.output.layers.table import LAYERS
from mars2d.window.widgets.keys import CONTROL, MODIFIERS, Key, chord

MAX_NUMBER = 1_000_000
"""The largest number that can be typed before a command."""


TIME = (
    Key("pause", ("space",), ("Space",), "pause, go on; in manual mode, one step"),
    Key(
        "step",
        ("right",),
        ("→",),
        "one step, then pause; a typed number is the count",
        repeats=True,
    ),
    Key("back", ("left",), ("←",), "one step back; a typed number is the count", repeats=True),
    Key("leap", ("page down",), ("PgDn",), "ten steps, then pause", repeats=True),
    Key("leap_back", ("page up",), ("PgUp",), "ten steps back", repeats=True),
    Key("start", ("home",), ("Home",), "go to the start"),
    Key("newest", ("end",), ("End",), "go to the newest step"),
    Key("contact", ("n",), ("N",), "next contact"),
    Key("contact_back", ("shift+n",), ("Shift N",), "previous contact"),
    Key("contacts", ("k",), ("K",), "stop or slow down at contacts"),
    Key("loop", ("j",), ("J",), "loop on and off"),
    Key("faster", ("+", "=", "[+]"), ("+",), "faster", repeats=True),
    Key("slower", ("-", "[-]"), ("\N{MINUS SIGN}",), "slower", repeats=True),
    Key("restart", ("r",), ("R",), "restart at time 0, with the file as it is now"),
    Key("branch", ("b",), ("B",), "switch to another branch"),
)

_SEE = (
    Key("grid", ("g",), ("G",), "grid on and off"),
    Key("trails", ("t",), ("T",), "trails on and off"),
    Key("sensors", ("s",), ("S",), "sensors on and off; if a robot is selected, only its own"),
    Key("messages", ("m",), ("M",), "messages between robots on and off"),
    Key("forces", ("x",), ("X",), "contacts, forces and slipping on and off"),
    Key("theory", ("y",), ("Y",), "theoretical predictions on and off"),
    Key("addons", ("o",), ("O",), "drawings of add-ons on and off"),
    Key("names", ("i",), ("I",), "names on and off"),
    Key("velocities", ("u",), ("U",), "velocities on and off"),
    Key("layers", ("a",), ("A",), "choose layers"),
    Key("scopes", ("q",), ("Q",), "choose plots over time"),
    Key("predictions", ("f3",), ("F3",), "predictions and measurements on and off"),
    Key("select", ("tab",), ("Tab",), "select the next robot or prop, and inspect it"),
    Key("follow", ("l",), ("L",), "let the camera follow the selected body, or all robots"),
    Key("fit", ("f", "ctrl+0"), ("F",), "fit the workspace into the window"),
    Key("nearer", ("ctrl++", "ctrl+=", "ctrl+[+]"), ("Ctrl +",), "zoom in", repeats=True),
    Key("farther", ("ctrl+-", "ctrl+[-]"), ("Ctrl \N{MINUS SIGN}",), "zoom out", repeats=True),
    Key("screen", ("f11",), ("F11",), "full screen on and off"),
    Key("dark", ("d",), ("D",), "dark or light"),
    Key("text", ("z",), ("Z",), "size of text and lines: for the back row"),
)
SEE = (
    *_SEE,
    *(
        Key(layer.name, (layer.key,), (layer.key.upper(),), f"{layer.title.lower()} on and off")
        for layer in LAYERS
        if layer.key and layer.name not in {key.action for key in _SEE}
    ),
)

LEAVE = Key("leave", ("ctrl+q", "ctrl+w"), ("Ctrl Q",), "close the window")

DO = (
    Key("parameters", ("f2",), ("F2",), "sliders of parameters on and off"),
    Key("drive", ("h",), ("H",), "drive the selected robot by hand: arrow keys, WASD, controller"),
    Key("edit", ("e",), ("E",), "draw walls, robots and more, while paused"),
    Key("undo", ("ctrl+z",), ("Ctrl Z",), "undo the last manual action"),
    Key("picture", ("p", "ctrl+s"), ("P",), "save a picture"),
    Key("film", ("v",), ("V",), "start and stop a film"),
    Key("python", ("c",), ("C",), "save the scenario as a Python file, and copy it"),
    Key("help", ("f1",), ("F1",), "all keys on and off"),
    Key("escape", ("escape",), ("Esc",), "close the menu or the help, let go, deselect"),
    LEAVE,
)

KEYS = (*TIME, *SEE, *DO)

MOUSE = (
    Key("zoom", (), ("Wheel",), "zoom about the pointer; over the time bar, zoom in time"),
    Key("pick", (), ("Click",), "select and inspect a robot or prop; on the floor, deselect"),
    Key("carry", (), ("Drag it",), "pull a robot or prop; while paused, move it"),
    Key("menu", (), ("Right click",), "open a menu of actions"),
    Key("turn", (), ("Right drag",), "turn a robot or prop, while paused"),
    Key("pan", (), ("Drag",), "on the floor, move the picture; on the time bar, go to a time"),
)

GROUPS: Mapping[str, Sequence[Key]] = {"Time": TIME, "See": SEE, "Do": DO, "Mouse": MOUSE}
"""All keys, in the groups of the help."""

_BY_NAME = {name: key for key in KEYS for name in key.names}
_STEP = next(key for key in KEYS if key.action == "step")


def action_of(name: str, character: str, *, manual: bool) -> Key | None:
    """Return the command of a key, or None.

    name: as `chord` returns it. character: the text that it types, which identifies + on every
    keyboard. manual: whether the window is in MARS's manual mode, in which each key without another
    command does one step.
    """
    if name.startswith("ctrl+"):
        return _BY_NAME.get(name) or _BY_NAME.get(name.replace("shift+", ""))
    key = (_BY_NAME.get(character) if character in "+-" else None) or _BY_NAME.get(name)
    if not manual or name in MODIFIERS or character.isdigit():
        return key
    return _STEP if key is None or key.action == "pause" else key


class Keyboard:
    """Turns pressed keys into commands; digits make a number for the next command."""

    def __init__(self) -> None:
        """Start with no key held and nothing typed."""
        self.number = 0  # typed so far
        self._held: set[int] = set()

    def press(self, code: int, character: str, modifiers: int = 0, *, manual: bool) -> Key | None:
        """Press a key; return its command, or None.

        code, modifiers: pygame's. character, manual: as for `action_of`.
        """
        held = code in self._held
        self._held.add(code)
        name = pygame.key.name(code)
        both = chord(code, modifiers)
        if modifiers & CONTROL or both in _BY_NAME:
            name = both
        elif _is_digit(character):
            if not held:
                self.number = min(10 * self.number + int(character), MAX_NUMBER)
            return None
        key = action_of(name, character, manual=manual)
        return key if key is not None and (key.repeats or not held) else None

    def forget(self, code: int, character: str) -> None:
        """Forget the typed number after a key, unless it is a digit or only modifies others."""
        if not _is_digit(character) and pygame.key.name(code) not in MODIFIERS:
            self.number = 0

    def typed(self, otherwise: int) -> int:
        """Return the typed number, or another one if none was typed; forget it."""
        number, self.number = self.number, 0
        return number or otherwise

    def release(self, code: int) -> None:
        """Release a key."""
        self._held.discard(code)

    def clear(self) -> None:
        """Release all keys."""
        self._held.clear()


def _is_digit(character: str) -> bool:
    return character.isdigit() and character.isascii()
