"""The results of a study as text for a terminal: its means, and how settings compare."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, inf, isnan, log10, nan

import numpy as np

from mars2d.core.errors import InputError, counted, nearest
from mars2d.study.estimates import Estimate, Float, estimates
from mars2d.study.statistics import Interval, confident, seeds_for_share, seeds_needed
from mars2d.study.table import Result, Table
from mars2d.study.text import (
    Point,
    assigned,
    head,
    in_words,
    near,
    percent,
    side_by_side,
    varied,
)
from mars2d.study.units import with_unit

PRECISION = 0.05
"""The half width that an interval should have, as a share of the mean, or of all runs."""

MIN_RUNS = 10
"""With fewer runs, a standard deviation is a guess."""


def summary(table: Table, confidence: float = 0.95) -> str:
    """Return a line for each point: its settings, runs, means with intervals, and shares.

    Below follow how many seeds would be enough, and errors. Raises InputError for a confidence that
    is not between 0 and 1.
    """
    points, wanted, settings = table.points(), estimates(table), varied(table)
    failed = ["failed"] if table.failed else []
    left = [[*(with_unit(name, table.unit(name)) for _, name in settings), "runs", *failed]]
    for point, results in points.items():
        failures = [str(sum(bool(result.error) for result in results))] if failed else []
        left.append([*(in_words(point[k]) for k, _ in settings), str(len(results)), *failures])
    columns = [
        [with_unit(each.label, each.unit), *(_cell(each, r, confidence) for r in points.values())]
        for each in wanted
    ]
    parts = [
        head(table, f"means and shares with their {100 * confidence:.4g} % intervals"),
        *side_by_side(left, columns),
        _notes(table, wanted),
        _enough(table, wanted, confidence),
    ]
    return "\n\n".join(filter(None, parts))


def _cell(estimate: Estimate, results: Sequence[Result], confidence: float) -> str:
    """Return an estimate as text: ``12.3 ± 1.1``, ``76 % [63, 86]``; of some runs: (38 of 50)."""
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
    """Return notes that help to read the numbers above."""
    sound = [result for result in table.results if not result.error]
    infinite = Counter(
        name for r in sound for name in table.measures if r.measures.get(name) in (inf, -inf)
    )
    alone = "is of those runs alone that have a number: k of n. Read it beside the share."
    notes = [f"{each.label} {alone}" for each in wanted if each.some]
    for name, count in infinite.items():
        notes.append(f"{name} is infinite in {counted(count, 'run')}, which its mean leaves out.")
    if table.failed:
        first = table.failed[0]
        failed = f"{counted(len(table.failed), 'run')} failed and count nowhere"
        notes.append(f"{failed}, as row {first.row}: {first.error}")
    return "\n".join(notes)


# -- how many seeds --------------------------------------------------------------------------------


def _enough(table: Table, wanted: Sequence[Estimate], confidence: float) -> str:
    """Say how many seeds would be enough for each mean and share."""
    lines, unsaid = [], 0
    for each in wanted:
        needed = [
            (_needed(each, values, confidence), len(values), point)
            for point, results in table.points().items()
            for values in [each.values(results)]
        ]
        unsaid += sum(not seeds for seeds, *_ in needed)
        most = max(needed, key=lambda each: each[0], default=(0.0, 0, ()))
        if most[0]:
            lines.append((each.label, _seeds(table, *most)))
    if not lines:
        return ""
    room = max(len(label) for label, _ in lines)
    title = f"Enough for ±{100 * PRECISION:g} % of a mean"
    if any(each.share for each in wanted):
        title += f", ±{100 * PRECISION:g} points of a share"
    told = [f"{title}:", *(f"  {label.ljust(room)}  {text}" for label, text in lines)]
    if unsaid:
        why = "too few numbers, or too far apart"
        told.append(f"No forecast for {counted(unsaid, 'mean')}: {why}.")
    return "\n".join(told)


def _seeds(table: Table, most: float, have: int, point: Point) -> str:
    """Say how many seeds the most demanding point needs, of which there are `have`."""
    guess = f", a guess from {have}" if have < MIN_RUNS else ""
    if most <= have:
        return f"these {have} seeds{guess}"
    named = [assigned(name, point[k], table.unit(name)) for k, name in varied(table)]
    where = f"; {', '.join(named)} needs most" if named else ""
    unit = 10 ** max(floor(log10(most)) - 1, 0)
    rounded = f"{ceil(most / unit) * unit:,}".replace(",", " ")  # up, to two digits
    return f"about {rounded} seeds{guess}{where}"


def _needed(estimate: Estimate, values: Float, confidence: float) -> float:
    """Return how many seeds a point needs; 0 if that is unknown."""
    found = estimate.interval(values, confidence)
    if not found.count or isnan(found.low):
        return 0.0
    if estimate.share:
        needed = seeds_for_share(found.mean, PRECISION, confidence)
    elif found.mean == 0 or found.low <= 0 <= found.high:  # the mean may be 0
        return 0.0
    else:
        needed = seeds_needed(values, PRECISION * abs(found.mean), confidence) or 0
    return needed * len(values) / found.count  # since some runs have no number


# -- comparisons -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Difference:
    """The difference of an estimate at a point from that at the first value of a setting.

    found: the difference; its count is the number of pairs. left_out: runs without a partner of the
    same seed, or of which one failed or has no number.
    """

    point: Point
    estimate: Estimate
    found: Interval
    left_out: int


def comparison(table: Table, setting: str, confidence: float = 0.95) -> str:
    """Return the differences of each value of a setting from its first value, as text.

    All intervals hold simultaneously with the given confidence. Raises InputError for an unknown
    setting, and for one with a single value.
    """
    place, first = _first(table, setting)
    found = differences(table, setting, confidence)
    settings = [(k, name) for k, name in varied(table) if name != setting] + [(place, setting)]
    base = assigned(setting, first, table.unit(setting))
    parts = [head(table, f"differences from {base}, seed by seed")]
    for estimate in dict.fromkeys(each.estimate for each in found):
        mine = [each for each in found if each.estimate is estimate]
        points = ([in_words(each.point[k]) for k, _ in settings] for each in mine)
        left = [[with_unit(name, table.unit(name)) for _, name in settings], *points]
        title = with_unit(estimate.label, "points" if estimate.share else estimate.unit)
        counts = (
            f"{each.found.count}{f' ({each.left_out} left out)' if each.left_out else ''}"
            for each in mine
        )
        columns = [[title, *map(_verdict, mine)], ["pairs", *counts]]
        parts += side_by_side(left, columns)
    parts.append(_comparison_notes(found, confidence))
    return "\n\n".join(parts)


def differences(table: Table, setting: str, confidence: float = 0.95) -> list[Difference]:
    """Return the differences of all points from those with the first value of a setting.

    Compared points have the same other settings, and compared runs the same seed. The m intervals
    hold simultaneously with the given confidence: each may fail with an m-th of the probability
    with which any may (Bonferroni). Raises InputError as `comparison` does.
    """
    confidence = confident(confidence)
    place, first = _first(table, setting)
    points = table.points()
    pairs = [
        (point, results, points[base])
        for point, results in points.items()
        if point[place] != first
        and (base := (*point[:place], first, *point[place + 1 :])) in points
    ]
    wanted = estimates(table, both=False)
    each = 1 - (1 - confidence) / max(1, len(pairs) * len(wanted))
    return [
        _difference(point, estimate, results, base, each)
        for estimate in wanted
        for point, results, base in pairs
    ]


def _first(table: Table, setting: str) -> tuple[int, object]:
    """Return the place of a setting in points, and its first value."""
    if setting not in table.settings:
        known = nearest(setting, table.settings) or "; it has none"
        raise InputError(f"compare: the study has no setting {setting!r}{known}")
    place = table.settings.index(setting)
    values = list(dict.fromkeys(point[place] for point in table.points()))
    if len(values) < 2:
        raise InputError(f"compare: {setting} has one value in this study, {values}: expected two")
    return place, values[0]


def _difference(
    point: Point,
    estimate: Estimate,
    results: Sequence[Result],
    base: Sequence[Result],
    confidence: float,
) -> Difference:
    seeds = sorted({r.seed for r in results} & {r.seed for r in base})
    mine, theirs = (estimate.by_seed(runs) for runs in (results, base))
    a = np.array([mine.get(seed, nan) for seed in seeds])
    b = np.array([theirs.get(seed, nan) for seed in seeds])
    found = estimate.difference(a, b, confidence)
    left_out = len({r.seed for r in (*results, *base)}) - found.count
    return Difference(point, estimate, found, left_out)


def _verdict(each: Difference) -> str:
    """Return a difference as text: ``lower by 3.1 [2.2, 4.0]``, or that none was seen."""
    found, share = each.found, each.estimate.share
    if isnan(found.low):
        return "too few to say"
    if found.low == found.high == 0:
        return "the same"

    def text(value: float) -> str:
        return percent(value, found.count) if share else near(value, found.half_width)

    if found.low <= 0 <= found.high:
        return f"no difference seen [{text(found.low)}, {text(found.high)}]"
    if found.mean < 0:
        return f"lower by {text(-found.mean)} [{text(-found.high)}, {text(-found.low)}]"
    return f"higher by {text(found.mean)} [{text(found.low)}, {text(found.high)}]"


def _comparison_notes(found: Sequence[Difference], confidence: float) -> str:
    m, every = len(found), f"{100 * confidence:.4g} %"
    notes = [f"Intervals are of {every}."]
    if m > 1:
        one = f"{100 * (1 - (1 - confidence) / m):.4g} %"
        together = f"all hold together with {every} (Bonferroni)"
        notes = [f"Each of the {m} intervals is of {one}: {together}."]
    if any(each.left_out for each in found):
        notes.append("left out: pairs of which a run failed or has no number, so that a difference")
        notes.append("is of the others alone: read it beside the share of those with a number.")
    return "\n".join(notes)
