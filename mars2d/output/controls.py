"""What the window and the replay in a browser share: controls, and the marks of the time bar."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from mars2d.output.layers.forces import FORCE
from mars2d.output.raster.theme import Theme
from mars2d.record.marks import MarkKind


class Control(NamedTuple):
    """A control.

    key: its label on the keyboard, or "". icon: the path of an SVG picture, 24 units wide and high,
    that is drawn with lines 2 units wide.
    """

    title: str
    key: str
    icon: str

    @property
    def tip(self) -> str:
        """What is shown beside the pointer."""
        return f"{self.title} ({self.key})" if self.key else self.title


CONTROLS = {
    "start": Control("To the start", "Home", "M6 5v14M19 5 9 12l10 7Z"),
    "back": Control("One step back", "←", "M16 6 8 12l8 6Z"),
    "pause": Control("Play, pause", "Space", "M7 4.5v15l12-7.5Z"),
    "step": Control("One step on", "→", "m8 6 8 6-8 6Z"),
    "newest": Control("To the end", "End", "M18 5v14M5 5l10 7-10 7Z"),
    "loop": Control(
        "Loop", "J", "M4 11a6 6 0 0 1 6-6h9M16 2l3 3-3 3M20 13a6 6 0 0 1-6 6H5M8 22l-3-3 3-3"
    ),
    "layers": Control("Show", "A", "M12 3 3 8l9 5 9-5ZM3 12.5l9 5 9-5M3 17l9 5 9-5"),
    "contacts": Control(
        "Contacts",
        "K",
        "M3.5 15a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0M11.5 9a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0",
    ),
    "parameters": Control(
        "Parameters",
        "F2",
        "M4 7h7M17 7h3M4 17h3M13 17h7M11 7a3 3 0 1 0 6 0a3 3 0 1 0-6 0"
        "M7 17a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    ),
    "scopes": Control("Scopes", "Q", "M4 4v16h16M7 15l4-6 4 4 5-8"),
    "predictions": Control("Predictions", "F3", "M4 6l2 2 3.5-4M4 15l2 2 3.5-4M13 6.5h7M13 15.5h7"),
    "lesson": Control("Lesson", "F4", "M4 5h7l1 1 1-1h7v14h-7l-1 1-1-1H4ZM12 6v13"),
    "drive": Control(
        "Drive by hand",
        "H",
        "M3 12a9 9 0 1 0 18 0a9 9 0 1 0-18 0M9.5 12a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0"
        "M3.6 10.5l6 .8M20.4 10.5l-6 .8M12 14.5V21",
    ),
    "edit": Control("Draw", "E", "M4 20l1-4.5L16 4.5l3.5 3.5L8.5 19ZM13.5 7l3.5 3.5"),
    "restart": Control("Start again", "R", "M5 12a7 7 0 1 0 2.2-5.1L4.5 9.5M4.5 4v5.5H10"),
    "branch": Control(
        "Branches",
        "B",
        "M7 8v13M7 17c0-5 9-3 9-9M4.5 5.5a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0"
        "M13.5 5.5a2.5 2.5 0 1 0 5 0a2.5 2.5 0 1 0-5 0",
    ),
    "nearer": Control("Zoom in", "", "M12 5v14M5 12h14"),
    "farther": Control("Zoom out", "", "M5 12h14"),
    "fit": Control("Show all", "F", "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5"),
    "follow": Control(
        "Follow", "L", "M6 12a6 6 0 1 0 12 0a6 6 0 1 0-12 0M12 2v6M12 16v6M2 12h6M16 12h6"
    ),
    "picture": Control(
        "Save a picture",
        "P",
        "M3 7.5h4l2-3h6l2 3h4V19H3ZM8.5 13a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0-7 0",
    ),
    "film": Control("Film", "V", "M3 6h12v12H3ZM15 10.5l6-3.5v10l-6-3.5"),
    "screen": Control("Full screen", "F11", "M14 4h6v6M20 4l-7 7M10 20H4v-6M4 20l7-7"),
    "dark": Control("Dark", "D", "M20 14.5A8.5 8.5 0 0 1 9.5 4 8.5 8.5 0 1 0 20 14.5Z"),
    "text": Control("Larger text", "Z", "M5 19 12 4l7 15M7.6 13.5h8.8"),
    "help": Control(
        "Help",
        "F1",
        "M3 12a9 9 0 1 0 18 0a9 9 0 1 0-18 0"
        "M9.3 9.4a2.8 2.8 0 1 1 4 2.6c-.9.4-1.3 1-1.3 2M12 17v.5",
    ),
    "about": Control("About this run", "", "M3 12a9 9 0 1 0 18 0a9 9 0 1 0-18 0M12 11v6M12 7.2v.6"),
    "leave": Control("Leave", "Ctrl Q", "M13 4H5v16h8M16 8l4 4-4 4M20 12H9.5"),
    "close": Control("Close", "Esc", "M6 6l12 12M18 6L6 18"),
}
"""By name: the action of the window's keys, where there is one."""

PAUSE = "M7 5h3.4v14H7ZM13.6 5H17v14h-3.4Z"
"""The icon in place of that to play, while time passes."""


class Mark(NamedTuple):
    """A kind of tick.

    color: in a theme. above, below: whether it stands above and below the line. meaning: in words.
    """

    color: Callable[[Theme], str]
    above: bool
    below: bool
    meaning: str


MARKS: dict[MarkKind, Mark] = {
    "collision": Mark(lambda theme: theme.shade(FORCE), False, True, "bodies came to touch"),
    "hand": Mark(lambda theme: theme.hand.ink, True, False, "something was changed by hand"),
    "branch": Mark(lambda theme: theme.past.ink, True, True, "another branch begins"),
    "error": Mark(lambda theme: theme.error.ink, True, True, "the run failed"),
}
"""In the order in which they are drawn."""
