"""The command line: one function a sub-command."""

from __future__ import annotations

import argparse
import json
import re
import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

from mars2d import __version__
from mars2d.errors import InputError, Mars2dError, counted, nearest
from mars2d.files import Experiment, examples, open_experiment, parse_setting
from mars2d.loop import Interrupted, Watcher, simulate
from mars2d.progress import Progress
from mars2d.record import Record, load
from mars2d.registry import members, summary
from mars2d.scenario import playback_speed

__all__ = ["main"]

OK, FAULT, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130

FILM_FPS = 25
DEMO_FILM_SECONDS = 12.0
DEMO_FILM_SIZE = (640, 480)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code: 0 done, 2 bad input, 1 a fault of MARS2D's."""
    try:
        arguments = _parser().parse_args(argv)
        code: int = arguments.function(arguments)
        sys.stdout.flush()
    except Mars2dError as error:
        print(f"mars2d: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("mars2d: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        sys.stderr.close()  # whoever read our output has seen enough
        return OK
    except Exception:
        traceback.print_exc()
        print("mars2d: this is a fault of MARS2D's; please report it as above", file=sys.stderr)
        return FAULT
    return code


# -- the sub-commands -----------------------------------------------------------------------------


def demo(arguments: argparse.Namespace) -> int:
    """List the examples, or play one."""
    if arguments.name is None:
        _print_examples()
        print("\nPlay one:  mars2d demo random_walk")
        return OK
    experiment = open_experiment(_example(arguments.name))
    if not arguments.headless and _has_display():
        _show(experiment, experiment.scenario.animation.playback_speed, arguments.seed)
        return OK
    folder = Path("mars2d_demo")
    _make_folder(folder)
    picture, film = folder / f"{arguments.name}.png", folder / f"{arguments.name}.gif"
    footage = _footage(experiment, experiment.scenario.stop_time / DEMO_FILM_SECONDS)
    record, last = _simulate(experiment, arguments.seed, [footage])
    _save_figure(record, picture, None)
    print(f"picture: {picture}", flush=True)
    _save_film(footage, last, film, DEMO_FILM_SIZE)
    print(f"film:    {film}")
    print(f"{record.scenario.title}: {record.over_message}")
    return OK


def run(arguments: argparse.Namespace) -> int:
    """Run an experiment, in a window where there is one, and save what is asked for."""
    _check_outputs(arguments)
    options = dict(parse_setting(setting) for setting in arguments.set)
    if arguments.stop_time is not None:
        options["stop_time"] = arguments.stop_time
    experiment = open_experiment(arguments.experiment, options)
    _check_times(arguments, experiment)
    start = time.perf_counter()
    try:
        if _wants_window(arguments):
            speed = arguments.speed
            pace = experiment.scenario.animation.playback_speed if speed is None else speed
            record = _show(experiment, pace, arguments.seed)
            _save(arguments, record)
        else:
            record = _run_headless(arguments, experiment)
    except (Mars2dError, Interrupted) as error:
        # What was recorded until then is kept.
        if error.record is not None and len(error.record):
            _save(arguments, error.record)
            if isinstance(error, Interrupted) and arguments.json:
                _print_json(error.record, time.perf_counter() - start)
        raise
    if arguments.json:
        _print_json(record, time.perf_counter() - start)
    else:
        print(_outcome(record))
    return OK


def replay(arguments: argparse.Namespace) -> int:
    """Play a recorded run in the window."""
    record = load(arguments.record)
    if not _has_display():
        from mars2d.view.display import NO_DISPLAY

        raise InputError(NO_DISPLAY.replace("run it", "run the experiment"))
    from mars2d.view.show import show_record

    speed = arguments.speed
    show_record(record, record.scenario.animation.playback_speed if speed is None else speed)
    return OK


def list_parts(_: argparse.Namespace) -> int:
    """List examples, drives, sensors and add-ons, one line each."""
    _print_examples()
    for title, family in (("Drives", "bodies"), ("Sensors", "sensors"), ("Add-ons", "addons")):
        _print_table(title, {name: summary(kind) for name, kind in members(family).items()})
    return OK


def check(arguments: argparse.Namespace) -> int:
    """Say what a file holds and whether it is sound."""
    path = Path(arguments.file)
    if path.suffix == ".npz":
        return _check_record(path)
    if path.suffix not in ("", ".py"):
        raise InputError(f"{path}: expected an experiment (.py) or a record (.npz)")
    experiment = open_experiment(arguments.file)
    _describe(experiment)
    # Some mistakes only show when laws, sensors and add-ons are called.
    sampling_time = experiment.scenario.sampling_time
    trial = experiment.scenario.replace(
        stop_time=min(10 * sampling_time, experiment.scenario.stop_time)
    )
    record, _ = _simulate(Experiment(trial, experiment.control, experiment.filename), 0, [])
    print(f"sound: {len(record)} control steps done")
    return OK


def doctor(_: argparse.Namespace) -> int:
    """Say what this machine offers, and whether the installation works."""
    from mars2d.doctor import examine

    code = OK
    for finding in examine():
        mark = {True: "ok", None: "--", False: "NO"}[finding.ok]
        print(f"{mark}  {finding.name:<12}{finding.text}")
        if finding.ok is False:
            code = FAULT
    return code


# -- their parts ----------------------------------------------------------------------------------


def _example(name: str) -> Path:
    known = examples()
    if name not in known:
        raise InputError(f"{name}: there is no such example{nearest(name, known)}")
    return known[name]


def _print_examples() -> None:
    lines = {}
    for name, path in examples().items():
        first = path.read_text(encoding="utf-8").partition("\n")[0]
        lines[name] = first.strip('" ')
    _print_table("Examples", lines)


def _print_table(title: str, lines: dict[str, str]) -> None:
    print(f"{title}:")
    width = max((len(name) for name in lines), default=0)
    for name, line in lines.items():
        print(f"  {name:<{width}}  {line}")


def _has_display() -> bool:
    from mars2d.view.display import display_available

    return display_available()


def _wants_window(arguments: argparse.Namespace) -> bool:
    if arguments.headless:
        if arguments.speed == 0:
            raise InputError(
                "--speed 0 makes one step a key press: it needs a window, not --headless"
            )
        return False
    if _has_display():
        return True
    if arguments.speed == 0:
        raise InputError(
            "--speed 0 makes one step a key press, and there is no display for a window"
        )
    print("mars2d: there is no display, so this runs without a window", file=sys.stderr)
    return False


def _show(experiment: Experiment, speed: float | str, seed: int) -> Record:
    from mars2d.view.show import show_experiment

    return show_experiment(experiment, speed, seed)


def _run_headless(arguments: argparse.Namespace, experiment: Experiment) -> Record:
    """Run as quick as can be: without a window, a speed is that of the film."""
    watchers: list[Watcher] = []
    footage = None
    if arguments.video is not None:
        footage = _footage(experiment, _film_speed(experiment, arguments.speed))
        watchers.append(footage)
    record, last = _simulate(experiment, arguments.seed, watchers)
    _save(arguments, record, video=False)
    if footage is not None:
        _save_film(footage, last, arguments.video)
    return record


def _simulate(experiment: Experiment, seed: int, watchers: list[Watcher]) -> tuple[Record, Any]:
    """Run without a window, with a progress bar; return the record and the last frame."""
    progress = Progress(experiment.scenario.last_iteration)
    last: list[Any] = []

    def keep(world: Any) -> None:
        last[:] = [world]

    try:
        record = simulate(experiment, seed, watchers=[*watchers, progress, keep])
    finally:
        progress.close()
    return record, last[0].frame


def _film_speed(experiment: Experiment, speed: float | str | None) -> float:
    """Return the speed of a film: the one asked for, else the animation's, else one of 12 s."""
    for choice in (speed, experiment.scenario.animation.playback_speed):
        if isinstance(choice, float) and choice > 0:
            return choice
    return max(experiment.scenario.stop_time / DEMO_FILM_SECONDS, 1e-9)


def _footage(experiment: Experiment, speed: float) -> Any:
    from mars2d.output.footage import Footage

    return Footage(experiment.scenario, speed, FILM_FPS)


def _save_film(footage: Any, last: Any, path: Path, size: tuple[int, int] = (1280, 720)) -> None:
    from mars2d.output.film import save_film

    progress = Progress(footage.count(last), "frames")
    try:
        save_film(footage.frames(last), path, fps=FILM_FPS, size=size, progress=progress.update)
    finally:
        progress.close()


def _save_figure(record: Record, path: Path, times: list[float] | None) -> None:
    from mars2d.output.figure import save_figure

    save_figure(record, path, times)


def _save(arguments: argparse.Namespace, record: Record, *, video: bool = True) -> None:
    """Save what the command asks for, of a record."""
    if arguments.record is not None:
        record.save(arguments.record)
    if arguments.figure is not None:
        _save_figure(record, arguments.figure, arguments.at)
    if video and arguments.video is not None:
        from mars2d.output.film import film_rows, save_film

        experiment = Experiment(record.scenario)
        rows = film_rows(record.time, _film_speed(experiment, arguments.speed), FILM_FPS)
        save_film((record.frame(row) for row in rows), arguments.video, fps=FILM_FPS)


def _check_outputs(arguments: argparse.Namespace) -> None:
    """Refuse a file that can't be written before the run, not after it."""
    suffixes = {"record": (".npz",), "figure": (".png", ".pdf", ".svg"), "video": (".gif", ".mp4")}
    for name, known in suffixes.items():
        path: Path | None = getattr(arguments, name)
        if path is None:
            continue
        if path.suffix.lower() not in known:
            raise InputError(f"--{name} {path}: expected a name that ends in {' or '.join(known)}")
        if not path.parent.is_dir():
            raise InputError(f"--{name} {path}: there is no folder {path.parent}")
        if path.is_dir():
            raise InputError(f"--{name} {path}: this is a folder")
    if arguments.video is not None and arguments.video.suffix.lower() == ".mp4":
        from mars2d.output.film import require_av

        require_av(arguments.video)
    if arguments.at is not None and arguments.figure is None:
        raise InputError("--at needs --figure OUT")


def _check_times(arguments: argparse.Namespace, experiment: Experiment) -> None:
    last = experiment.scenario.stop_time
    for moment in arguments.at or ():
        if not 0 <= moment <= last:
            raise InputError(f"--at {moment:g}: the experiment goes from 0 to {last:g} s")


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder.absolute()}: can't be made: {error.strerror}") from error


