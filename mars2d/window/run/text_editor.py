"""The person's own text editor, which opens a file at a line."""

from __future__ import annotations

import os
import shlex
import sys
from pathlib import Path
from subprocess import Popen

from mars2d.core.errors import InputError

GOES_TO = ("code", "code-insiders", "codium", "cursor", "windsurf")
"""Editors that take ``--goto file:line``."""
COLON = ("subl", "zed", "hx", "pulsar")
"""Editors that take ``file:line``. All others are given ``+line file``, as vi and nano are."""


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
