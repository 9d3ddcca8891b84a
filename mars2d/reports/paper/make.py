"""Make figures: run their experiments, draw them, and compare them with theory."""

from __future__ import annotations

import multiprocessing
import re
import signal
import struct
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from mars2d.core.errors import Mars2dError
from mars2d.core.hints import described
from mars2d.core.interrupt import interrupts_blocked
from mars2d.output.figures.figure import plot_paths, plot_snapshots, save_drawing
from mars2d.record.record import Record
from mars2d.reports.paper.figure import Figure, Picture, Result, Run
from mars2d.reports.paper.studies.base import Study
from mars2d.scenario.experiment import Experiment, open_experiment, open_module
from mars2d.study.work import worker_count
from mars2d.world.loop import simulate

__all__ = ["make", "make_all"]

Watch = Callable[[int, Sequence[int]], None]
"""Called repeatedly with the number of figures done, and the numbers of those being made."""


def make(figure: Figure, folder: Path, seed: int = 0) -> Result:
    """Make all pictures of a figure in a folder and return the result.

    A picture that fails is named in the result's problems; the others are made all the same.
    """
    pictures: list[Picture] = []
    records: list[Record] = []
    problems: list[str] = []
    setting = ""
    for run in figure.runs:
        try:
            experiment = open_experiment(run.experiment, {**run.options, "animation.theory": True})
            setting = setting or _setting(run.experiment)
            record = simulate(experiment, seed).record
            pictures.append(_of_run(run, experiment, record, figure.number, folder))
            records.append(record)
        except Exception as error:  # the page shows the problem in place of the figure
            problems.append(f"{run.experiment}: {described(error)}")
    for name, study in figure.studies.items():
        if len(records) < len(figure.runs):
            problems.append(f"{name}: not made, since it needs a run that failed")
            continue
        try:
            stem = f"fig{figure.number}_{name}"
            pictures.append(_of_study(study, records, folder / stem))
        except Exception as error:
            problems.append(f"{name}: {described(error)}")
    return Result(figure.number, setting, tuple(pictures), tuple(problems))


def _of_run(run: Run, experiment: Experiment, record: Record, number: int, folder: Path) -> Picture:
    stem, end = run.stem(number), float(record.time[-1])
    times = run.times_until(end)

    def draw() -> Any:
        return plot_snapshots(record, times) if times else plot_paths(record).get_figure()

    when = f"at {', '.join(f'{moment:.4g}' for moment in times)} s" if times else f"in {end:.4g} s"
    team = len(record.scenario.robots)
    return Picture(
        stem=stem,
        title=run.title,
        alt=f"Paths of {team} robots {when}. {run.shows}",
        caption=run.shows,
        size=_save(draw, folder / stem),
        command=run.command(stem, record.seed, end),
        outcome=record.over_message,
        digest=record.digest,
        predictions=experiment.predictions(record),
    )


def _of_study(
    study: Callable[[Sequence[Record]], Study], records: Sequence[Record], path: Path
) -> Picture:
    made = study(records)
    return Picture(
        stem=path.name,
        title=made.title,
        alt=made.alt,
        caption=made.shows,
        size=_save(made.draw, path),
        predictions=made.predictions,
        columns=made.columns,
    )


def _save(draw: Callable[[], Any], path: Path) -> tuple[int, int]:
    """Save a drawing as .pdf and .png; return the width and height of the .png, pixels."""
    save_drawing(draw, path.with_suffix(".pdf"))
    png = save_drawing(draw, path.with_suffix(".png"))
    with png.open("rb") as file:
        width, height = struct.unpack(">II", file.read(24)[16:])  # in its first chunk
    return width, height


def _setting(experiment: str) -> str:
    """Return the sentence after "Setting:" in an experiment's docstring, or an empty text."""
    doc = open_module(experiment).__doc__ or ""
    found = re.search(r"^Setting: (.+?)(?=[.:](?:\s|$)|\n\n|\Z)", doc, flags=re.M | re.S)
    return " ".join(found[1].split()) if found else ""


def make_all(
    figures: Sequence[Figure],
    folder: Path,
    seed: int,
    done: dict[int, Result],
    watch: Watch,
    processes: int | None = None,
) -> None:
    """Make figures in a folder with several processes, and put the results into `done`.

    done: filled as figures are completed, by their numbers, also if Ctrl-C ends the rest.
    processes: by default one per processor; with 1, or for one figure, no process is started. The
    results do not depend on it.
    """
    count = min(worker_count(processes), len(figures))
    if count <= 1:
        for figure in figures:
            watch(len(done), [figure.number])
            done[figure.number] = make(figure, folder, seed)
        return
    others = multiprocessing.active_children()
    context = multiprocessing.get_context("spawn")  # a fork would copy locks held by threads
    with ProcessPoolExecutor(count, context, initializer=_ignore_interrupts) as pool:
        try:
            _share(figures, folder, seed, done, watch, pool, count)
        except BaseException:
            for child in multiprocessing.active_children():
                if child not in others:
                    child.terminate()  # else we would wait for figures that are not wanted
            raise


def _share(
    figures: Sequence[Figure],
    folder: Path,
    seed: int,
    done: dict[int, Result],
    watch: Watch,
    pool: ProcessPoolExecutor,
    count: int,
) -> None:
    """Give the figures to the processes, those with the most work first."""
    waiting = sorted(figures, key=lambda figure: -figure.work)
    active: dict[Future[Result], int] = {}
    while waiting or active:
        while waiting and len(active) < count:
            figure = waiting.pop(0)
            with interrupts_blocked():  # this may start a process
                future = pool.submit(make, figure, folder, seed)
            active[future] = figure.number
        watch(len(done), sorted(active.values()))
        for future in wait(active, timeout=0.2, return_when=FIRST_COMPLETED).done:
            number = active.pop(future)
            try:
                done[number] = future.result()
            except BrokenProcessPool:
                raise Mars2dError(f"figure {number}: its process was ended from outside") from None


def _ignore_interrupts() -> None:
    """Leave Ctrl-C to the process that started this one."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
