"""What laws print: in the terminal as ever, and in a panel with the last lines first."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from typing import Any

from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.window.screen.player import Player
from mars2d.window.widgets.panel import LINE, Panel
from mars2d.window.widgets.rows import Row, Word

MOST = 200
"""How many lines are kept."""


class Printed(Panel):
    """Shows the lines that were printed, each with the time of the run.

    lines: times [s] and texts, the last one first.
    """

    name, title, least, remembered = "printed", "Printed", 6 * LINE, False

    def __init__(self, painter: Painter, player: Player) -> None:
        """Start with nothing printed."""
        super().__init__(painter)
        self.lines: deque[tuple[float, str]] = deque(maxlen=MOST)
        self._player, self._begun = player, ""

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Take what is printed meanwhile; it goes to the terminal, too."""
        with redirect_stdout(_Tee(sys.stdout, self.take)):
            yield

    def take(self, text: str) -> None:
        """Take a text of any length, which may end within a line."""
        *whole, self._begun = f"{self._begun}{text}".split("\n")
        for line in whole:
            self.lines.appendleft((self._player.source.frame.time, line.rstrip()))

    def rows(self, frame: Frame, width: float) -> Sequence[Row]:  # noqa: ARG002
        """Return the lines, or that there are none."""
        theme = self.painter.theme
        if not self.lines:
            return [self.line([Word("no law has printed anything yet", theme.muted)])]
        return [
            self.line([Word(text, theme.text)], [Word(f"{time:.2f} s", theme.muted)])
            for time, text in self.lines
        ]


class _Tee:
    """A stream that passes on what is written, and is otherwise the terminal's."""

    def __init__(self, terminal: Any, take: Callable[[str], None]) -> None:
        self._terminal, self._take = terminal, take

    def write(self, text: str) -> int:
        self._take(text)
        return int(self._terminal.write(text))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._terminal, name)
