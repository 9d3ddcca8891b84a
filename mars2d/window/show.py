"""Show an experiment or a record in a window."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from typing import TYPE_CHECKING

from mars2d.core.errors import InputError, Mars2dError
from mars2d.core.interrupt import interrupts
from mars2d.output.figures.comparison import MODES
from mars2d.output.raster import require_pygame
from mars2d.scenario.controllers import ByHand
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import Experiment
from mars2d.scenario.roles import MOST_PEOPLE
from mars2d.window.screen.display import Preferences
from mars2d.window.screen.source import Playback
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record
from mars2d.world.timeline import Timeline
from mars2d.world.world import Watcher

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log
    from mars2d.window.run.window import Window
    from mars2d.window.screen.memory import Memory
    from mars2d.window.screen.viewpoint import Viewpoint


def show_experiment(
    experiment: Experiment,
    speed: float | str,
    watchers: Sequence[Watcher] = (),
    preferences: Preferences | None = None,
    humans: Sequence[int] = (),
    log: Log | None = None,
    *,
    asks: bool = False,
    viewpoint: Viewpoint | None = None,
    play: bool = False,
) -> Record:
    """Run an experiment in a window until it is closed, and return the record.

    speed: simulated seconds per second, "max", or 0 for one step a key press. preferences: how the
    window looks. humans: the robots that people drive by hand; the run begins with a countdown.
    log: writes each control step to a file; it is closed at the end. asks: whether the window asks
    before it closes if a run that hands have changed is to be saved. viewpoint: where the window
    looks, and where it has looked in the end. play: whether people may choose their roles in a
    game. Raises InputError without a display, and the error of a law after the window is closed.
    """
    require_pygame("a window")
    source: Timeline | None = None
    kept = interrupts(kept=lambda: None if source is None else source.record)
    with kept, log or nullcontext():
        source = Timeline(experiment, watchers, log)
        window, memory = _window_of(source, speed, preferences)
        window.asks = asks
        if viewpoint is not None:
            window.viewpoint.look_as(viewpoint)
        robots = enumerate(experiment.scenario.robots)
        by_hand = [i for i, robot in robots if isinstance(robot.controller, ByHand)]
        drivers = list(humans) or by_hand  # robots whose law is that a person drives them
        if drivers or play:
            window.play(drivers[:MOST_PEOPLE])
        else:
            window.director.say_who_stands_still()
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
            memory.keep(**window.remembered)
            if viewpoint is not None:
                viewpoint.look_as(window.viewpoint)
        path = experiment.source.path
        if path is not None and path.parent not in {each.parent for each in examples().values()}:
            memory.opened(path, window.arena())
    return source.record


def show_record(record: Record, speed: float | str, preferences: Preferences | None = None) -> None:
    """Play a record in a window until it is closed."""
    if not len(record):
        raise InputError("this record has no rows: the run ended before its first step")
    require_pygame("a window")
    window, memory = _window_of(Playback(record), speed, preferences)
    try:
        window.run()
    finally:
        memory.keep(**window.remembered)


def _window_of(
    source: Timeline | Playback, speed: float | str, preferences: Preferences | None
) -> tuple[Window, Memory]:
    """Return a window that looks as the last one did, and what windows remember."""
    from mars2d.window.run.window import Window
    from mars2d.window.screen.memory import Memory

    memory = Memory()
    window = Window(source, speed, memory.size, preferences or memory.preferences())
    window.dock.open(memory.panels)
    return window, memory


def show_comparison(
    opened: Callable[[str], Experiment],
    speed: float | str,
    preferences: Preferences | None = None,
) -> dict[str, Record]:
    """Run an experiment with each physics, side by side in a window until it is closed.

    opened: returns the experiment of a physics. Returns the records by their physics. Raises what
    `show_experiment` does.
    """
    require_pygame("a window")
    from mars2d.window.compare_window import CompareWindow
    from mars2d.window.screen.memory import Memory
    from mars2d.window.screen.source import Trio

    memory, runs = Memory(), {mode: Timeline(opened(mode)) for mode in MODES}
    CompareWindow(Trio(runs), speed, memory.size, preferences or memory.preferences()).run()
    return {mode: run.record for mode, run in runs.items()}
