"""What is said across the foot of a window where nothing follows: why it is over, what failed."""

from __future__ import annotations

from mars2d.core.errors import Mars2dError
from mars2d.core.usercode import Excerpt, excerpt_of
from mars2d.output.raster.bars import Banner
from mars2d.window.player import Player
from mars2d.world.timeline import Timeline

__all__ = ["Outcome"]

HINT = "← looks back   R restarts   Esc leaves"
MEND = "correct the file and save it"


class Outcome:
    """Tells how what a player plays has ended.

    The lines of code that an error is about are those that were run: they are read once, however
    the file is edited while they are shown.
    """

    def __init__(self, player: Player) -> None:
        """Start with nothing to tell."""
        self._player = player
        self._error: Mars2dError | None = None
        self._excerpt: Excerpt | None = None

    def banner(self) -> Banner | None:
        """Return what has to be said now, or None."""
        player = self._player
        if player.failed and player.error is not None:
            excerpt = self._excerpt_of(player.error)
            hint = HINT if excerpt is None else f"{MEND}   {HINT}"
            return Banner(str(player.error), hint, error=True, excerpt=excerpt)
        if not player.over:
            return None
        return Banner(player.frame.over_message or "The experiment is over.", HINT)

    def _excerpt_of(self, error: Mars2dError) -> Excerpt | None:
        if error is not self._error:
            source = self._player.source
            path = source.experiment.path if isinstance(source, Timeline) else None
            self._error, self._excerpt = error, excerpt_of(error, path)
        return self._excerpt
