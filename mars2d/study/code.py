"""The code of a run: a hash of all files that its experiment read; and whether they change."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

from mars2d.scenario.experiment import Experiment

__all__ = ["Watched", "code_of"]

DIGITS = 8


def code_of(experiment: Experiment, otherwise: str = "") -> str:
    """Return the first digits of a hash of all files of an experiment, and of MARS2D's version.

    Files count by name and content, wherever they lie. otherwise: what is returned where there are
    no files.
    """
    import mars2d

    if not experiment.files:
        return otherwise
    sha = hashlib.sha256(mars2d.__version__.encode())
    for file in sorted(experiment.files, key=lambda path: (path.name, str(path))):
        sha.update(f"\n{file.name} ".encode(errors="backslashreplace"))
        sha.update(_content(file) or b"")
    return sha.hexdigest()[:DIGITS]


class Watched:
    """Files that are not to change while a study runs."""

    def __init__(self) -> None:
        self._files: dict[Path, tuple[object, bytes | None]] = {}

    def add(self, files: Iterable[Path]) -> None:
        """Watch some more files, from how they are now on."""
        for file in files:
            if file not in self._files:
                self._files[file] = _stamp(file), _content(file)

    def changed(self) -> Path | None:
        """Return a file whose content is another now, or None."""
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
    try:
        return hashlib.sha256(file.read_bytes()).digest()
    except OSError:
        return None