def _outcome(record: Record) -> str:
    done = f"{counted(_ticks(record), 'step')}, {counted(record.collisions, 'collision')}"
    message = f"{record.scenario.title}: {record.over_message}"
    return f"{message}. {done}, digest {record.digest[:16]}"


def _ticks(record: Record) -> int:
    """Return how many sampling times passed: one less than there are rows."""
    return max(len(record) - 1, 0)


def _print_json(record: Record, wall: float) -> None:
    print(
        json.dumps(
            {
                "ticks": _ticks(record),
                "time": float(record.time[-1]) if len(record) else 0.0,
                "over": record.finished,
                "message": record.over_message,
                "digest": record.digest,
                "collisions": record.collisions,
                "seed": record.seed,
                "wall_s": round(wall, 6),
            }
        )
    )


def _describe(experiment: Experiment) -> None:
    """Print what was read of an experiment."""
    scenario = experiment.scenario
    xmin, xmax, ymin, ymax = scenario.bounds
    print(f"title       {scenario.title}")
    for robot in scenario.robots[:8]:
        x, y, theta = robot.pose
        parts = [type(robot.drive).__name__, *(sensor.key for sensor in robot.sensors)]
        law = getattr(robot.controller, "__name__", None)
        parts += [f"law {law}"] if law else []
        print(f"{robot.name!s:<12}at ({x:g}, {y:g}, {theta:.4g}): {', '.join(parts)}")
    if len(scenario.robots) > 8:
        print(f"            and {len(scenario.robots) - 8} robots more")
    shape = "no limits" if scenario.workspace is None else f"{len(scenario.workspace)} corners"
    print(
        f"workspace   {xmax - xmin:g} m x {ymax - ymin:g} m, {shape}, on_exit {scenario.on_exit!r}"
    )
    print(f"obstacles   {len(scenario.obstacles)}")
    print(f"add-ons     {', '.join(addon.key for addon in scenario.addons) or 'none'}")
    print(f"time        {scenario.stop_time:g} s in steps of {scenario.sampling_time:g} s")
    law = getattr(experiment.control, "__name__", None)
    own = sum(robot.controller is not None for robot in scenario.robots)
    print(f"laws        {f'{law}(world) of the team, ' if law else ''}{own} of robots' own")
    if law is None and own == 0:
        print("            mind: there is no law, so all robots stand still")


