"""Wings: the attackers spread out, and come at the flag from different sides at once."""

from math import dist

import numpy as np

FLAG = np.array([-4.0, 0.0])


def control(robot):
    attackers = robot.world.scenario.addons[0].players(robot.world.scenario)[1]
    y = np.linspace(-3.5, 3.5, len(attackers))[attackers.index(robot.index)]
    while robot.position[0] > FLAG[0] + 0.2:
        yield 100 * ((-4.0, y) - robot.position)
        if dist(robot.position, FLAG) < 1:
            break
    while True:
        yield 100 * (FLAG - robot.position)
