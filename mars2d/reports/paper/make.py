"""Make figures: run their experiments, draw them, and compare them with theory."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from mars2d.core.hints import described
from mars2d.output.figures.figure import plot_paths, plot_snapshots, save_drawing
from mars2d.reports.paper.figure import Figure, Picture, Result, Run
from mars2d.reports.paper.studies.base import Study
from mars2d.scenario.experiment import Experiment, open_experiment, open_module
from mars2d.study.work import Failure, each_done, worker_count
from mars2d.world.loop import simulate
from mars2d.world.record import Record

Watch = Callable[[int, Sequence[int]], None]
"""Called with the number of figures done, and the numbers of those being made."""


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
            options = {**run.options, "animation.theory": True}
            experiment = open_experiment(run.experiment, options, seed=seed)
            setting = setting or _setting(run.experiment)
            record = simulate(experiment).record
            pictures.append(_of_run(run, experiment, record, figure.number, folder))
            records.append(record)
        except Exception as error:  # the page shows the problem in place of the figure
            problems.append(f"{run.experiment}: {described(error)}")
    for name, study in figure.studies.items():
        if len(records) < len(figure.runs):
            problems.append(f"{name}: not made, since it needs a run that failed")
            continue
        try:
            pictures.append(_of_study(study, records, folder / f"fig{figure.number}_{name}"))
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

    The figures with the most work are begun first. done: filled as figures are completed, by their
    numbers, also if Ctrl-C ends the rest. processes: by default one per processor; with 1, or for
    one figure, no process is started. The results do not depend on it.
    """
    count = min(worker_count(processes), len(figures))
    if count <= 1:
        for figure in figures:
            watch(len(done), [figure.number])
            done[figure.number] = make(figure, folder, seed)
        return
    order = sorted(figures, key=lambda figure: -figure.work)
    left = [figure.number for figure in order]
    watch(0, left[:count])
    for index, made in each_done(partial(make, folder=folder, seed=seed), order, workers=count):
        number = order[index].number
        done[number] = Result(number, problems=(made.error,)) if isinstance(made, Failure) else made
        left.remove(number)
        watch(len(done), left[:count])
