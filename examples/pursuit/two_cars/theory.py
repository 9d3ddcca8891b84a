"""What theory says of two cars, and whether a run agrees."""

import numpy as np

from mars2d import Prediction


def circles(pose, drive, times, side):
    """Where a car is after times of its tightest turn to a side, in complex numbers."""
    (x, y, theta), radius = pose, drive.turning_radius(drive.max_linear_speed)
    turn = np.exp(1j * side * drive.max_angular_speed * times)
    return x + 1j * y + side * radius * 1j * np.exp(1j * theta) * (1 - turn)


def checks(record):
    red, blue = record.scenario.robots
    drives, touch = (red.drive, blue.drive), red.radius + blue.radius
    if any(drive.force_limited for drive in drives):
        yield Prediction.silent("the way past", "for tyres that hold any force")
        return
    speed = [drive.max_linear_speed for drive in drives]
    bend = [drive.max_linear_speed * drive.max_angular_speed for drive in drives]  # m/s^2
    if speed[0] > speed[1] and bend[0] >= bend[1]:
        captures = record.scenario.addons[0].outcome(record).captures
        yield Prediction("captures, by the best law", 1, len(captures), 0)
    turn = record.command[:, 1] / [drive.max_angular_speed for drive in drives]
    hard = np.flatnonzero((np.abs(turn) > 0.99).all(axis=1) & (turn.prod(axis=1) > 0))
    apart = np.hypot(*np.diff(record.pose[:, :2], axis=2)[..., 0].T)
    near = hard[apart[hard] < 1]
    if not len(near):
        yield Prediction.silent("the way past", "they never turn hard to the same side, close by")
        return
    k = near[0]
    end = k + np.argmin(np.append(np.isin(np.arange(k, hard[-1] + 1), hard), False))
    past = k + apart[k : end + 1].argmin()
    side, times = np.sign(turn[k, 1]), np.linspace(0, record.time[past] - record.time[k], 600)
    p, e = (circles(record.pose[k, :, i], drives[i], times, side) for i in (0, 1))
    yield Prediction("the way past", max(np.abs(p - e).min(), touch), apart[past], 0.01, "m")
