"""Show an experiment or a record in a window."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.interrupt import noted_interrupts
from mars2d.output.raster import require_pygame
from mars2d.record.record import Record
from mars2d.scenario.experiment import Experiment
from mars2d.window.display import Preferences
from mars2d.window.source import Playback
from mars2d.world.loop import Interrupted
from mars2d.world.timeline import Timeline
from mars2d.world.world import Watcher

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log

__all__ = ["show_experiment", "show_record"]


def show_experiment(
    experiment: Experiment,
    speed: float | str,
    seed: int = 0,
    watchers: Sequence[Watcher] = (),
    preferences: Preferences | None = None,
    human: int | None = None,
    log: Log | None = None,
) -> Record:
    """Run an experiment in a window until it is closed, and return the record.

    speed: simulated seconds per second, "max", or 0 for one step a key press. preferences: how the
    window looks. human: the robot to drive by hand; the run then waits for the person to start it.
    log: writes each control step to a file; it is closed at the end. Raises InputError without a
    display, and the error of a law after the window is closed.
    """
    require_pygame("a window")
    from mars2d.window.window import Window

    source: Timeline | None = None
    kept = noted_interrupts(lambda: None if source is None else source.record)
    with kept, log or nullcontext():
        source = Timeline(experiment, seed, watchers, log)
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
        finally:
            if log is not None:
                log.close(source.record)
    return source.record


def show_record(record: Record, speed: float | str, preferences: Preferences | None = None) -> None:
    """Play a record in a window until it is closed."""
    if not len(record):
        raise InputError("this record has no rows: the run ended before its first step")
    require_pygame("a window")
    from mars2d.window.window import Window

    Window(Playback(record), speed, preferences=preferences).run()
