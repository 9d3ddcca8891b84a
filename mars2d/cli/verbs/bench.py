"""The verb ``bench``."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mars2d.cli.outputs import check_outputs
from mars2d.core.errors import InputError, nearest
from mars2d.core.terminal import tell
from mars2d.reports.bench import suite
from mars2d.reports.bench.report import Change, Report, Row, load_report

HEAD = f"""\
{"":<34}{"overlap":>8}{"steps":>10}{"times":>11}{"deepest":>9}{"bytes per":>11}
{"":<34}{"allowed":>8}{"a second":>10}{"real time":>11}{"seen":>9}{"robot-step":>11}"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add = parser.add_argument
    add("scene", nargs="*", metavar="SCENE", help=f"of {', '.join(suite.NAMES)} (default: all)")
    add("--save", type=Path, metavar="FILE", help="write the figures: .json")
    add("--compare", type=Path, metavar="FILE", help="compare with the figures of an earlier run")
    add("--json", action="store_true", help="print the figures as one line of JSON")
    add("--quick", action="store_true", help="take less than a minute; less certain")


def execute(arguments: argparse.Namespace) -> None:
    """Measure how fast the simulation is on this machine."""
    names = _parts(arguments.scene)
    check_outputs(arguments, {"save": (".json",)})
    old = None if arguments.compare is None else load_report(arguments.compare)
    effort = suite.QUICK if arguments.quick else suite.FULL
    report = _measured(names, effort, old, say=not arguments.json)
    if arguments.save is not None:
        report.save(arguments.save)
    if arguments.json:
        tell(_as_json(report, old))
    else:
        tell(_foot(report, old, arguments.compare))


def _parts(given: list[str]) -> list[str]:
    """Return the names of the requested parts of the suite, in its order."""
    for name in given:
        if name not in suite.NAMES:
            hint = nearest(name, suite.NAMES)
            raise InputError(f"bench {name}: the suite has no such scene{hint}")
    return [name for name in suite.NAMES if name in given or not given]


def _measured(names: list[str], effort: suite.Effort, old: Report | None, *, say: bool) -> Report:
    """Run the suite; print each row as it is done, and on a terminal the job at hand."""
    jobs = suite.jobs(names)
    rows: list[Row] = []
    if say and names != [suite.START]:
        tell(HEAD)
    for number, (name, job) in enumerate(jobs.items(), 1):
        with _announced(f"{number} of {len(jobs)}: {name} ..."):
            rows.append(job(effort))
        if say:
            change = None if old is None else old.change(rows[-1])
            tell(_line(rows[-1], change))
    return Report(tuple(rows))


@contextmanager
def _announced(text: str) -> Iterator[None]:
    """Show a text on the terminal during the block."""
    if not sys.stderr.isatty():
        yield
        return
    print(text, end="", file=sys.stderr, flush=True)
    try:
        yield
    finally:
        print("\r" + " " * len(text) + "\r", end="", file=sys.stderr, flush=True)


def _line(row: Row, change: Change | None) -> str:
    """Return a line of the table for a row."""
    figures = row.figures
    if figures is None:
        text = f"{row.name:<42}{row.seconds:>10.3f} s {row.title}"
    else:
        rate = 1 / row.seconds
        text = (
            f"{row.name:<12}{row.title:<23}{1e3 * figures.max_overlap:>4.0f} mm{rate:>10,.0f}"
            f"{_times(rate * figures.sampling_time):>11}{1e3 * figures.deepest:>6.2f} mm"
            f"{figures.bytes:>11.0f}"
        )
    if change is not None:
        text = f"{text:<86}{change.times_as_fast:>5.2f} x{'  noise' if change.noise else ''}"
    return text


def _times(number: float) -> str:
    return f"{number:.1f}" if number < 100 else f"{number:,.0f}"


def _foot(report: Report, old: Report | None, path: Path | None) -> str:
    """Return the lines below the table: about the yardstick, and about the earlier run."""
    rate = f"{report.yardstick:,.0f} steps a second"
    lines = [f"yardstick: a bare pymunk loop with the robots of S2, {rate}"]
    if old is not None:
        lines[0] += f"; {old.yardstick:,.0f} in {path}"
        lines += [
            f"x: times as fast as in {path}, of {old.date} UTC, each in units of its yardstick",
            "noise: no more than the yardstick varied meanwhile, or the rounds disagree",
            *_uncompiled(old, f"{path} was measured "),
        ]
    return "\n".join([*lines, *_uncompiled(report)])


def _uncompiled(report: Report, words: str = "") -> list[str]:
    why = report.uncompiled
    return [f"{words}with the engine in Python: {why}"] if why else []


def _as_json(report: Report, old: Report | None) -> str:
    data = report.as_data()
    if old is not None:
        changes = {row.name: old.change(row) for row in report.rows}
        data["compared"] = {name: c._asdict() for name, c in changes.items() if c is not None}
    return json.dumps(data)
