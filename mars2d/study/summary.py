"""Summaries: what a study came to, as text for a terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from math import ceil, floor, inf, isnan, log10

from mars2d.core.errors import counted
from mars2d.study.comparison import comparison
from mars2d.study.estimates import Estimate, Float, estimates
from mars2d.study.statistics import seeds_for_share, seeds_needed
from mars2d.study.table import Result, Table
from mars2d.study.text import head, in_words, name_of_point, near, percent, side_by_side, varied

__all__ = ["comparison", "summary"]

PRECISION = 0.05
"""How narrow an interval should be: half of it, as a share of the mean, or of all runs."""

FEW = 10
"""From fewer runs than these a deviation is a guess."""


def summary(table: Table, confidence: float = 0.95) -> str:
    """Return one line a point: its settings, its runs, each measure's mean and interval, shares.

    Below stands how many seeds would be enough, and what went wrong. Raises InputError for a
    confidence that is not between 0 and 1.
    """
    points, wanted = table.points(), estimates(table)
    left = [[*(name for _, name in varied(table)), "runs"]]
    for point, results in points.items():
        left.append([*(in_words(point[k]) for k, _ in varied(table)), str(len(results))])
    if table.failed:
        failures = (str(sum(bool(r.error) for r in results)) for results in points.values())
        for row, cell in zip(left, ["failed", *failures], strict=True):
            row.append(cell)
    columns = [
        [_heading(each), *(_cell(each, results, confidence) for results in points.values())]
        for each in wanted
    ]
    parts = [
        head(table, f"means and shares with their {100 * confidence:.4g} % intervals"),
        *side_by_side(left, columns),
        _notes(table, wanted),
        _enough(table, wanted, confidence),
    ]
    return "\n\n".join(filter(None, parts))


def _heading(estimate: Estimate) -> str:
    return f"{estimate.label} [{estimate.unit}]" if estimate.unit else estimate.label


def _cell(estimate: Estimate, results: Sequence[Result], confidence: float) -> str:
    """Return an estimate of a point: ``12.3 ± 1.1``, ``76 % [63, 86]``; of some: (38 of 50)."""
    values = estimate.values(results)
    found = estimate.interval(values, confidence)
    of = f" ({found.count} of {len(values)})" if estimate.some else ""
    if not found.count:
        return "-"
    if estimate.share:
        mean, low, high = (percent(v, found.count) for v in (found.mean, found.low, found.high))
        return f"{mean} % [{low}, {high}]{of}"
    if isnan(found.low):
        return f"{found.mean:.4g}{of}"
    half = found.half_width
    return f"{near(found.mean, half)} ± {near(half, half)}{of}"


def _notes(table: Table, wanted: Sequence[Estimate]) -> str:
    """Return what one has to know of the numbers above."""
    sound = [result for result in table.results if not result.error]
    infinite = Counter(
        name for r in sound for name in table.measures if r.measures.get(name) in (inf, -inf)
    )
    notes = [
        f"{each.label} is of those runs alone that have a number: k of n. Read it beside the share."
        for each in wanted
        if each.some
    ]
    notes += [
        f"{name} is infinite in {counted(count, 'run')}, which its mean leaves out."
        for name, count in infinite.items()
    ]
    if table.failed:
        first = table.failed[0]
        failed = f"{counted(len(table.failed), 'run')} failed and count nowhere"
        notes.append(f"{failed}, as row {first.row}: {first.error}")
    return "\n".join(notes)


# -- how many seeds --------------------------------------------------------------------------------


def _enough(table: Table, wanted: Sequence[Estimate], confidence: float) -> str:
    """Return how many seeds would be enough for each mean, and for the shares of each measure."""
    groups: dict[str, list[Estimate]] = {}
    for each in wanted:
        groups.setdefault(f"shares of {each.measure}" if each.share else each.label, []).append(
            each
        )
    lines = [
        (group[0].label if len(group) == 1 else label, text)
        for label, group in groups.items()
        if (text := _seeds(table, group, confidence))
    ]
    unsaid = sum(
        not _needed(each, each.values(results), confidence)
        for each in wanted
        for results in table.points().values()
    )
    left_out = f"No forecast for {counted(unsaid, 'mean')}: too few numbers, or too far apart."
    if not lines:
        return ""
    room = max(len(label) for label, _ in lines)
    title = f"Enough for ±{100 * PRECISION:g} % of a mean"
    if any(each.share for each in wanted):
        title += f", ±{100 * PRECISION:g} points of a share"
    told = [f"  {label.ljust(room)}  {text}" for label, text in lines]
    return "\n".join([f"{title}:", *told, *([left_out] if unsaid else [])])


def _seeds(table: Table, group: Sequence[Estimate], confidence: float) -> str:
    """Return how many seeds the point needs that needs most; nothing where there is no saying."""
    needed = [
        (_needed(estimate, values, confidence), len(values), point)
        for point, results in table.points().items()
        for estimate in group
        for values in [estimate.values(results)]
    ]
    most, have, point = max(needed, key=lambda each: each[0], default=(0.0, 0, ()))
    if not most:
        return ""
    guess = f", a guess from {have}" if have < FEW else ""
    if most <= have:
        return f"these {have} seeds{guess}"
    where = name_of_point(table, point)
    where = f"; {where} needs most" if where else ""
    return f"about {_rounded_up(most)} seeds{guess}{where}"


def _needed(estimate: Estimate, values: Float, confidence: float) -> float:
    """Return how many seeds a point needs; 0 where there is no saying."""
    found = estimate.interval(values, confidence)
    if not found.count or isnan(found.low):
        return 0.0
    if estimate.share:
        needed = seeds_for_share(found.mean, PRECISION, confidence)
    elif found.mean == 0 or found.low <= 0 <= found.high:  # a share of what may be 0
        return 0.0
    else:
        needed = seeds_needed(values, PRECISION * abs(found.mean), confidence) or 0
    return needed * len(values) / found.count  # others have no number


def _rounded_up(seeds: float) -> str:
    """Return a number of seeds with two digits: a forecast has no more."""
    unit = 10 ** max(floor(log10(seeds)) - 1, 0)
    return f"{ceil(seeds / unit) * unit:,}".replace(",", " ")
