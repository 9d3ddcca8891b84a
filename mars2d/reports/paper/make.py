"""Make figures: run their experiments, draw them, and write them into a folder with a page."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from PIL import Image

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write, writing
from mars2d.core.hints import described
from mars2d.output.figures.figure import save_drawing, save_figure
from mars2d.reports.paper.figures import FIGURES, Chart, Figure, Picture, Result, Run
from mars2d.reports.paper.page import page
from mars2d.reports.paper.studies import curves_of, drawn
from mars2d.scenario.experiment import open_experiment, open_module
from mars2d.scenario.options import parse_option
from mars2d.study.work import each_done
from mars2d.world.loop import simulate
from mars2d.world.record import Record

PAGE, NUMBERS = "index.html", "numbers.json"
"""The files of the page, and of the numbers, which it links to."""

MARK = '<meta name="generator" content="mars2d paper">'
"""The tag by which the page of an earlier run is recognized."""


def make(figure: Figure, folder: Path, seed: int = 0) -> Result:
    """Make all pictures of a figure in a folder and return the result.

    A picture that fails is named in the result's problems; the others are made all the same.
    """
    pictures: list[Picture] = []
    records: list[Record] = []
    problems: list[str] = []
    for shown in figure.shown:
        try:
            if isinstance(shown, Run):
                pictures.append(_of_run(shown, folder, seed, records))
            else:
                pictures.append(_of_chart(shown, folder, records, len(figure.runs)))
        except Exception as error:  # the page shows the problem in place of the picture
            problems.append(f"{shown.stem}: {described(error)}")
    setting = setting_of(figure.runs[0].experiment) if records else ""
    return Result(figure, setting, pictures, problems)


def _of_run(run: Run, folder: Path, seed: int, records: list[Record]) -> Picture:
    """Run, draw and save; the record joins the others."""
    options = dict(map(parse_option, run.settings)) | {"animation.theory": True}
    experiment = open_experiment(run.experiment, options, seed=seed)
    record = simulate(experiment).record
    end = float(record.time[-1])
    times = run.times_until(end)
    when = f"at {', '.join(f'{moment:.4g}' for moment in times)} s" if times else f"in {end:.4g} s"
    picture = Picture(
        stem=run.stem,
        title=run.title,
        alt=f"Paths of {len(record.scenario.robots)} robots {when}. {run.shows}",
        caption=run.shows,
        size=_save(partial(save_figure, record, times=times or None), folder / run.stem),
        command=run.command(record.seed, end),
        outcome=record.over_message,
        digest=record.digest,
        predictions=experiment.predictions(record),
    )
    records.append(record)
    return picture


def _of_chart(chart: Chart, folder: Path, records: Sequence[Record], runs: int) -> Picture:
    if len(records) < runs:
        raise InputError("it needs a run that failed")
    with drawn(chart, records) as (drawing, (says, predictions)):
        return Picture(
            stem=chart.stem,
            title=chart.title,
            alt=chart.alt,
            caption=chart.caption.format(**says),
            size=_save(partial(save_drawing, lambda: drawing), folder / chart.stem),
            predictions=predictions,
            curves=curves_of(drawing),
        )


def _save(save: Callable[[Path], Path], path: Path) -> tuple[int, int]:
    """Save a picture as .pdf and .png; return the width and height of the .png, pixels."""
    save(path.with_suffix(".pdf"))
    with Image.open(save(path.with_suffix(".png"))) as png:
        return png.size


def setting_of(experiment: str) -> str:
    """Return the sentence after "Setting:" in an experiment's docstring, or an empty text."""
    doc = open_module(experiment).__doc__ or ""
    found = re.search(r"^Setting: (.+?)(?=[.:](?:\s|$)|\n\n|\Z)", doc, flags=re.M | re.S)
    return " ".join(found[1].split()) if found else ""


def make_all(figures: Sequence[Figure], folder: Path, seed: int) -> Iterator[Result]:
    """Yield the results of figures as they are made in a folder, with a process per core.

    The figures with the most work are begun first. For one figure no process is started.
    """
    order = sorted(figures, key=lambda figure: -figure.work)
    work = partial(make, folder=folder, seed=seed)
    if len(order) == 1:
        yield work(order[0])
        return
    for index, made in each_done(work, order):
        yield made if isinstance(made, Result) else Result(order[index], problems=[made.error])


# -- the folder, which never holds other files -----------------------------------------------------


def prepare(folder: Path) -> None:
    """Make the folder, or remove the files of an earlier run from it.

    Raises InputError for a folder with other files (except hidden ones, which are left alone), and
    for one that can't be written.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: this is a file; expected a folder")
    own = {PAGE, NUMBERS}.union(*(figure.files for figure in FIGURES))
    with writing(folder):
        folder.mkdir(exist_ok=True)
        inside = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
        for path in inside:
            ours = path.name in own and path.is_file()
            if not ours or (path.name == PAGE and MARK not in path.read_text("utf-8", "replace")):
                raise InputError(
                    f"{folder}: holds {path.name}, which is not of `mars2d paper`; nothing was "
                    "changed. Name a new folder, or an empty one"
                )
        for path in inside:
            path.unlink()
        (folder / NUMBERS).touch()  # to find out before the first run whether it can be written


def finish(folder: Path, results: Sequence[Result], missing: Sequence[Figure], seed: int) -> Path:
    """Write the page and the numbers; return the path of the page."""
    made = [
        {
            "figure": result.figure.number,
            "ok": result.ok,
            "problems": result.problems,
            "pictures": [picture.as_dict() for picture in result.pictures],
        }
        for result in results
    ]
    numbers = json.dumps({"seed": seed, "figures": made}, indent=1, allow_nan=False) + "\n"
    for path, text in ((NUMBERS, numbers), (PAGE, page(results, missing, seed))):
        with atomic_write(folder / path) as file:
            file.write(text.encode())
    return folder / PAGE
