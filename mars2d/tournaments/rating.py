"""Ratings: how strong laws are by Elo's model, each with its interval."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from math import log
from typing import TypeVar

import numpy as np

Law = TypeVar("Law", bound=Hashable)

MIDDLE, SPREAD = 1500.0, 350.0
"""The ratings that laws are expected to have before any match: their mean and deviation."""
SCALE = log(10) / 400
"""A law that is 400 better takes ten times as many points as the other one."""
WIDE = 1.959964
"""The half width of a 95 % interval, in deviations."""
STEPS = 100
"""The most steps of Newton's method; a few do."""


def ratings(games: Sequence[tuple[Law, Law, float]]) -> dict[Law, tuple[float, float]]:
    """Return the rating of each law, and half of its 95 % interval.

    games: the law of the first role, that of the second, and the points of the first, from 0 to 1.
    What the first role is better by is estimated, too: so it does not count where laws play both
    roles. Each rating is the most likely one, by a normal prior that keeps those of laws that have
    always won or lost finite.
    Source: A. E. Elo, The Rating of Chessplayers, 1978; the prior is that of M. E. Glickman,
    Journal of the Royal Statistical Society C 48 (1999).

    >>> {law: (round(elo), round(half)) for law, (elo, half) in ratings([("a", "b", 1.0)]).items()}
    {'a': (1603, 613), 'b': (1397, 613)}
    """
    laws = list(dict.fromkeys(law for one, other, _ in games for law in (one, other)))
    place = {law: k for k, law in enumerate(laws)}
    design, points = np.zeros((len(games), len(laws) + 1)), np.array([game[2] for game in games])
    for row, (one, other, _) in zip(design, games, strict=True):
        row[place[one]] += SCALE
        row[place[other]] -= SCALE
    design[:, -1] = SCALE  # of the first role
    found, prior = np.zeros(len(laws) + 1), np.eye(len(laws) + 1) / SPREAD**2
    bend = prior
    for _ in range(STEPS):
        chance = 1 / (1 + np.exp(-(design @ found)))
        bend = prior + (design.T * (chance * (1 - chance))) @ design
        step = np.linalg.solve(bend, design.T @ (points - chance) - prior @ found)
        found = found + step
        if abs(step).max() < 1e-6:
            break
    half = WIDE * np.sqrt(np.diag(np.linalg.inv(bend)))
    return {law: (float(MIDDLE + found[k]), float(half[k])) for law, k in place.items()}
