"""What theory says of lion and man, and whether a run agrees."""

from math import asin

import numpy as np

from mars2d import Prediction


def meal(far, start, reach, speed):
    """When a lion on the radius of a man `far` out is `reach` behind him [s]."""
    return far / speed * (asin(1 - reach / far) - asin(start / far))


def checks(record):
    red, blue = record.scenario.robots
    lion, man = record.pose[:-1, :2].transpose(2, 0, 1)  # up to the meal
    (start, *_), far = np.hypot(*lion.T), np.hypot(*man.T)
    cross = np.abs(lion[1:, 0] * man[1:, 1] - lion[1:, 1] * man[1:, 0])
    equal = red.drive.max_linear_speed == blue.drive.max_linear_speed
    equal &= not red.drive.force_limited
    if np.ptp(far) > 0.02 * far[0] or (cross > 0.1 * far[0]).any() or not equal:
        why = "for equals that start at once, a man on a circle, a lion on his radius"
        yield Prediction.silent("meal", why)
        return
    speed, captures = red.drive.max_linear_speed, record.scenario.addons[0].outcome(record).captures
    time = meal(far[0], start, red.radius + blue.radius, speed)
    if time > record.scenario.stop_time:
        yield Prediction.silent("meal", f"the game is over before {time:.1f} s")
        return
    caught = captures[0].time if captures else np.nan
    yield Prediction("meal", time, caught, 2 * record.scenario.sampling_time, "s")
    along = far[0] * np.sin(asin(start / far[0]) + speed * record.time[:-1] / far[0])
    yield Prediction(
        "lion beside the formula", 0, np.abs(np.hypot(*lion.T) - along).max(), 0.05, "m"
    )
