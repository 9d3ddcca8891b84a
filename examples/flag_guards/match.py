"""Match: each guard takes one attacker, so that as many as can be are matched to who stops them.

Source: Chen, Zhou and Tomlin, IEEE Trans. Automatic Control 62(3), 2017: maximum matching.
"""

from math import dist

import numpy as np
from scipy.optimize import linear_sum_assignment

from mars2d.geometry import dominance

FLAG, REACH, CAPTURE = np.array([[-4.0], [0.0]]), 0.5, 0.5  # m


def control(robot):
    game, where = robot.world.addons.game, robot.world.position.T
    guards, free = game.hunters, game.free or game.caught
    ratio = robot.world.robots[free[0]].drive.max_linear_speed / robot.drive.max_linear_speed
    goal, cost = {}, np.zeros((len(guards), len(free)))
    for i, guard in enumerate(guards):
        for j, attacker in enumerate(free):
            region = dominance(where[attacker], where[guard], min(ratio, 1.0), CAPTURE)
            away = ((region - FLAG) ** 2).sum(axis=0)
            goal[i, j] = region[:, away.argmin()]
            cost[i, j] = dist(where[guard], where[attacker]) - 100 * (away.min() > REACH**2)
    pairs = dict(zip(*map(list, linear_sum_assignment(cost)), strict=True))
    mine = guards.index(robot.index)
    other = pairs.get(mine, int(cost[mine].argmin()))  # with fewer attackers than guards
    return 100 * (goal[mine, other] - robot.position)
