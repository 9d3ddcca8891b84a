"""Decoys: those nearest to guards lead them away, and the others run to the flag."""

from math import dist

import numpy as np

FLAG = np.array([-4.0, 0.0])


def control(robot):
    team = {other.name: other.position for other in (robot, *robot.neighbours)}
    guards = [at for name, at in team.items() if name.startswith("guard")]
    blue = {name: at for name, at in team.items() if name.startswith("blue")}
    near = {name: min(dist(at, guard) for guard in guards) for name, at in blue.items()}
    decoys = sorted(near, key=near.get)[: len(guards)]
    if robot.name in decoys and len(blue) > len(guards):
        hunter = min(guards, key=lambda at: dist(at, robot.position))
        return 100 * (robot.position - hunter)
    return 100 * (FLAG - robot.position)  # m/s: its drive limits this
