"""Home: all guards stay a metre from the flag, each on the way of one that comes."""

from math import dist

import numpy as np

FLAG, CAPTURE = np.array([-4.0, 0.0]), 0.5  # m


def control(robot):
    out = set()
    while True:
        team = {other.name: other.position for other in robot.neighbours}
        blue = {name: team.pop(name) for name in [*team] if name.startswith("blue")}
        guards = [robot.position, *team.values()]
        out |= {b for b in blue if any(dist(blue[b], at) <= CAPTURE for at in guards)}
        free = [at for name, at in blue.items() if name not in out] or [robot.position]
        free.sort(key=lambda at: dist(at, FLAG))
        at = free[sorted([robot.name, *team]).index(robot.name) % len(free)]
        yield 100 * (FLAG + (at - FLAG) / max(dist(at, FLAG), 1) - robot.position)
