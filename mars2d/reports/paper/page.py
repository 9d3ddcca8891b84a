"""The page, in HTML5: each figure beside the paper's report and the predictions of theory."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Mapping, Sequence
from importlib.resources import files
from string import Template

from mars2d.core.errors import counted
from mars2d.reports.paper.figure import Figure, Picture, Result
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

PAGE = Template("""\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
$mark
<title>The figures of the MARS paper, regenerated</title>
<style>
$style</style>
</head>
<body>
<header>
<h1>The figures of the MARS paper, regenerated</h1>
<p class="lead">Figures 2 to 9 of <cite>$paper</cite>, run again by MARS2D $version with seed $seed.
Beside each stands what the paper reports, in our own words, what theory predicts, and what was
measured. In the pictures, robots are hollow where they start and filled where they are; violet
is theory.</p>
</header>
<main>
$missing<div class="scroll" role="region" aria-label="All figures" tabindex="0">
<table class="summary">
<caption>All figures, and how many of the predictions hold</caption>
<thead><tr><th scope="col">Figure</th><th scope="col">Experiment</th>
<th scope="col">Predictions</th></tr></thead>
<tbody>
$rows</tbody>
</table>
</div>
$sections</main>
<footer>
<p>All numbers of this page, and those of the charts: <a href="$numbers">$numbers</a>. Each picture
is there as PDF as well, for reports. The same version and seed give the same digests on the same
kind of machine. Made by <code>mars2d paper</code>.</p>
</footer>
</body>
</html>
""")

SECTION = Template("""\
<section id="figure-$number" aria-labelledby="title-$number">
<div class="head">
<h2 id="title-$number">Figure $number. $title</h2>
<p>Section $section of the paper</p>
</div>
$problems<div class="beside">
<div class="pictures">
$pictures</div>
<aside aria-label="Figure $number: paper and theory">
<div><h3>The paper reports</h3><p>$paper</p></div>
<div><h3>Theory predicts</h3><p>$theory</p></div>
<div><h3>Law</h3>$law<p class="source">$source</p></div>
$more</aside>
</div>
</section>
""")

PICTURE = Template("""\
<figure$kind id="$stem">
<a href="$stem.pdf"><img src="$stem.png" width="$width" height="$height" alt="$alt"></a>
<figcaption><strong>$title</strong> $caption
<a class="vector" href="$stem.pdf">PDF<span hidden> of $title</span></a></figcaption>
$numbers$ending$command</figure>
""")

TABLE = Template("""\
<div class="scroll" role="region" aria-label="Numbers of: $title" tabindex="0">
<table>
<caption>Predicted and measured</caption>
<thead><tr><th scope="col">What</th><th scope="col" class="number">Predicted</th>
<th scope="col" class="number">Measured</th><th scope="col" class="number">Tolerance</th>
<th scope="col">Holds</th></tr></thead>
<tbody>
$rows</tbody>
</table>
</div>
""")


def page(figures: Sequence[Figure], done: Mapping[int, Result], seed: int) -> str:
    """Return the page of the figures that were made; it lists the others as missing.

    done: the results, by the figures' numbers.
    """
    from mars2d import __version__

    gone = [figure.number for figure in figures if figure.number not in done]
    missing = _wrong(f"Broken off: {_numbers(gone)} not made.") if gone else ""
    made = [(figure, done[figure.number]) for figure in figures if figure.number in done]
    return PAGE.substitute(
        mark=MARK,
        style=files(__package__).joinpath("page.css").read_text(encoding="utf-8"),
        paper=_text(PAPER),
        version=_text(__version__),
        seed=seed,
        missing=missing,
        rows="".join(_row(figure, result) for figure, result in made),
        sections="".join(_section(figure, result) for figure, result in made),
        numbers=NUMBERS,
    )


def verdict(result: Result) -> str:
    """Return the outcome of a figure in a few words, such as ``3 of 3 predictions ok``."""
    every = len(result.predictions)
    held = f"{every - result.failed} of {counted(every, 'prediction')} ok" if every else "shown"
    if result.problems:
        return f"not all was made; {held}" if result.pictures else "not made"
    return held


def _row(figure: Figure, result: Result) -> str:
    kind = "ok" if result.ok else "bad"
    return (
        f'<tr><th scope="row"><a href="#figure-{figure.number}">Figure {figure.number}</a></th>'
        f'<td>{_text(figure.title)}</td><td class="{kind}">{_text(verdict(result))}</td></tr>\n'
    )


def _section(figure: Figure, result: Result) -> str:
    wrong = "".join(_wrong(f"Not made: {problem}") for problem in result.problems)
    if result.failed:
        wrong += _wrong(
            f"Not as predicted: {result.failed} of {counted(len(result.predictions), 'number')} "
            "is outside of its tolerance; see the tables."
        )
    more = ""
    for title, text in (("Setting", result.setting), ("Our choices", figure.choices)):
        if text:
            sentence = text[0].upper() + text[1:].rstrip(".") + "."
            more += f"<div><h3>{title}</h3><p>{_text(sentence)}</p></div>\n"
    return SECTION.substitute(
        number=figure.number,
        title=_text(figure.title),
        section=_text(figure.section),
        problems=wrong,
        pictures=_pictures(result.pictures),
        paper=_text(figure.paper),
        theory=typeset(figure.theory),
        law="".join(f'<p class="law">{typeset(line)}</p>' for line in figure.law),
        source=_text(figure.source),
        more=more,
    )


def _pictures(pictures: Sequence[Picture]) -> str:
    """Return the pictures as HTML, one below the other, pairs of tall ones side by side."""
    tall = [picture.size[0] < WIDE * picture.size[1] for picture in pictures]
    made, k = "", 0
    while k < len(pictures):
        pair = tall[k : k + 2] == [True, True]
        for picture in pictures[k : k + 1 + pair]:
            made += _picture(picture, half=pair)
        k += 1 + pair
    return made


def _picture(picture: Picture, *, half: bool) -> str:
    width, height = picture.size
    ending = ""
    if picture.digest:
        ending = (
            f'<p class="small">{_text(picture.outcome)}. '
            f"Digest <code>{_text(picture.digest)}</code></p>\n"
        )
    command = f"<pre><code>{_text(picture.command)}</code></pre>\n" if picture.command else ""
    return PICTURE.substitute(
        kind=' class="half"' if half else "",
        stem=_text(picture.stem),
        width=width,
        height=height,
        alt=_text(picture.alt),
        title=_text(picture.title),
        caption=typeset(picture.caption),
        numbers=_table(picture),
        ending=ending,
        command=command,
    )


def _table(picture: Picture) -> str:
    if not picture.predictions:
        return ""
    rows = "".join(map(_prediction, picture.predictions))
    return TABLE.substitute(title=_text(picture.title), rows=rows)


def _prediction(prediction: Prediction) -> str:
    p = prediction
    cells = [_number(value, p.tolerance) for value in (p.predicted, p.measured)]
    cells += [f"{p.tolerance:.3g} {p.unit}"]
    middle = "".join(f'<td class="number">{typeset(cell)}</td>' for cell in cells)
    kind, word = ("ok", "✓ ok") if p.ok else ("bad", "✗ NOT OK")
    return (
        f'<tr><th scope="row">{typeset(p.name)}</th>{middle}<td class="{kind}">{word}</td></tr>\n'
    )


def _number(value: float, tolerance: float) -> str:
    text = number(value, tolerance)
    return f"{value:.3g}" if len(text) > 10 and math.isfinite(value) else text


def _wrong(text: str) -> str:
    return f'<p class="wrong" role="alert">{_text(text)}</p>\n'


def _numbers(numbers: Sequence[int]) -> str:
    noun, verb = ("figure", "was") if len(numbers) == 1 else ("figures", "were")
    return f"{noun} {', '.join(map(str, numbers))} {verb}"


def _text(text: object) -> str:
    return html.escape(str(text))


# -- formulas

GREEK = "alpha|beta|gamma|eta|theta|mu|pi|rho|phi|psi|omega"
SIGNS = re.compile(rf"(?<![A-Za-z])({GREEK}|sum|int|nabla|le)(?![A-Za-z])")
"""Words for which HTML has an entity of the same name."""

MINUS = re.compile(r"(?<![^\s(={])-(?=[\s\w(&])")
"""A minus; unlike a hyphen, it does not follow a letter."""

DOT = re.compile(r"(?<= )\.(?= )")
"""A product of vectors: a full stop between spaces."""

SHIFTED = re.compile(r"([_^])(?:\{([^{}]*)\}|([^\W_]))")
"""``_i``, ``^2``, ``_{ij}``."""


def typeset(text: str) -> str:
    """Return a formula in plain text as HTML, escaped, with Greek letters, sub- and superscripts.

    >>> typeset("v = -k rho_{ij}^2 < 1")
    'v = &minus;k &rho;<sub>ij</sub><sup>2</sup> &lt; 1'
    """

    def shifted(match: re.Match[str]) -> str:
        tag = "sub" if match[1] == "_" else "sup"
        return f"<{tag}>{match[3] if match[2] is None else match[2]}</{tag}>"

    text = SIGNS.sub(r"&\1;", html.escape(text, quote=False))
    text = DOT.sub("&middot;", MINUS.sub("&minus;", text))
    return SHIFTED.sub(shifted, text)
