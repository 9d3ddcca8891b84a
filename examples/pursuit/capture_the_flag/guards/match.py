"""Match: each guard takes one attacker, so that as many as can be are matched to who stops them.

Source: Chen, Zhou and Tomlin, IEEE Trans. Automatic Control 62(3), 2017: maximum matching.
"""

from math import dist

import numpy as np
from scipy.optimize import linear_sum_assignment

from mars2d.geometry import dominance

FLAG, REACH, CAPTURE = np.array([[-4.0], [0.0]]), 0.5, 0.5  # m


def control(robot):
    out = set()  # attackers that have been caught
    while True:
        where = {other.name: other.position for other in (robot, *robot.neighbours)}
        team = sorted(name for name in where if name.startswith("guard"))
        blue = sorted(name for name in where if name.startswith("blue"))
        out |= {b for b in blue if any(dist(where[b], where[g]) <= CAPTURE for g in team)}
        goal, cost = {}, np.zeros((len(team), len(free := [b for b in blue if b not in out])))
        for i, j in np.ndindex(cost.shape):
            region = dominance(where[free[j]], where[team[i]], 1.0, CAPTURE)
            away = ((region - FLAG) ** 2).sum(axis=0)
            goal[team[i], j] = region[:, away.argmin()]
            ways = [dist(where[name], FLAG[:, 0]) for name in (team[i], free[j])]
            stops = away.min() > REACH**2 and ways[1] > ways[0] - CAPTURE
            cost[i, j] = dist(where[team[i]], where[free[j]]) - 100 * stops
        pairs = {team[i]: j for i, j in zip(*linear_sum_assignment(cost), strict=True)}
        yield 100 * (goal.get((robot.name, pairs.get(robot.name, 0)), FLAG[:, 0]) - robot.position)
