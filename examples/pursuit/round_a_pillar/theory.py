"""What theory says of a chase round a pillar, and whether a run agrees."""

from math import acos, pi

import numpy as np

from mars2d import Prediction
from mars2d.geometry import wrap


def polar(record):
    """How far both are from the pillar's middle, and at which angles (T, 2)."""
    x, y = record.pose[:, :2].swapaxes(0, 1)
    return np.hypot(x, y), np.unwrap(np.arctan2(y, x), axis=0)


def times(record, step=0.0):
    """When the evader is caught by the formula, at most the stop time, and in the run [s].

    step: the time between two commands, s, by which it runs on a wider circle than it starts.
    """
    (red, blue), (far, angle) = record.scenario.robots, polar(record)
    (out, h), reach, end = far[0], record.scenario.addons[1].capture, record.scenario.stop_time
    h += blue.drive.max_linear_speed * step / (4 * h)
    last = acos(np.clip((out**2 + h**2 - reach**2) / (2 * out * h), -1, 1))
    falls = red.drive.max_linear_speed / out - blue.drive.max_linear_speed / h  # rad/s
    left = abs(wrap(angle[0, 1] - angle[0, 0])) - last
    return min(end, max(left, 0) / falls) if falls > 0 else end, record.time[-1]


def checks(record):
    far, angle = polar(record)
    speed = np.diff(angle, axis=0) * far[0] / record.scenario.sampling_time  # m/s
    top = [robot.drive.max_linear_speed for robot in record.scenario.robots]
    near = np.abs(wrap(np.diff(angle[:-1], axis=1)[:, 0])) < pi - 0.1  # else the evader may wait
    runs = [speed[:, 0] / top[0], speed[near, 1] / top[1]]
    if np.ptp(far, axis=0).max() > 0.06 or min(abs(each.sum()) / len(each) for each in runs) < 0.95:
        why = "for two that keep to their circles, and run one way as fast as they can"
        yield Prediction.silent("the evader is free for", why)
        return
    free, measured = times(record)
    step = record.scenario.sampling_time
    late = free - times(record, step)[0] + step
    yield Prediction("the evader is free for", free, measured, late, "s")
