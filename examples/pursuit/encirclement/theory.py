"""What theory says of an encirclement, and whether a run agrees."""

from math import asin, hypot, pi, sin

import numpy as np

from mars2d import Prediction


def miss(apart, off, ratio):
    """How near a pursuer can come to whoever runs straight on, `off` from its bearing [m]."""
    return apart * sin(min(max(off - asin(ratio), 0), pi / 2))


def checks(record):
    (*team, evader), path = record.scenario.robots, record.pose[:, :2, -1:]
    sight = record.pose[:, :2, :-1] - path  # (T, 2, n)
    run = path[-1, :, 0] - path[0, :, 0]
    way = np.hypot(*np.diff(path[..., 0], axis=0).T).sum()
    ratios = [robot.drive.max_linear_speed / evader.drive.max_linear_speed for robot in team]
    if hypot(*run) < 0.999 * way or evader.drive.force_limited or max(ratios) > 1:
        why = "for an evader that is no slower, and runs straight on at once"
        yield Prediction.silent("nearest", why)
        return
    apart, off = np.hypot(*sight[0]), np.arctan2(*sight[0, ::-1]) - np.arctan2(*run[::-1])
    gaps = map(miss, apart, np.abs((off + pi) % (2 * pi) - pi), ratios)
    touch = team[0].radius + evader.radius
    yield Prediction(
        "nearest", max(min(gaps), touch), np.hypot(*sight.swapaxes(0, 1)).min(), 0.01, "m",
        bound="at least",
    )  # fmt: skip
