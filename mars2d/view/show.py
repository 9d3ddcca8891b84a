"""Play an experiment or a record in a window."""

from __future__ import annotations

from mars2d.errors import InputError
from mars2d.files import Experiment
from mars2d.record import Record
from mars2d.view.source import Live, Playback
from mars2d.view.window import Window

__all__ = ["show_experiment", "show_record"]


def show_experiment(experiment: Experiment, speed: float | str, seed: int = 0) -> Record:
    """Run an experiment in a window until it is closed, and return what was recorded until then.

    speed: simulated seconds per second, "max", or 0 for one step a key press. Raises InputError
    without a display, and what a law raised, once the window is closed.
    """
    source = Live(experiment, seed)
    Window(source, speed).run()
    return source.record


def show_record(record: Record, speed: float | str) -> None:
    """Play a record in a window until it is closed."""
    if not len(record):
        raise InputError("this record has no rows: the run ended before its first step")
    Window(Playback(record), speed).run()
