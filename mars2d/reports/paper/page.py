"""The page, in HTML5: each figure beside the paper's report and the predictions of theory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files

from mars2d.core.errors import counted
from mars2d.reports.paper.figures import Figure, Picture, Result
from mars2d.scenario.prediction import Prediction, number

NUMBERS = "numbers.json"
"""The file of the numbers, which the page links to."""

MARK = '<meta name="generator" content="mars2d paper">'
"""The tag by which the page of an earlier run is recognized."""

WIDE = 1.6
"""A picture at least this many times as wide as high has its own row."""

PAPER = (
    "M. Casini and A. Garulli, MARS: An Educational Environment for Multiagent Robot Simulations, "
    "Modelling and Simulation in Engineering, 2016"
)


def page(figures: Sequence[Figure], done: Mapping[int, Result], seed: int) -> str:
    """Return the page of the figures that were made; it lists the others as missing.

    done: the results, by the figures' numbers.
    """
    from mars2d import __version__

    style = files(__package__).joinpath("page.css").read_text(encoding="utf-8")
    gone = ", ".join(str(figure.number) for figure in figures if figure.number not in done)
    made = [(figure, done[figure.number]) for figure in figures if figure.number in done]
    rows = [
        (
            f'<a href="#figure-{figure.number}">Figure {figure.number}</a>',
            escape(figure.title),
            _cell("ok" if result.ok else "bad", escape(verdict(result))),
        )
        for figure, result in made
    ]
    heads = ("Figure", "Experiment", "Predictions")
    return f"""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
{MARK}
<title>The figures of the MARS paper, regenerated</title>
<style>
{style}</style>
</head>
<body>
<header>
<h1>The figures of the MARS paper, regenerated</h1>
<p class="lead">Figures 2 to 9 of <cite>{PAPER}</cite>, run again by MARS2D {__version__} with seed
{seed}. Beside each stands what the paper reports, in our own words, what theory predicts, and what
was measured. In the pictures, robots are hollow where they start and filled where they are; violet
is theory.</p>
</header>
<main>
{_wrong(f"Broken off: not made: {gone}") if gone else ""}\
{_table("All figures, and how many of the predictions hold", heads, rows)}\
{"".join(_section(figure, result) for figure, result in made)}</main>
<footer>
<p>All numbers of this page, and those of the charts: <a href="{NUMBERS}">{NUMBERS}</a>. Each
picture is there as PDF as well, for reports. The same version and seed give the same digests on the
same kind of machine. Made by <code>mars2d paper</code>.</p>
</footer>
</body>
</html>
"""


def verdict(result: Result) -> str:
    """Return the outcome of a figure in a few words, such as ``3 of 3 predictions ok``."""
    every = len(result.predictions)
    held = f"{every - result.failed} of {counted(every, 'prediction')} ok" if every else "shown"
    if result.problems:
        return f"not all was made; {held}" if result.pictures else "not made"
    return held


def _section(figure: Figure, result: Result) -> str:
    wrong = "".join(_wrong(f"Not made: {problem}") for problem in result.problems)
    if result.failed:
        every = counted(len(result.predictions), "number")
        wrong += _wrong(f"Not as predicted: {result.failed} of {every} is outside of its tolerance")
    law = "".join(f'<p class="law">{line}</p>' for line in figure.law)
    beside = {
        "The paper reports": f"<p>{escape(figure.paper)}</p>",
        "Theory predicts": f"<p>{figure.theory}</p>",
        "Law": f'{law}<p class="source">{escape(figure.source)}</p>',
    }
    for title, text in (("Setting", result.setting), ("Our choices", figure.choices)):
        if text:
            beside[title] = f"<p>{escape(text[0].upper() + text[1:].rstrip('.'))}.</p>"
    notes = "".join(f"<div><h3>{title}</h3>{text}</div>\n" for title, text in beside.items())
    return f"""\
<section id="figure-{figure.number}" aria-labelledby="title-{figure.number}">
<h2 id="title-{figure.number}">Figure {figure.number}. {escape(figure.title)}</h2>
<p class="small">Section {figure.section} of the paper</p>
{wrong}<div class="beside">
<div class="pictures">
{_pictures(result.pictures)}</div>
<aside aria-label="Figure {figure.number}: paper and theory">
{notes}</aside>
</div>
</section>
"""


def _pictures(pictures: Sequence[Picture]) -> str:
    """Return the pictures as HTML, one below the other, pairs of tall ones side by side."""
    made, left = "", [*pictures]
    while left:
        pair = [each.size[0] < WIDE * each.size[1] for each in left[:2]] == [True, True]
        made += "".join(_picture(each, half=pair) for each in left[: 1 + pair])
        left = left[1 + pair :]
    return made


def _picture(picture: Picture, *, half: bool) -> str:
    (width, height), stem, title = picture.size, escape(picture.stem), escape(picture.title)
    below = ""
    if picture.predictions:
        heads = ("What", "Predicted", "Measured", "Tolerance", "Holds")
        below += _table("Predicted and measured", heads, map(_prediction, picture.predictions))
    if picture.digest:
        outcome = f"{escape(picture.outcome)}. Digest <code>{picture.digest}</code>"
        below += f'<p class="small">{outcome}</p>\n'
    if picture.command:
        below += f"<pre><code>{escape(picture.command)}</code></pre>\n"
    return f"""\
<figure{' class="half"' if half else ""} id="{stem}">
<a href="{stem}.pdf"><img src="{stem}.png" width="{width}" height="{height}"
alt="{escape(picture.alt)}"></a>
<figcaption><strong>{title}</strong> {picture.caption}
<a class="vector" href="{stem}.pdf">PDF<span hidden> of {title}</span></a></figcaption>
{below}</figure>
"""


def _prediction(prediction: Prediction) -> tuple[str, ...]:
    p = prediction
    values = [_number(value, p.tolerance) for value in (p.predicted, p.measured)]
    cells = [
        _cell("number", escape(each))
        for each in (*values, f"{p.tolerance:.3g} {p.unit}".replace("^4", "⁴").replace("^2", "²"))
    ]
    return escape(p.name), *cells, _cell(*(("ok", "✓ ok") if p.ok else ("bad", "✗ NOT OK")))


def _number(value: float, tolerance: float) -> str:
    text = number(value, tolerance)
    return f"{value:.3g}" if len(text) > 10 and math.isfinite(value) else text


def _table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; rows: the text of a head, and cells, as text or by `_cell`."""
    head = "".join(f'<th scope="col">{each}</th>' for each in heads)
    body = "".join(
        f'<tr><th scope="row">{first}</th>'
        + "".join(each if each.startswith("<td") else f"<td>{each}</td>" for each in others)
        + "</tr>\n"
        for first, *others in rows
    )
    return f"""\
<div class="scroll" role="region" aria-label="{caption}" tabindex="0">
<table>
<caption>{caption}</caption>
<thead><tr>{head}</tr></thead>
<tbody>
{body}</tbody>
</table>
</div>
"""


def _cell(kind: str, text: str) -> str:
    return f'<td class="{kind}">{text}</td>'


def _wrong(text: str) -> str:
    return f'<p class="wrong" role="alert">{escape(text)}</p>\n'
