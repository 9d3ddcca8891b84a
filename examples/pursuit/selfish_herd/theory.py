"""What theory says of the selfish herd, and whether a run agrees."""

import numpy as np

from mars2d import Prediction


def caught(record):
    """How many are caught."""
    return len(record.scenario.addons[0].outcome(record).captures)


def checks(record):
    """The first victim, by its domain of danger, and how long it is free."""
    game = record.scenario.addons[0]
    sight = record.pose[:, :2, 1:] - record.pose[:, :2, :1]  # (T, 2, N)
    prey, captures = np.hypot(*sight[0]).argmin() + 1, game.outcome(record).captures
    time, _, victim = captures[0] if captures else (record.time[-1], 0, 0)
    end = np.searchsorted(record.time, time)
    step, way = np.diff(record.pose[: end + 1, :2], axis=0), sight[:end, :, prey - 1]
    runs = [(step[:, :, k] * way).sum(axis=1) for k in (0, prey)]  # along the line between them
    full = np.hypot(*way.T) * record.scenario.sampling_time * 0.98
    top = [record.scenario.robots[k].drive.max_linear_speed for k in (0, prey)]
    if any((run < full * speed).any() for run, speed in zip(runs, top, strict=True)):
        why = "for a predator that runs at the nearest, which runs from it, and nothing in the way"
        yield Prediction.silent("the first victim", why)
        return
    free = (np.hypot(*sight[0, :, prey - 1]) - game.capture) / (top[0] - top[1])
    yield Prediction("the first victim: sheep", prey, victim, 0)
    yield Prediction("it is free for", free, time, record.scenario.sampling_time, "s")
