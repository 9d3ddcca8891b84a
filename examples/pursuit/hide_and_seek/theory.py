"""What theory says of hide and seek round a pillar, and whether a run agrees."""

from math import acos, pi

import numpy as np

from mars2d import Prediction
from mars2d.geometry import wrap


def polar(record):
    """How far both are from the pillar's middle, and at which angles (T, 2)."""
    x, y = record.pose[:, :2].swapaxes(0, 1)
    return np.hypot(x, y), np.unwrap(np.arctan2(y, x), axis=0)


def times(record):
    """When the hider is seen by the formula, at most the stop time, and in the run [s]."""
    (red, blue), (far, angle) = record.scenario.robots, polar(record)
    (out, h), end = far[0], record.scenario.stop_time
    pillar = np.hypot(*record.scenario.obstacles[0][0])
    falls = red.drive.max_linear_speed / out - blue.drive.max_linear_speed / h  # rad/s
    left = abs(wrap(angle[0, 1] - angle[0, 0])) - acos(pillar / out) - acos(pillar / h)
    return min(end, max(left, 0) / falls) if falls > 0 else end, record.time[-1]


def miss(record):
    return -np.subtract(*times(record))


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
    late = 0.015 * free + record.scenario.sampling_time  # laws steer once a step
    yield Prediction("the hider is not seen for", free, measured, late, "s")
