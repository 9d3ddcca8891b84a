"""Hot reload: an experiment's files are watched, and read again when they are saved."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.files import files_read
from mars2d.scenario.experiment import Experiment
from mars2d.world.branch import Progress
from mars2d.world.timeline import Timeline

INTERVAL = 0.3
"""The time between two looks at the files, seconds."""
REST = 0.2
"""How long files must be unchanged before they are read, since editors write in steps, seconds."""

Stamp = tuple[int, int]


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
        self._stamps: dict[Path, Stamp | None] = {}  # as they were seen last
        self._read_stamps = self._stamps  # as they were read
        self._adopt()

    def poll(self, now: float) -> Reloaded | None:
        """Look at the files if it is time to, and read those that were saved; return the effect.

        now: a monotonic clock, seconds.
        """
        if self._timeline.experiment is not self._experiment:  # it was restarted
            self._stamps = {}
            self._adopt()
        if now < self._next:
            return None
        stamps, self._next = {path: _stamp(path) for path in self._read_stamps}, now + INTERVAL
        if stamps != self._stamps:
            self._stamps, self._next = stamps, now + REST  # until it has come to rest
            return None
        changed = [path for path in stamps if stamps[path] != self._read_stamps[path]]
        self._read_stamps = stamps
        if gone := [path.name for path in changed if stamps[path] is None]:
            return Reloaded(f"{', '.join(gone)} is gone: the run goes on with what it was")
        return self._read(", ".join(path.name for path in changed)) if changed else None

    def waits(self) -> bool:
        """Return whether a file was saved that has not been read yet."""
        return any(_stamp(path) != stamp for path, stamp in self._read_stamps.items())

    def _adopt(self) -> None:
        """Watch the files of the timeline's experiment."""
        self._experiment = self._timeline.experiment
        self._watch(self._experiment.source.written)

    def _watch(self, files: Iterable[Path]) -> None:
        known = self._stamps
        self._stamps = {p: known[p] if p in known else _stamp(p) for p in sorted(files)}
        self._read_stamps = self._stamps

    def _read(self, name: str) -> Reloaded:
        """Open the experiment again, and continue with it; name: of the saved files."""
        with files_read() as files:
            try:
                return Reloaded(f"{name}: {self._take(self._experiment.reopened())}")
            except Mars2dError as error:
                goes_on = "" if self._timeline.over else "\nthe old law goes on"
                problem = Reloaded(f"{error}{goes_on}", error)
        self._watch({*self._stamps, *files})
        return problem

    def _take(self, experiment: Experiment) -> str:
        """Continue with an experiment; return the effect in words."""
        if reason := self._timeline.needs_start(experiment):
            self._timeline.restart(experiment)
            words = f"started again: {reason}"
        else:
            moved = self._timeline.moved(experiment)
            words = self._timeline.take(experiment, self._progress)
            if moved:
                words = f"R starts {', '.join(moved)} from there; all else is {words}"
        self._adopt()
        return words


def _stamp(path: Path) -> Stamp | None:
    """Return the time of writing and the size of a file; None if there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
