"""What theory says of an evader in a corner, and whether a run agrees."""

import numpy as np

from mars2d import Prediction

SETTLED = 1.0  # s, until the hunters are where they push from


def holds(record, row):
    """What the hunters hold along the two walls at a row, in forces of one (2,)."""
    away = record.pose[row, :2, :-1] - record.pose[row, :2, -1:]
    return (away / np.hypot(*away)).sum(axis=1)


def gets_out(record):
    return record.scenario.addons[0].outcome(record).winner == "evader"


def checks(record):
    *hunters, evader = record.scenario.robots
    row = int(SETTLED / record.scenario.sampling_time)
    apart = np.hypot(*(record.pose[row, :2, :-1] - record.pose[row, :2, -1:]))
    touch = apart.max() < evader.radius + max(hunter.radius for hunter in hunters) + 0.02
    way = record.command[:-1, :, -1] / np.hypot(*record.command[:-1, :, -1].T)[:, None]
    if record.scenario.physics != "contact" or not touch or np.ptp(way, axis=0).max() > 0.01:
        why = "for bodies in contact, and an evader that pushes one way"
        yield Prediction.silent("the evader gets out", why)
        return
    share = (evader.push / hunters[0].push * way[0] / holds(record, row)).max()
    if abs(share - 1) < 0.03:
        yield Prediction.silent("the evader gets out", "the forces are equal within 3 %")
        return
    yield Prediction("the evader gets out", int(share > 1), int(gets_out(record)), 0)
