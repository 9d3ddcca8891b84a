"""Hot reload: an experiment's files are watched, and read again when they are saved."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from mars2d.core.errors import Mars2dError
from mars2d.core.files import files_read
from mars2d.world.branch import Progress
from mars2d.world.timeline import Timeline

INTERVAL = 0.3
"""The time between two looks at the files, seconds."""
REST = 0.2
"""How long files must be unchanged before they are read, since editors write in steps, seconds."""

Written = dict[Path, int | None]
"""When files were written, ns; None: one is gone."""


@dataclass(frozen=True, slots=True)
class Reloaded:
    """The effect of a saved file in words; error: why it can't be used."""

    message: str
    error: Mars2dError | None = None


class Reload:
    """Makes a timeline follow its experiment's files as they are saved.

    New laws, obstacles and the like apply from the present row on; larger changes start the run
    again. If a file has an error, the old law goes on. progress: is called with how far the new
    laws have come in the rows that were run before.
    """

    def __init__(self, timeline: Timeline, progress: Progress = lambda _: True) -> None:
        """Start to watch the files."""
        self._timeline, self._progress = timeline, progress
        self._next = 0.0  # when to look again
        self._seen: Written = {}  # at the last look
        self._watch(_written(timeline.experiment.source.written))

    def _watch(self, read: Written) -> None:
        """Watch files from now on; read: when they were written as they were read."""
        self._experiment, self._read = self._timeline.experiment, read

    def poll(self, now: float) -> Reloaded | None:
        """Look at the files if it is time to, and read those that were saved; return the effect.

        now: a monotonic clock, seconds.
        """
        if self._timeline.experiment is not self._experiment:  # it was restarted
            self._watch(_written(self._timeline.experiment.source.written))
        if now < self._next:
            return None
        before, self._seen, self._next = self._seen, _written(self._read), now + INTERVAL
        changed = [path for path in self._seen if self._seen[path] != self._read[path]]
        if changed and self._seen != before:
            self._next = now + REST  # until they have come to rest
            return None
        self._read = self._seen
        if gone := [path.name for path in changed if self._seen[path] is None]:
            return Reloaded(f"{', '.join(gone)} is gone: the run goes on with what it was")
        return self._take(", ".join(path.name for path in changed)) if changed else None

    def waits(self) -> bool:
        """Return whether a file was saved that has not been read yet."""
        return _written(self._read) != self._read

    def _take(self, name: str) -> Reloaded:
        """Open the experiment again, and continue with it; name: of the saved files."""
        with files_read() as files:
            try:
                experiment = self._experiment.reopened()
                words = self._timeline.take(experiment, self._progress)
            except Mars2dError as error:
                self._watch(_written(files) | self._read)
                goes_on = "" if self._timeline.over else "\nthe old law goes on"
                return Reloaded(f"{error}{goes_on}", error)
        self._watch(dict(experiment.source.written))
        return Reloaded(f"{name}: {words}")


def _written(files: Iterable[Path]) -> Written:
    """Return when files were written, ns; None for one that is gone."""
    found: Written = dict.fromkeys(files)
    for path in found:
        with suppress(OSError):
            found[path] = path.stat().st_mtime_ns
    return found
