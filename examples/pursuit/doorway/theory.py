"""What theory says of a guard in a door, and whether a run agrees."""

import numpy as np

from mars2d import Prediction

DEEP = 0.3  # m, half of the door's depth


def checks(record):
    guard, *others = record.scenario.robots
    x, y = record.pose[:, 0], record.pose[:, 1]
    inside = (np.abs(x[:, 0]) < DEEP) & (np.abs(y[:, 0]) < 0.1)
    touch = np.diff(-x, axis=1) < guard.radius + others[0].radius + 0.02  # in a row (T, n - 1)
    pushing = np.cumprod(touch, axis=1).sum(axis=1)[inside]  # how many, at each of these rows
    name = "the guard is pushed out of the door"
    if record.scenario.physics != "contact" or x[:, 0].min() < -DEEP or pushing.sum() < 5:
        why = "for bodies in contact, a guard in the door, and others in a row before it"
        yield Prediction.silent(name, why)
        return
    share = sum(other.push for other in others[: pushing.max()]) / guard.push
    if abs(share - 1) < 0.03:
        yield Prediction.silent(name, "the forces are equal within 3 %")
        return
    yield Prediction(name, int(share > 1), int(x[:, 0].max() > DEEP), 0)
