"""Live editing: an experiment's files are watched, and read again when they are saved."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.files import files_read
from mars2d.scenario.experiment import Experiment
from mars2d.world.timeline import Progress, Timeline

__all__ = ["Reload", "Reloaded"]

INTERVAL = 0.3
"""The files are looked at no more often, seconds."""
REST = 0.2
"""For so long they must have stayed the same: editors write in several steps, seconds."""

Stamp = tuple[int, int]


@dataclass(frozen=True, slots=True)
class Reloaded:
    """What became of a file that was saved, in words; error: why it could not be used."""

    message: str
    error: Mars2dError | None = None


class Reload:
    """Lets a timeline go on with its experiment's files as they are saved.

    Laws, obstacles and the like are in effect from the present row on; where more has changed, the
    run begins anew. A file with an error is told of, and the old law goes on. progress: is
    told how far the new laws have got with what was run before.
    """

    def __init__(self, timeline: Timeline, progress: Progress = lambda _: True) -> None:
        """Look at the files as they are now."""
        self._timeline, self._progress = timeline, progress
        self._next = self._since = 0.0  # when to look again; when they were last seen to change
        self._stamps: dict[Path, Stamp | None] = {}
        self._contents: dict[Path, bytes] = {}
        self._adopt()

    def poll(self, now: float) -> Reloaded | None:
        """Look at the files if it is time to, and do what has to be done; return what was done.

        now: a clock, seconds.
        """
        if self._timeline.experiment is not self._experiment:  # it was restarted
            self._stamps = {}
            self._adopt()
        if now < self._next or not self._stamps:
            return None
        self._next = now + INTERVAL
        stamps = {path: _stamp(path) for path in self._stamps}
        if stamps != self._stamps:
            self._stamps, self._since, self._changed = stamps, now, True
        if not self._changed or None in stamps.values():
            return None
        if now - self._since < REST:
            self._next = self._since + REST
            return None
        self._changed = False
        contents = {path: _content(path) for path in stamps}
        others = [path.name for path in stamps if contents[path] != self._contents[path]]
        self._contents = contents
        return self._read(", ".join(others)) if others else None

    def _adopt(self) -> None:
        """Watch the files of the timeline's experiment; those not watched yet, as they are now."""
        self._experiment = self._timeline.experiment
        self._watch(self._experiment.files)

    def _watch(self, files: Iterable[Path]) -> None:
        before = self._stamps, self._contents
        self._stamps, self._contents, self._changed = {}, {}, False
        for path in sorted(files):
            known = path in before[0]
            self._stamps[path] = before[0][path] if known else _stamp(path)
            self._contents[path] = before[1][path] if known else _content(path)

    def _read(self, name: str) -> Reloaded:
        """Open the experiment anew, and go on with it; name: that of the files that were saved."""
        with files_read() as files:
            try:
                return Reloaded(f"{name}: {self._take(self._experiment.reopened())}")
            except Mars2dError as error:
                goes_on = "" if self._timeline.over else "\nthe old law goes on"
                problem = Reloaded(f"{error}{goes_on}", error)
        self._watch({*self._stamps, *files})
        return problem

    def _take(self, experiment: Experiment) -> str:
        """Go on with an experiment read again; return what happens, in words."""
        try:
            self._timeline.check(experiment)
        except InputError as error:
            self._timeline.restart(experiment)
            words = f"started anew: {str(error).partition(': ')[2]}"
        else:
            words = self._timeline.take(experiment, self._progress)
        self._adopt()
        return words


def _stamp(path: Path) -> Stamp | None:
    """Return when a file was written and its size; None while there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size


def _content(path: Path) -> bytes:
    """Return what stands for a file's content; empty if it can't be read."""
    try:
        return hashlib.sha256(path.read_bytes()).digest()
    except OSError:
        return b""
