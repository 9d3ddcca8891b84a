"""The buttons of the editor's tools."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mars2d.output.controls import Control
from mars2d.window.editor.keys import TOOLS, VIEW
from mars2d.window.widgets.buttons import Buttons

WIDTH, SIDE = 58.0, 46.0
"""The widths of the toolbar and of a button, points."""

ICONS = {
    "select": "M6 3l12 9-6 1-3 6Z",
    "robot": "M4 12a8 8 0 1 0 16 0a8 8 0 1 0-16 0M12 12l5-5",
    "box": "M5 5h14v14H5Z",
    "ball": "M5 12a7 7 0 1 0 14 0a7 7 0 1 0-14 0M9.5 9.5h.1",
    "wall": "M3 19l5-11 7 4 6-8M8 8h.1M15 12h.1",
    "polygon": "M4 16l9 4 8-9-8-2-4-6Z",
    "rectangle": "M3 7h18v10H3ZM3 12l5-5M3 17 13 7M8 17 18 7M13 17l8-8",
    "waypoint": "M4 19h.1M9 13h.1M14 14h.1M17 10h.1M16 5a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
    "beacon": "M9 12a3 3 0 1 0 6 0a3 3 0 1 0-6 0M12 3v3M12 18v3M3 12h3M18 12h3"
    "M5.6 5.6l2.1 2.1M16.3 16.3l2.1 2.1M18.4 5.6l-2.1 2.1M7.7 16.3l-2.1 2.1",
    "workspace": "M4 8V4h4M12 4h.1M16 4h4v4M20 12v.1M20 16v4h-4M12 20h-.1M8 20H4v-4M4 12v-.1",
    "snap": "M4 8h16M4 16h16M8 4v16M16 4v16",
}
"""The paths of the tools' icons, as those of `CONTROLS`."""


def tool_buttons(actions: Mapping[str, Callable[[], None]], lit: Callable[[str], bool]) -> Buttons:
    """Return a button for each tool, and one for the grid; lit: as for `Buttons`."""
    offered = {key.action: key for key in (*TOOLS, *VIEW) if key.action in ICONS}
    controls = {
        name: Control(offered[name].help.capitalize(), offered[name].labels[0], icon)
        for name, icon in ICONS.items()
    }
    *tools, snap = ICONS
    return Buttons([tools, [snap]], actions, lit, controls=controls, side=SIDE, lettered=True)
