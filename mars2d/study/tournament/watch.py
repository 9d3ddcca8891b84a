"""A watch on files that must not change."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path


class WatchedFiles:
    """Files that must not change while matches are played."""

    def __init__(self) -> None:
        self._files: dict[Path, tuple[object, bytes | None]] = {}

    def add(self, files: Iterable[Path]) -> None:
        """Watch more files for changes from now on."""
        for file in files:
            if file not in self._files:
                self._files[file] = _stamp(file), _content(file)

    def changed(self) -> Path | None:
        """Return a file whose content has changed, or None."""
        for file, (stamp, content) in self._files.items():
            now = _stamp(file)
            if now != stamp:
                if _content(file) != content:
                    return file
                self._files[file] = now, content
        return None


def _stamp(file: Path) -> object:
    try:
        stat = file.stat()
    except OSError:
        return None
    return stat.st_mtime_ns, stat.st_size, stat.st_ino


def _content(file: Path) -> bytes | None:
    """Return a hash of a file; None if it can't be read."""
    try:
        return hashlib.sha256(file.read_bytes()).digest()
    except OSError:
        return None
