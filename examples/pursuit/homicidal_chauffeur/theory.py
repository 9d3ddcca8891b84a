"""What theory says of the homicidal chauffeur, and whether a run agrees."""

from math import asin, sqrt

import numpy as np

from mars2d import Prediction


def least(ratio, radius=2.0):
    """The least reach with which the car wins from everywhere [m], for 0 < ratio <= 1."""
    return radius * (sqrt(1 - ratio**2) + ratio * asin(ratio) - 1)


def best(path, ratio, radius, step):
    """Where both are at their best (2, 2) [m], once the pedestrian is ratio x radius ahead.

    path: poses (k, 3, 2), the last one now. step: how far the car goes from one to the next [m].
    Then the pedestrian runs square to the car's heading, and the car turns after it, up to the
    nearest pass. Empty before, and if the pedestrian was not straight ahead: there is no formula.
    """
    sight = (path[:, :2, 1] - path[:, :2, 0]) @ (1, 1j) * np.exp(-1j * path[:, 2, 0])
    near = np.flatnonzero(np.abs(sight) <= ratio * radius)
    if not len(near) or abs(sight[near[0]].imag) > 0.05 * radius:
        return np.empty((0, 2))
    start, angle = near[0], min((len(path) - 1 - near[0]) * step / radius, asin(ratio))
    (x, y), heading = path[start, :2, 0], np.exp(1j * path[start, 2, 0])
    side = 1 if ((path[-1, :2, 1] - path[start, :2, 1]) @ (1, 1j) / heading).imag >= 0 else -1
    car = radius * (np.sin(angle) + 1j * side * (1 - np.cos(angle)))
    ways = heading * np.array([car, sight[start] + 1j * side * ratio * radius * angle])
    return np.transpose([x + ways.real, y + ways.imag])


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
