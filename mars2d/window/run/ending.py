"""Why a run has ended, what a person can do then, and the file in the person's own editor."""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path
from subprocess import Popen

from mars2d.core.errors import InputError, Mars2dError
from mars2d.output.excerpt import Excerpt, excerpt_of
from mars2d.output.raster.bars import Banner
from mars2d.window.screen.player import Player
from mars2d.window.widgets.notes import Notes
from mars2d.world.timeline import Timeline

GOES_TO = ("code", "code-insiders", "codium", "cursor", "windsurf")
"""Editors that take ``--goto file:line``."""
COLON = ("subl", "zed", "hx", "pulsar")
"""Editors that take ``file:line``. All others are given ``+line file``, as vi and nano are."""

HINT = "← looks back   R restarts   Ctrl Q leaves"
AGAIN = "R plays again   Ctrl Q leaves"
MEND = "F7 opens the file: correct and save it"


class Ending:
    """Tells why a run has ended; of_game: whether people play in it.

    The banner of an error shows the lines of code that were run. They are read once, so that edits
    of the file do not change them.
    """

    def __init__(self, player: Player) -> None:
        """Start without an error."""
        self._player, self.of_game = player, False
        self._error: Mars2dError | None = None
        self._excerpt: Excerpt | None = None
        self.editors: list[Popen[bytes]] = []  # that were opened

    def open_source(self, notes: Notes) -> None:
        """Open the experiment's file in the person's own editor, at the line of an error."""
        source, where = self._player.source, None
        if isinstance(source, Timeline) and source.experiment.source.path is not None:
            where = source.experiment.source.path, 1
        if self._player.failed and self._excerpt is not None:
            where = self._excerpt.file, self._excerpt.line
        if where is None:
            notes.say("there is no file to open", "warning")
            return
        try:
            self.editors.append(open_at(*where))
        except InputError as error:
            notes.say(str(error), "error")

    def banner(self) -> Banner | None:
        """Return the banner for the window's footer, None while the run goes on."""
        player = self._player
        if player.failed and player.error is not None:
            if player.error is not self._error:
                source = player.source
                path = source.experiment.source.path if isinstance(source, Timeline) else None
                self._error, self._excerpt = player.error, excerpt_of(player.error, path)
            excerpt = self._excerpt
            hint = HINT if excerpt is None else f"{MEND}   {HINT}"
            return Banner(str(player.error), hint, error=True, excerpt=excerpt)
        if not player.over:
            return None
        hint = AGAIN if self.of_game else HINT
        return Banner(player.frame.over_message or "The experiment is over.", hint)


def command_for(file: Path, line: int) -> list[str]:
    """Return the command that opens a file: $VISUAL, $EDITOR, or what the system has for it."""
    words = shlex.split(os.environ.get("VISUAL") or os.environ.get("EDITOR") or "")
    if not words:
        system = {"darwin": ["open"], "win32": ["cmd", "/c", "start", ""]}
        return [*system.get(sys.platform, ["xdg-open"]), str(file)]
    name = Path(words[0]).stem
    if name in GOES_TO:
        return [*words, "--goto", f"{file}:{line}"]
    return [*words, f"{file}:{line}"] if name in COLON else [*words, f"+{line}", str(file)]


def open_at(file: Path, line: int) -> Popen[bytes]:
    """Open a file at a line, and don't wait. Raises InputError where there is no such editor."""
    command = command_for(file, line)
    try:
        return Popen(command)
    except OSError as error:
        raise InputError(
            f"{command[0]} can't be started ({error.strerror}): set VISUAL to your editor, such as "
            "VISUAL=code"
        ) from None
