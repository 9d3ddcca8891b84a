"""What theory says of guarding a line, and whether a run agrees."""

import numpy as np

from mars2d import Prediction
from mars2d.geometry import dominance


def region(guard, attacker, mu, capture, wall=np.inf):
    """The edge of what the attacker reaches before the guard, between walls at x = +-wall."""
    ways = dominance(attacker, guard, mu, capture) - attacker[:, None]
    room = wall - np.sign(ways[0]) * attacker[0]
    return attacker[:, None] + ways * (room / np.maximum(np.abs(ways[0]), 1e-9)).clip(0, 1)


def lowest(record, row=0):
    """The lowest point that the attacker reaches before the guard, from where both are at a row."""
    (guard, attacker), game = record.scenario.robots, record.scenario.addons[0]
    mu = min(attacker.drive.max_linear_speed / guard.drive.max_linear_speed, 1)
    wall = record.scenario.workspace[1][0] - attacker.radius
    edge = region(*record.pose[row, :2].T, mu, game.capture, wall)
    return edge[:, edge[1].argmin()]


def heights(record):
    """How high above the line the attacker ends by the formula, and in the run [m]."""
    line = record.scenario.addons[0].goal[2][1]
    return max(0, lowest(record)[1] - line), max(0, record.pose[-1, 1, 1] - line)


def checks(record):
    fast, slow = (robot.drive.max_linear_speed for robot in record.scenario.robots)
    line, plays = record.scenario.addons[0].goal[2][1], [slow <= fast] * 2  # who keeps the law
    for row in range(2, len(record) - 2) if slow <= fast else ():
        place, goal = record.pose[row, :2], lowest(record, row)
        step = record.pose[row + 1, :2] - place
        if np.hypot(*(goal - place[:, 1])) < 0.3 or goal[1] < line:
            continue  # at the end of its way, or sure to be at the line
        for i, to in enumerate((goal[:, None] - place).T):
            far = np.hypot(*to) * np.hypot(*step[:, i])
            plays[i] &= to @ step[:, i] > 0.98 * far
    if not any(plays):
        why = "for a guard that is no slower, and for who keeps to the lowest point"
        yield Prediction.silent("end: height above the line", why)
        return
    bound = "equal" if all(plays) else "at least" if plays[0] else "at most"
    late = 2 * fast * record.scenario.sampling_time  # a step of both
    yield Prediction("end: height above the line", *heights(record), late, "m", bound=bound)
