"""The verb ``run``."""

from __future__ import annotations

import argparse
import inspect
import json
import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from mars2d.cli import remarks
from mars2d.cli.arguments import MANY, Output, option, options_of, preferences_of, refuse, shared
from mars2d.cli.outputs import check_film, conclude, outcome, run_and_save
from mars2d.cli.runs import opens_window, require_display, run_headless
from mars2d.core.errors import InputError, counted, likely, one_line
from mars2d.core.terminal import tell, warn
from mars2d.output import formats
from mars2d.output.films.footage import Drawings
from mars2d.scenario.code_file import lesson_of
from mars2d.scenario.experiment import Experiment, open_experiment
from mars2d.scenario.prediction import table
from mars2d.scenario.roles import robots_named
from mars2d.window import show
from mars2d.world.loop import Interrupted
from mars2d.world.record import Record
from mars2d.world.world import Watcher, World

FOXGLOVE = 8765
"""The port at which Foxglove looks for a server."""

_SAVED = "save all data: .npz, .csv, or .mcap, which is written during the run; .mat"
_SERVED = f"serve the run to Foxglove on this machine while it goes on, at port {FOXGLOVE}"
_DRIVEN = "a robot to drive by hand: its name or index, or a role; may be given twice"

ARGUMENTS = {
    **shared("experiment headless seed speed stop-time set figure at video size from to"),
    **shared("html theory dark text json"),
    "--record": option("OUT", _SAVED, Path, action=Output),
    "--foxglove": option("PORT", _SERVED, int, nargs="?", const=FOXGLOVE),
    "--human": option("WHO", _DRIVEN, **MANY),
}


def execute(arguments: argparse.Namespace) -> None:
    """Run an experiment, in a window if there is a display, and save the requested files."""
    if arguments.figure is None:
        refuse(arguments, "at", "needs --figure OUT")
    experiment = open_experiment(arguments.experiment, options_of(arguments), seed=arguments.seed)
    humans = _check(arguments, experiment)
    for remark in remarks.before(experiment):
        warn(remark)
    watched, start = deque[World](maxlen=1), time.perf_counter()
    try:
        with _live(arguments.foxglove) as live:
            drawings = Drawings()
            watchers: list[Watcher] = [watched.append, *live, *[drawings] * bool(arguments.video)]

            def run() -> Record:
                if not opens_window(not arguments.headless):
                    return _run_headless(arguments, experiment, watchers)
                speed, own = arguments.speed, experiment.scenario.animation.playback_speed
                if speed is None:
                    speed = 1.0 if humans else own
                for heading, text in () if arguments.json else lesson_of(experiment.source.path):
                    if heading in ("Question", "Prediction", "Try"):  # the window shows it all
                        tell(f"{heading}: {text}")
                look, log = preferences_of(arguments), formats.log_to(arguments.record)
                asks = arguments.record is None
                return show.show_experiment(
                    experiment, speed, watchers, look, humans=humans, log=log, asks=asks
                )

            record, made, troubles = run_and_save(arguments, run, drawings)
    except Interrupted:
        _warn_unchecked(experiment, "cut short")
        raise
    _warn_lawless(experiment)
    if not arguments.json:
        steps = counted(record.steps, "step")
        done = f"{steps}, {counted(record.collisions, 'collision')}, digest {record.digest[:16]}"
        tell(f"{record.scenario.title}: {one_line(record.over_message)}. {done}")
    if not record.finished:
        _warn_unchecked(experiment, "cut short")
    elif record.interventions:
        _warn_unchecked(experiment, "changed by hand")
    predictions = experiment.predictions(record)
    if arguments.json:
        found = outcome(record) | {"over": record.finished, "seed": record.seed}
        found["wall_s"] = round(time.perf_counter() - start, 6)
        found["checks"] = [prediction.as_dict() for prediction in predictions]
        tell(json.dumps(found, allow_nan=False))
    else:
        if predictions:
            tell("", *filter(None, [experiment.source.summary, table(predictions)]), sep="\n")
        for world in watched:
            for remark in remarks.after(world):
                tell(f"note: {remark}")
    conclude({} if arguments.json else made, troubles)


def _check(arguments: argparse.Namespace, experiment: Experiment) -> tuple[int, ...]:
    """Return the robots that --human names. Raises InputError for what can't be done."""
    scenario = experiment.scenario
    for moment in arguments.at or ():
        if moment != "end" and not 0 <= moment <= scenario.stop_time:
            last = f"the experiment goes from 0 to {scenario.stop_time:g} s"
            raise InputError(f"--at {moment:g}: {last}")
    check_film(arguments, scenario, scenario.last_iteration * scenario.sampling_time)
    humans = robots_named(scenario, arguments.human, "--human")
    needs = ""
    if humans:
        needs = f"--human {', '.join(arguments.human)}: driving by hand"
    elif arguments.speed == 0:
        needs = "--speed 0 makes one step a key press, and"
    if needs and arguments.headless:
        raise InputError(f"{needs} needs a window, not --headless")
    if needs:
        require_display(f"{needs} needs a window, and there is no display")
    return humans


@contextmanager
def _live(port: int | None) -> Iterator[list[Watcher]]:
    """Serve the run to Foxglove at a port, and yield who sends it."""
    if port is None:
        yield []
        return
    from mars2d.output.formats.mcap.live import Live

    with Live(port) as live:
        warn(f"Foxglove: open {live.address}")
        yield [live]


def _run_headless(
    arguments: argparse.Namespace, experiment: Experiment, watchers: Sequence[Watcher]
) -> Record:
    """Run as fast as possible, or in real time for Foxglove; --speed is the film's, too."""
    log = formats.log_to(arguments.record)
    pace = "max" if arguments.foxglove is None else arguments.speed or 1.0
    return run_headless(experiment, watchers, log, pace).record


def _warn_lawless(experiment: Experiment) -> None:
    """Say that no robot has a law, and how a function of the file that is none becomes one."""
    scenario, hint = experiment.scenario, ""
    laws = [experiment.control, *(robot.controller for robot in scenario.robots)]
    if any(laws) or scenario.props:
        return
    for name, function in experiment.source.functions.items():
        first = next(iter(inspect.signature(function).parameters), "")
        if first == "robot":
            hint = f"; give {name}(robot) to a robot: Robot(controller={name})"
        elif first == "world" or likely(name, ["control"]):
            hint = f"; the law of the team must be called control: rename {name}({first})"
    warn(f"there is no law, so all robots stood still{hint}")


def _warn_unchecked(experiment: Experiment, happened: str) -> None:
    if experiment.source.checks is not None:
        warn(f"the run was {happened}, so its checks were not made")
