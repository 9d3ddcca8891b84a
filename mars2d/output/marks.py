"""The marks of a time bar, which window and replay share: their colours, places and meanings."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from mars2d.output.layers.forces import FORCE
from mars2d.output.raster.theme import Theme
from mars2d.record.marks import MarkKind


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
