"""Wings: the attackers spread out, and come at the flag from different sides at once."""

import numpy as np

FLAG = np.array([-4.0, 0.0])


def control(robot):
    team = [other.name for other in robot.neighbours if other.name.startswith("blue")]
    team = sorted([robot.name, *team])
    y = np.linspace(-3.5, 3.5, len(team))[team.index(robot.name)]
    while robot.position[0] > FLAG[0] + 0.2:
        yield 100 * ((FLAG[0], y) - robot.position)
    while True:
        yield 100 * (FLAG - robot.position)
