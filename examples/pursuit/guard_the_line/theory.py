"""What theory says of guarding a line, and whether a run agrees."""

import numpy as np

from mars2d import Prediction
from mars2d.geometry import dominance


def region(guard, attacker, mu, capture, wall=np.inf):
    """The edge of what the attacker reaches before the guard, between walls at x = +-wall."""
    ways = dominance(attacker, guard, mu, capture) - attacker[:, None]
    room = wall - np.sign(ways[0]) * attacker[0]
    return attacker[:, None] + ways * (room / np.maximum(np.abs(ways[0]), 1e-9)).clip(0, 1)


def heights(record):
    """How high above the line the attacker ends by the formula, and in the run [m]."""
    (guard, attacker), game = record.scenario.robots, record.scenario.addons[0]
    mu, line = attacker.drive.max_linear_speed / guard.drive.max_linear_speed, game.goal[2][1]
    wall = record.scenario.workspace[1][0] - attacker.radius
    edge = region(*record.pose[0, :2].T, min(mu, 1), game.capture, wall)
    return max(0, edge[1].min() - line), max(0, record.pose[-1, 1, 1] - line)


def miss(record):
    return -np.subtract(*heights(record))


def checks(record):
    (guard, attacker), game = record.scenario.robots, record.scenario.addons[0]
    mu = attacker.drive.max_linear_speed / guard.drive.max_linear_speed
    wall, line = record.scenario.workspace[1][0] - attacker.radius, game.goal[2][1]
    steps, plays = np.diff(record.pose[:, :2], axis=0), [True, True]  # who keeps the law
    for place, step in zip(record.pose[2:-2, :2], steps[2:-1], strict=True):
        edge = region(*place.T, min(mu, 1), game.capture, wall)
        goal = edge[:, edge[1].argmin()]
        if np.hypot(*(goal - place[:, 1])) < 0.3 or goal[1] < line:
            continue  # at the end of its way, or sure to be at the line
        for i, to in enumerate((goal[:, None] - place).T):
            far = np.hypot(*to) * np.hypot(*step[:, i])
            plays[i] &= to @ step[:, i] > 0.98 * far
    if mu > 1 or not any(plays):
        why = "for a guard that is no slower, and for who keeps to the lowest point"
        yield Prediction.silent("end: height above the line", why)
        return
    bound = "equal" if all(plays) else "at least" if plays[0] else "at most"
    late = 2 * guard.drive.max_linear_speed * record.scenario.sampling_time  # a step of both
    yield Prediction("end: height above the line", *heights(record), late, "m", bound=bound)
