"""Run an experiment: a loop around `World.step` that paces it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from mars2d.errors import InputError, Mars2dError
from mars2d.files import Experiment, open_experiment
from mars2d.pace import RealTime
from mars2d.record import Record
from mars2d.scenario import Scenario, playback_speed
from mars2d.world import World

__all__ = ["run", "run_headless"]

Progress = Callable[[World], None]


def run(
    experiment: str | Path | ModuleType | Scenario,
    stop_time: float | None = None,
    speed: float | str = "max",
    options: Mapping[str, Any] | None = None,
    *,
    control: Callable[[World], Any] | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Record:
    """Run an experiment to its end and return the record. Source: MARS's ``mars(exp_file, ...)``.

    experiment: a file, the name of a shipped example, a module, or a Scenario. stop_time: seconds,
    in place of the scenario's. speed: simulated seconds per second; "max" does not wait; 0 is for
    windows, see `mars2d.view.show`. options: fields by their dotted names, as
    ``{"robots.*.diameter": 0.2}``, and parameters of a scenario function. control: the law of the
    team, in place of the experiment's. seed: of all random streams. progress: called with the
    world after each step.

    Raises InputError for what can't be run. When a law fails, the error carries what was recorded
    until then as its `record`.
    """
    opened = open_experiment(experiment, with_stop_time(options, stop_time), control)
    factor = playback_speed("speed", speed)
    if factor == 0:
        raise InputError("speed = 0: one step a key press needs a window; see mars2d.view.show()")
    return run_headless(opened, seed, factor, progress)


def with_stop_time(options: Mapping[str, Any] | None, stop_time: float | None) -> dict[str, Any]:
    """Return the options with the stop time among them, if one is given."""
    given = dict(options or {})
    if stop_time is not None:
        given["stop_time"] = stop_time
    return given


def run_headless(
    experiment: Experiment,
    seed: int = 0,
    speed: float | str = "max",
    progress: Progress | None = None,
) -> Record:
    """Run an opened experiment without a window. An error carries the record; so does Ctrl-C."""
    pace = RealTime(float(speed)) if speed != "max" else None
    world = World(
        experiment.scenario, experiment.control, seed, filename=experiment.filename, pace=pace
    )
    try:
        while not world.over:
            world.step()
            if progress is not None:
                progress(world)
    except Mars2dError as error:
        error.record = world.record
        raise
    except KeyboardInterrupt as interrupt:
        world.stop("Interrupted by Ctrl-C")
        interrupt.record = world.record  # type: ignore[attr-defined]
        raise
    return world.record
