"""What theory says of hide and seek round a pillar, and whether a run agrees."""

from math import acos, pi

import numpy as np

from mars2d import Prediction
from mars2d.geometry import wrap


def polar(record):
    """How far both are from the pillar's middle, and at which angles (T, 2)."""
    x, y = record.pose[:, :2].swapaxes(0, 1)
    return np.hypot(x, y), np.unwrap(np.arctan2(y, x), axis=0)


def times(record, step=0.0):
    """When the hider is seen by the formula, at most the stop time, and in the run [s].

    step: the time between two commands, s, by which both run on wider circles than they start.
    """
    (far, angle), end = polar(record), record.scenario.stop_time
    speed = np.array([robot.drive.max_linear_speed for robot in record.scenario.robots])
    out, h = far[0] + speed * step / (4 * far[0])
    pillar = np.hypot(*record.scenario.obstacles[0][0])
    falls = speed[0] / out - speed[1] / h  # rad/s
    left = abs(wrap(angle[0, 1] - angle[0, 0])) - acos(pillar / out) - acos(pillar / h)
    return min(end, max(left, 0) / falls) if falls > 0 else end, record.time[-1]


def checks(record):
    far, angle = polar(record)
    speed = np.diff(angle, axis=0) * far[0] / record.scenario.sampling_time  # m/s
    top = [robot.drive.max_linear_speed for robot in record.scenario.robots]
    near = np.abs(wrap(np.diff(angle[:-1], axis=1)[:, 0])) < pi - 0.1  # else the hider may wait
    runs = [speed[:, 0] / top[0], speed[near, 1] / top[1]]
    if np.ptp(far, axis=0).max() > 0.06 or min(abs(each.sum()) / len(each) for each in runs) < 0.95:
        why = "for two that keep to their circles, and run one way as fast as they can"
        yield Prediction.silent("the hider is not seen for", why)
        return
    free, measured = times(record)
    step = record.scenario.sampling_time
    late = abs(free - times(record, step)[0]) + step
    yield Prediction("the hider is not seen for", free, measured, late, "s")
