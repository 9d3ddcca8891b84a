"""How a person likes the window to look, whatever the experiment."""

from __future__ import annotations

from mars2d.core.description import Description, flag, number

__all__ = ["Preferences"]


class Preferences(Description):
    """How a window looks at first; its keys change it."""

    dark: bool = flag(default=False, doc="for a dark room, else for a projector in daylight")
    text: float = number(default=1.0, low=0.5, high=4, doc="factor on the size of text and lines")
