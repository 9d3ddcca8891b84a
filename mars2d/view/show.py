"""Play an experiment or a record in a window."""

from __future__ import annotations

from collections.abc import Sequence

from mars2d.errors import InputError, Mars2dError
from mars2d.files import Experiment
from mars2d.loop import Interrupted
from mars2d.record import Record
from mars2d.timeline import Timeline
from mars2d.view.preferences import Preferences
from mars2d.view.source import Playback
from mars2d.view.window import Window
from mars2d.world import Watcher

__all__ = ["show_experiment", "show_record"]


def show_experiment(
    experiment: Experiment,
    speed: float | str,
    seed: int = 0,
    watchers: Sequence[Watcher] = (),
    preferences: Preferences | None = None,
    human: int | None = None,
) -> Record:
    """Run an experiment in a window until it is closed, and return what was recorded until then.

    speed: simulated seconds per second, "max", or 0 for one step a key press. preferences: how the
    window looks. human: a robot that is driven by hand; then it waits until somebody starts it.
    Raises InputError without a display, and what a law raised, once the window is closed.
    """
    source = Timeline(experiment, seed, watchers)
    window = Window(source, speed, preferences=preferences)
    if human is not None:
        window.wait_for(human)
    try:
        window.run()
    except Mars2dError as error:
        error.record = source.record
        raise
    except KeyboardInterrupt:
        raise Interrupted(source.record) from None
    return source.record


def show_record(record: Record, speed: float | str, preferences: Preferences | None = None) -> None:
    """Play a record in a window until it is closed."""
    if not len(record):
        raise InputError("this record has no rows: the run ended before its first step")
    Window(Playback(record), speed, preferences=preferences).run()
