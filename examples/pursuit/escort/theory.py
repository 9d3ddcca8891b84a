"""What theory says of an escort, and whether a run agrees."""

import numpy as np

from mars2d import Prediction


def ratio(record):
    """The share of the hunter's speed from which on a guard is always between."""
    hunter, guard, _ = record.scenario.robots
    near = np.hypot(*(record.pose[0, :2, 1] - record.pose[0, :2, 2]))
    return near / (near + guard.radius + hunter.radius)


def survives(record):
    """Whether the prey is free in the end."""
    return int(not record.scenario.addons[0].outcome(record).captures)


def checks(record):
    hunter, guard, _ = record.scenario.robots
    quick, least = guard.drive.max_linear_speed / hunter.drive.max_linear_speed, ratio(record)
    near = np.hypot(*(record.pose[:, :2, 1] - record.pose[:, :2, 2]).T)
    if np.ptp(near[:-1]) > 0.1:
        why = "for a guard that keeps its distance from the prey"
    elif quick < least:
        why = "a guard that is so slow can be passed; whether it is, the hunter decides"
    elif quick < 1.08 * least:
        why = "so near the limit it counts that the guard sees the hunter a step late"
    else:
        yield Prediction("the prey is free in the end", 1, survives(record), 0)
        return
    yield Prediction.silent("the prey is free in the end", why)