def _check_record(path: Path) -> int:
    from mars2d.rerun import rerun

    record = load(path)
    versions = ", ".join(f"{name} {version}" for name, version in record.versions.items())
    origin = record.filename or "a Scenario"
    print(f"record of   {record.scenario.title} ({origin}), seed {record.seed}")
    print(f"rows        {len(record)}, up to {record.time[-1] if len(record) else 0:g} s")
    print(f"ended       {record.over_message}")
    print(f"made with   {versions}")
    print(f"digest      {record.digest}")
    result = rerun(record)
    if result.identical:
        print("run again   bit-identical")
    else:
        print(f"run again   departs at row {result.row}, by {result.distance:.3g} m or rad")
    return OK


# -- parsing --------------------------------------------------------------------------------------


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line that names the nearest right word."""

    def error(self, message: str) -> NoReturn:
        """Raise an InputError in place of printing the usage and leaving."""
        hint = ""
        known = [option for action in self._actions for option in action.option_strings]
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                known += [*action.choices]
                known += [o for sub in action.choices.values() for o in sub._option_string_actions]
        for word in re.split(r"[\s'=:]+", message):
            found = nearest(word, known)
            if found.startswith("; did") and word not in known:
                hint = found
                break
        message = message.partition(" (choose from")[0]
        raise InputError(f"{message}{hint} (see {self.prog} --help)")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="mars2d", description="Teams of mobile robots in the plane.", allow_abbrev=False
    )
    parser.add_argument("--version", action="version", version=f"mars2d {__version__}")
    verbs = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=_Parser)

    def verb(name: str, function: Any) -> argparse.ArgumentParser:
        doc = (function.__doc__ or "").strip()
        sub = verbs.add_parser(name, help=doc, description=doc, allow_abbrev=False)
        sub.set_defaults(function=function)
        return sub

    sub = verb("demo", demo)
    sub.add_argument(
        "name", nargs="?", metavar="NAME", help="an example; without it, all are listed"
    )
    _add_common(sub)

    sub = verb("run", run)
    sub.add_argument(
        "experiment", metavar="EXPERIMENT", help="a .py file, or the name of an example"
    )
    _add_common(sub)
    _add_speed(sub)
    sub.add_argument("--stop-time", type=float, metavar="S", help="seconds to simulate")
    sub.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="override a field or parameter",
    )
    sub.add_argument("--record", type=Path, metavar="OUT.npz", help="save all data")
    sub.add_argument("--figure", type=Path, metavar="OUT", help="draw the paths: .png, .pdf, .svg")
    sub.add_argument(
        "--at", type=_times, metavar="T1,T2,...", help="snapshots at these times in the figure"
    )
    sub.add_argument("--video", type=Path, metavar="OUT", help="make a film: .gif, .mp4")
    sub.add_argument("--json", action="store_true", help="print the outcome as one line of JSON")

    sub = verb("replay", replay)
    sub.add_argument("record", type=Path, metavar="RECORD", help="a saved run, .npz")
    _add_speed(sub)

    verb("list", list_parts)
    sub = verb("check", check)
    sub.add_argument(
        "file", metavar="FILE", help="an experiment (.py or an example's name), a record (.npz)"
    )
    verb("doctor", doctor)
    return parser


def _add_common(sub: argparse.ArgumentParser) -> None:
    sub.add_argument("--headless", action="store_true", help="without a window")
    sub.add_argument("--seed", type=int, default=0, metavar="N", help="of all random streams")


def _add_speed(sub: argparse.ArgumentParser) -> None:
    sub.add_argument(
        "--speed",
        type=_speed,
        metavar="X",
        help="of window or film: 1 is real time, 0 one step a key press, max",
    )


def _speed(text: str) -> float | str:
    if text == "max":
        return text
    try:
        return playback_speed("--speed", float(text))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: expected a number >= 0, or max") from error


def _times(text: str) -> list[float]:
    try:
        return [float(item) for item in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected times, as 1,30,60") from None
