"""The keys of the window: one table for what they do and for the page of help."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["KEYS", "MODIFIERS", "Key", "action_of"]


@dataclass(frozen=True, slots=True)
class Key:
    """One command: the keys that give it, as pygame names them, and its line of help.

    labels: as on the keyboard. repeats: holding the key repeats it.
    """

    action: str
    names: tuple[str, ...]
    labels: tuple[str, ...]
    help: str
    repeats: bool = False


KEYS = (
    Key("pause", ("space",), ("Space",), "pause, go on; in manual mode one step"),
    Key("step", ("right",), ("→",), "one step, and pause", repeats=True),
    Key("faster", ("+", "=", "[+]"), ("+",), "faster", repeats=True),
    Key("slower", ("-", "[-]"), ("\N{MINUS SIGN}",), "slower", repeats=True),
    Key("grid", ("g",), ("G",), "grid on and off"),
    Key("trails", ("t",), ("T",), "trails on and off"),
    Key("sensors", ("s",), ("S",), "sensors on and off; of a selected robot, its own alone"),
    Key("messages", ("m",), ("M",), "messages between robots on and off"),
    Key("forces", ("c",), ("C",), "forces of contacts, and who slips, on and off"),
    Key("theory", ("y",), ("Y",), "what theory predicts, where add-ons draw it, on and off"),
    Key("select", ("tab",), ("Tab",), "select the next robot or prop: the force on it over time"),
    Key("fit", ("f",), ("F",), "fit the workspace into the window"),
    Key("restart", ("r",), ("R",), "restart from time 0"),
    Key("help", ("f1",), ("F1",), "all keys, on and off"),
    Key("leave", ("escape",), ("Esc",), "close the help, select none, leave"),
)

MOUSE = (
    Key("zoom", (), ("Wheel",), "zoom about the pointer"),
    Key("pan", (), ("Drag",), "move the picture"),
    Key("pick", (), ("Click",), "select a robot or prop; beside them, none"),
)

MODIFIERS = frozenset(
    f"{side} {key}" for side in ("left", "right") for key in ("shift", "ctrl", "alt", "meta", "gui")
) | {"caps lock", "numlock", "scroll lock", "alt gr", "menu", "print screen", ""}
"""Keys that are held or switched for other keys' sake, and do nothing by themselves."""

_BY_NAME = {name: key for key in KEYS for name in key.names}
_STEP = next(key for key in KEYS if key.action == "step")


def action_of(name: str, character: str, *, manual: bool) -> Key | None:
    """Return the command that a key gives, or None.

    name: pygame's name of the key. character: what it types, which tells a + on any keyboard.
    manual: MARS's manual mode, where every key that is no other command does one step.
    """
    key = (_BY_NAME.get(character) if character in "+-" else None) or _BY_NAME.get(name)
    if not manual or name in MODIFIERS:
        return key
    return _STEP if key is None or key.action == "pause" else key
