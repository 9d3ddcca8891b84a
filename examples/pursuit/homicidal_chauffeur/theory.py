"""What theory says of the homicidal chauffeur, and whether a run agrees."""

from math import asin, sqrt

import numpy as np

from mars2d import Prediction


def least(ratio, radius=2.0):
    """The least reach with which the car wins from everywhere [m], for 0 < ratio <= 1."""
    return radius * (sqrt(1 - ratio**2) + ratio * asin(ratio) - 1)


def checks(record):
    car, person = record.scenario.robots
    speed, step = car.drive.max_linear_speed, record.scenario.sampling_time
    ratio, radius = person.drive.max_linear_speed / speed, car.drive.turning_radius(speed)
    apart = np.hypot(*np.diff(record.pose[:, :2], axis=2)[..., 0].T)
    moves = np.hypot(*np.diff(record.pose[:, :2, 1], axis=0).T) > 0
    jumps = np.flatnonzero(moves)  # a matador stands until the car is ratio x radius away
    on_time = len(jumps) and abs(apart[jumps[0]] - ratio * radius) < 3 * speed * step
    passed = np.flatnonzero((np.diff(apart) > 0) & (apart[:-1] < radius))
    if ratio >= 1 or car.drive.force_limited or not on_time:
        why = "for a slower pedestrian that stands until the car is near, and jumps at once"
        yield Prediction.silent("distance at the first pass", why)
        return
    first = apart[: passed[0] + 1].min() if len(passed) else apart[-1]
    clear, touch = least(ratio, radius), car.radius + person.radius
    bound = "at least" if clear > touch else "equal"  # a car that wide hits whoever it comes to
    far = max(clear, touch)
    yield Prediction("distance at the first pass", far, first, speed * step, "m", bound=bound)
