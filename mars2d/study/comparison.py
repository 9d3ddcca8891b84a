"""Comparisons: by how much runs differ from those with the first value of a setting, in pairs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isnan, nan

import numpy as np

from mars2d.core.errors import InputError, nearest
from mars2d.study.estimates import Estimate, estimates
from mars2d.study.statistics import Interval, confident
from mars2d.study.table import Result, Table
from mars2d.study.text import Point, head, in_words, near, percent, side_by_side, varied

__all__ = ["Difference", "comparison", "differences"]


@dataclass(frozen=True)
class Difference:
    """By how much an estimate of a point differs from that with the first value of a setting.

    found: the difference, its count that of the pairs; or of all runs, where `paired` is False
    since no two have the same seed. left_out: the pairs of which a run failed or has no number.
    narrower: how many times as wide its interval would be, were the same runs no pairs; nan where
    there is no saying.
    """

    point: Point
    estimate: Estimate
    found: Interval
    paired: bool
    left_out: int
    narrower: float


def comparison(table: Table, setting: str, confidence: float = 0.95) -> str:
    """Return by how much each value of a setting differs from its first one, as text.

    All intervals of the text hold together with the confidence that is asked for. Raises
    InputError for a setting that is not there, or that has one value alone.
    """
    place, first = _first(table, setting)
    found = differences(table, setting, confidence)
    settings = [(k, name) for k, name in varied(table) if name != setting] + [(place, setting)]
    parts = [head(table, f"differences from {setting} = {in_words(first)}, seed by seed")]
    for estimate in dict.fromkeys(each.estimate for each in found):
        mine = [each for each in found if each.estimate is estimate]
        points = ([in_words(each.point[k]) for k, _ in settings] for each in mine)
        left = [[name for _, name in settings], *points]
        title = f"{estimate.label} [{'points' if estimate.share else estimate.unit}]"
        columns = [
            [title.removesuffix(" []"), *map(_verdict, mine)],
            ["pairs", *map(_pairs, mine)],
            ["narrower", *map(_gain, mine)],
        ]
        parts += side_by_side(left, columns)
    parts.append(_notes(found, confidence))
    return "\n\n".join(parts)


def differences(table: Table, setting: str, confidence: float = 0.95) -> list[Difference]:
    """Return by how much all points differ from those with the first value of a setting.

    Points that are compared have the same other settings, runs the same seed. Each interval is so
    wide that all of them hold together with the confidence: of m intervals one leaves out an m-th
    of what all may (Bonferroni). Raises InputError as `comparison`.
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
    if not seeds:
        apart = estimate.apart(estimate.values(results), estimate.values(base), confidence)
        return Difference(point, estimate, apart, paired=False, left_out=0, narrower=nan)
    mine, theirs = (estimate.by_seed(runs) for runs in (results, base))
    a = np.array([mine.get(seed, nan) for seed in seeds])
    b = np.array([theirs.get(seed, nan) for seed in seeds])
    found = estimate.difference(a, b, confidence)
    both = np.isfinite(a) & np.isfinite(b)
    alone = estimate.apart(a[both], b[both], confidence)
    known = found.half_width > 0 and not estimate.share  # shares have other methods in no pairs
    narrower = alone.half_width / found.half_width if known else nan
    left_out = len({r.seed for r in (*results, *base)}) - found.count
    return Difference(point, estimate, found, True, left_out, narrower)


# -- in words --------------------------------------------------------------------------------------


def _verdict(each: Difference) -> str:
    """Return ``lower by 3.1 [2.2, 4.0]``, or that no difference was seen."""
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


def _pairs(each: Difference) -> str:
    if not each.paired:
        return f"0 ({each.found.count} runs)"
    return f"{each.found.count}{f' ({each.left_out} left out)' if each.left_out else ''}"


def _gain(each: Difference) -> str:
    return "-" if isnan(each.narrower) else f"{each.narrower:.1f} times"


def _notes(found: Sequence[Difference], confidence: float) -> str:
    m = len(found)
    percent_all = f"{100 * confidence:.4g} %"
    notes = [f"Intervals are of {percent_all}."]
    if m > 1:
        one = f"{100 * (1 - (1 - confidence) / m):.4g} %"
        notes = [f"Each of the {m} intervals is of {one}: all hold together with {percent_all}"]
        notes[0] += " (Bonferroni)."
    if any(each.paired for each in found):
        notes.append("narrower: how much pairing narrowed the interval, against runs in no pairs.")
    if any(each.left_out for each in found):
        notes.append("left out: pairs of which a run failed or has no number, so that a difference")
        notes.append("is of the others alone: read it beside the share of those with a number.")
    if not all(each.paired for each in found):
        notes.append("Runs without a seed in common are compared as they are (Welch, Newcombe).")
    return "\n".join(notes)
