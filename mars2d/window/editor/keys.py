"""The keys of the editor: one table for commands and for the help."""

from __future__ import annotations

from mars2d.window.widgets.keys import Key

TOOLS = (
    Key("select", ("v",), ("V",), "select and move"),
    Key("robot", ("r",), ("R",), "robot; drag to turn it"),
    Key("box", ("b",), ("B",), "box; drag for its size"),
    Key("ball", ("o",), ("O",), "ball; drag for its size"),
    Key("wall", ("w",), ("W",), "wall, corner by corner; Enter or right click ends it"),
    Key("polygon", ("p",), ("P",), "polygon; click the first corner, or Enter, to close it"),
    Key("rectangle", ("k",), ("K",), "rectangular obstacle"),
    Key("waypoint", ("y",), ("Y",), "waypoints of a robot; click another robot for its own"),
    Key("beacon", ("n",), ("N",), "beacon"),
    Key("workspace", ("m",), ("M",), "workspace: drag corners, click an edge for a new one"),
)

EDIT = (
    Key("pose", ("=",), ("=",), "type x y, or x y degrees, for the selection"),
    Key(
        "nudge",
        ("left", "right", "up", "down"),
        ("←", "→", "↑", "↓"),
        "move the selection by a grid step; with Shift by a tenth",
        repeats=True,
    ),
    Key("delete", ("delete", "backspace"), ("Del",), "remove the selection, or its corner"),
    Key("duplicate", ("ctrl+d",), ("Ctrl D",), "duplicate the selection"),
    Key("all", ("ctrl+a",), ("Ctrl A",), "select all"),
    Key("undo", ("ctrl+z",), ("Ctrl Z",), "undo", True),
    Key("redo", ("ctrl+y", "ctrl+shift+z"), ("Ctrl Y",), "redo", True),
)

VIEW = (
    Key("snap", ("g",), ("G",), "snap to the grid on and off"),
    Key("names", ("i",), ("I",), "names on and off"),
    Key("fit", ("f",), ("F",), "fit the workspace into the window"),
    Key("help", ("f1",), ("F1",), "all keys on and off"),
    Key("escape", ("escape",), ("Esc",), "leave the tool, deselect"),
    Key("dark", ("d",), ("D",), "dark or light"),
    Key("text", ("z",), ("Z",), "size of text and lines: for the back row"),
)

FILE = (
    Key("save", ("ctrl+s",), ("Ctrl S",), "save as a scenario file (TOML)"),
    Key("leave", ("ctrl+q", "ctrl+w"), ("Ctrl Q",), "leave; asks first if something would be lost"),
)

RUN = (Key("run", ("ctrl+r", "f5"), ("F5",), "save and run; closing the run returns here"),)

LIVE = (
    Key("now", ("return", "enter"), ("Enter",), "go on from now with the drawing"),
    Key(
        "start", ("shift+return", "shift+enter"), ("Shift Enter",), "run the drawing from the start"
    ),
)

MOUSE = (
    Key("click", (), ("Click",), "select; with Shift one more"),
    Key("drag", (), ("Drag",), "move; from an empty place, select all in the rectangle"),
    Key("turn", (), ("Ring",), "its handle turns; with Shift in steps of 15 degrees"),
    Key("corner", (), ("Corner",), "moves a corner, or resizes a box; the dots add a corner"),
    Key("zoom", (), ("Wheel",), "zoom about the pointer"),
    Key("pan", (), ("Space drag",), "move the picture; so does the middle button"),
)

GROUPS = (
    ("Tools", TOOLS),
    ("Change", EDIT),
    ("Look", VIEW),
    ("File", (*FILE, *RUN)),
    ("In a paused run", LIVE),
    ("Mouse", MOUSE),
)


def groups(*, live: bool) -> tuple[tuple[str, tuple[Key, ...]], ...]:
    """Return the groups of the help; live: whether a paused run is edited."""
    file = ("File", (*LIVE, *FILE) if live else (*FILE, *RUN))
    return (("Tools", TOOLS), ("Change", EDIT), ("Look", VIEW), file, ("Mouse", MOUSE))


_COMMON = {name: key for group in (TOOLS, EDIT, VIEW, FILE) for key in group for name in key.names}
_RUN = {name: key for key in RUN for name in key.names}
_LIVE = {name: key for key in LIVE for name in key.names}


def action_of(name: str, character: str, *, live: bool) -> Key | None:
    """Return the command of a key, or None.

    name: as `chord` returns it. character: the text that it types, which identifies = on every
    keyboard. live: whether a paused run is edited.
    """
    if character == "=":
        return _COMMON["="]
    known = _COMMON | (_LIVE if live else _RUN)
    return known.get(name) or known.get(name.replace("shift+", ""))
