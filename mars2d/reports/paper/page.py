"""The page, in HTML5: each figure beside the paper's report and the predictions of theory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from string import Template

from mars2d.core.errors import counted
from mars2d.reports.paper.figures import Picture, Result
from mars2d.scenario.prediction import SIGNS, Prediction, number

WIDE = 1.6
"""A picture at least this many times as wide as high has its own row."""


def page(results: Sequence[Result], seed: int) -> str:
    """Return the page of some figures."""
    from mars2d import __version__

    heads = ("Figure", "Experiment", "Predictions")
    shown = _table("All figures, and how many of the predictions hold", heads, map(_row, results))
    shown += "".join(map(_section, results))
    return _filled("page", version=__version__, seed=seed, figures=shown)


def _filled(template: str, **parts: object) -> str:
    """Return a template of this folder, filled with HTML."""
    text = files(__package__).joinpath(f"{template}.html").read_text(encoding="utf-8")
    return Template(text).substitute(parts)


def _row(result: Result) -> tuple[str, str]:
    number, kind = result.figure.number, "ok" if result.ok else "bad"
    link = f'<a href="#figure-{number}">Figure {number}</a>'
    return link, _cell(result.figure.title) + _cell(result.verdict, kind)


def _section(result: Result) -> str:
    figure = result.figure
    wrong = "".join(_wrong(f"Not made: {problem}") for problem in result.problems)
    if result.failed:
        every = counted(len(result.predictions), "number")
        wrong += _wrong(f"Not as predicted: {result.failed} of {every} is outside of its tolerance")
    notes = {"Setting": escape(result.setting), "Our choices": figure.choices}
    parts = {
        "wrong": wrong,
        "pictures": "".join(map(_picture, result.pictures)),
        "law": "".join(f'<p class="law">{line}</p>' for line in figure.law),
        "notes": "".join(
            f"<div><h3>{title}</h3><p>{text[0].upper()}{text[1:].rstrip('.')}.</p></div>\n"
            for title, text in notes.items()
            if text
        ),
    }
    return _filled("section", **vars(figure) | parts)


def _picture(picture: Picture) -> str:
    below, (width, height) = "", picture.size
    if picture.predictions:
        heads = ("What", "Predicted", "Measured", "Tolerance", "Holds")
        below += _table("Predicted and measured", heads, map(_prediction, picture.predictions))
    outcome = f"{escape(picture.outcome)}. Digest <code>{picture.digest}</code>"
    below += f'<p class="small">{outcome}</p>\n'
    below += f"<pre><code>{escape(picture.command)}</code></pre>\n"
    shape = "wide" if width >= WIDE * height else "half"
    return _filled("picture", **vars(picture), width=width, height=height, shape=shape, below=below)


def _prediction(p: Prediction) -> tuple[str, str]:
    tolerance = f"{p.tolerance:.3g} {p.unit}".replace("^4", "⁴").replace("^2", "²")
    predicted = SIGNS[p.bound] + _number(p.predicted, p.tolerance)
    values = (predicted, _number(p.measured, p.tolerance), tolerance)
    holds = _cell("✓ ok", "ok") if p.ok else _cell("✗ NOT OK", "bad")
    if p.reason:
        values, holds = ("-", "-", "-"), _cell(f"not predicted: {p.reason}")
    return escape(p.name), "".join(_cell(each, "number") for each in values) + holds


def _number(value: float, tolerance: float) -> str:
    text = number(value, tolerance)
    return f"{value:.3g}" if len(text) > 10 and math.isfinite(value) else text


def _table(caption: str, heads: Sequence[str], rows: Iterable[tuple[str, str]]) -> str:
    """Return a table; rows: the HTML of what heads a row, and that of its cells."""
    head = "".join(f'<th scope="col">{each}</th>' for each in heads)
    body = "".join(f'<tr><th scope="row">{first}</th>{cells}</tr>\n' for first, cells in rows)
    return _filled("table", caption=caption, head=head, body=body)


def _cell(text: str, kind: str = "text") -> str:
    return f'<td class="{kind}">{escape(text)}</td>'


def _wrong(text: str) -> str:
    return f'<p class="wrong" role="alert">{escape(text)}</p>\n'
