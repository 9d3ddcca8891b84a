"""Run an experiment in one call, with a window or without."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from mars2d.core.checks import items_of
from mars2d.core.description import wrong
from mars2d.core.errors import InputError, Mars2dError, shown
from mars2d.core.interrupt import interrupts
from mars2d.scenario.animation import playback_speed
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.roles import robots_named
from mars2d.scenario.scenario import Scenario
from mars2d.world.loop import Interrupted, simulate
from mars2d.world.record import Record
from mars2d.world.world import Watcher, World

if TYPE_CHECKING:
    from mars2d.output.formats.mcap import Log


def run(
    experiment: str | Path | ModuleType | Scenario,
    stop_time: float | None = None,
    speed: float | str = "max",
    options: Mapping[str, Any] | None = None,
    *,
    control: Callable[[World], Any] | None = None,
    seed: int = 0,
    show: bool | None = None,
    human: str | int | Sequence[str | int] | None = None,
    watchers: Sequence[Watcher] = (),
    record: str | Path | None = None,
) -> Record:
    """Run an experiment to its end and return the record.

    experiment: a file, the name of a shipped example, a module, or a Scenario. stop_time: seconds,
    in place of the scenario's. speed: simulated seconds per second; "max" does not wait, 0 makes
    one step a key press. options: fields by their dotted names, such as ``{"robots.*.diameter":
    0.2}``, and parameters of a scenario function. control: the law of the team, in place of the
    experiment's. seed: of all random streams, and the ``seed`` of a scenario function that has such
    a parameter. show: whether in a window; by default, if a speed is given and there is a display.
    human: a robot that is driven by hand in a window: its name, its index, or a game's role; or a
    list of two. watchers: functions called with the world at each control step, after its sensors
    are read. record: a file for the record, see `Record.save`. An .mcap file is written at each
    control step, so that nothing is lost where the process is killed; other files at the end.

    Raises InputError for an experiment that can't be run. When a law fails, the error carries the
    record until then as its `record`. Source: MARS's ``mars(exp_file, stop_time, speed, options)``.
    """
    if stop_time is not None:
        options = {**(options or {}), "stop_time": stop_time}
    speed = playback_speed("speed", speed)
    opened = open_experiment(experiment, options, control, seed)
    expected = "a list of functions, each called with the world"
    watchers = items_of("watchers", watchers, expected)
    if not all(map(callable, watchers)):
        raise wrong("watchers", watchers, expected)
    driven = robots_named(opened.scenario, human, "human =")
    target, log = (None, None) if record is None else _output(record)
    with interrupts(held=""):  # Ctrl-C ends a run, and not that it is saved
        try:
            if driven or _wants_window(speed, show):
                from mars2d.window.show import show_experiment

                result = show_experiment(opened, speed, watchers, humans=driven, log=log)
            else:
                result = simulate(opened, speed, watchers, log).record
        except (Mars2dError, Interrupted) as error:
            if target is not None and error.record is not None:
                _keep(error, error.record, target, log)
            raise
        if target is not None and log is None:
            from mars2d.output.formats import save_or_rescue

            save_or_rescue(result, target)
    return result


def _output(record: str | Path) -> tuple[Path, Log | None]:
    """Return the file for the record, and the log that writes it during the run, if any."""
    from mars2d.output import formats

    if not isinstance(record, (str, Path)):
        raise wrong("record", record, "the name of a file, such as 'run.mcap'")
    target = Path(record)
    formats.require(target)
    if not target.parent.is_dir():
        raise InputError(f"record = {shown(str(target))}: there is no folder {target.parent}")
    log = formats.log_to(target)
    return target, log


def _keep(error: BaseException, record: Record, target: Path, log: Log | None) -> None:
    """Save the record of a run that an error ended; a failure to do so becomes a note of it."""
    from mars2d.output.formats import rescued, save_or_rescue

    if log is None:
        try:
            save_or_rescue(record, target)
        except Mars2dError as failure:
            error.add_note(str(failure))
    elif not target.exists() and (place := rescued(record, target)) is not None:
        error.add_note(f"the record is kept as {place}")


def _wants_window(speed: float | str, show: bool | None) -> bool:
    if speed == 0:
        return True  # one step a key press: there is no other way
    if show is not None:
        return show
    if speed == "max":
        return False
    from mars2d.window.screen.display import display_available

    return display_available()
