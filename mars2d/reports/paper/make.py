"""Make figures: run their experiments, draw them, and write them into a folder with a page."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from mars2d.core.errors import InputError
from mars2d.core.files import atomic_write, writing
from mars2d.core.hints import described
from mars2d.output.figures.figure import save_figure
from mars2d.reports.paper.figures import Figure, Picture, Result, Run
from mars2d.reports.paper.page import page
from mars2d.scenario.experiment import open_experiment, open_module
from mars2d.scenario.options import parse_option
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
    problems: list[str] = []
    for run in figure.runs:
        try:
            pictures.append(_picture(run, folder, seed))
        except Exception as error:  # the page shows the problem in place of the picture
            problems.append(f"{run.stem}: {described(error)}")
    setting = setting_of(figure.runs[0].experiment) if pictures else ""
    return Result(figure, setting, pictures, problems)


def _picture(run: Run, folder: Path, seed: int) -> Picture:
    """Run, draw and save."""
    options = dict(map(parse_option, run.settings)) | {"animation.theory": True}
    experiment = open_experiment(run.experiment, options, seed=seed)
    record = simulate(experiment).record
    end = float(record.time[-1])
    times = run.times_until(end)
    when = f"at {', '.join(f'{moment:.4g}' for moment in times)} s" if times else f"in {end:.4g} s"
    with Image.open(_saved(record, times, folder / run.stem)) as png:
        size = png.size
    return Picture(
        stem=run.stem,
        title=run.title,
        alt=f"Paths of {len(record.scenario.robots)} robots {when}. {run.shows}",
        caption=run.shows,
        size=size,
        command=run.command(record.seed, end),
        outcome=record.over_message,
        digest=record.digest,
        predictions=experiment.predictions(record),
    )


def _saved(record: Record, times: Sequence[float], path: Path) -> Path:
    """Save a picture as .pdf and .png; return the path of the latter."""
    pdf, png = (path.with_suffix(suffix) for suffix in (".pdf", ".png"))
    save_figure(record, pdf, times=times or None)
    return save_figure(record, png, times=times or None)


def setting_of(experiment: str) -> str:
    """Return the sentence after "Setting:" in an experiment's docstring, or an empty text."""
    doc = open_module(experiment).__doc__ or ""
    found = re.search(r"^Setting: (.+?)(?=[.:](?:\s|$)|\n\n|\Z)", doc, flags=re.M | re.S)
    return " ".join(found[1].split()) if found else ""


# -- the folder ------------------------------------------------------------------------------------


def prepare(folder: Path) -> None:
    """Make the folder, or take that of an earlier run, whose page it begins anew.

    Raises InputError for a folder with other things than hidden files, and for one that can't be
    written.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: this is a file; expected a folder")
    page = folder / PAGE
    with writing(folder):
        folder.mkdir(exist_ok=True)
        inside = sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))
        if inside and not (page.is_file() and MARK in page.read_text("utf-8", "replace")):
            raise InputError(
                f"{folder}: holds {inside[0]}, and no page of `mars2d paper`; nothing was changed. "
                "Name a new folder, or an empty one"
            )
        page.write_text(MARK)


def finish(folder: Path, results: Sequence[Result], seed: int) -> Path:
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
    for path, text in ((NUMBERS, numbers), (PAGE, page(results, seed))):
        with atomic_write(folder / path) as file:
            file.write(text.encode())
    return folder / PAGE
