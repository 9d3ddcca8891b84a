"""The hunter: it drives at what it sees nearest, tells the others, and turns away from bumps."""

import numpy as np


def control(robot):
    while True:
        robot.send({"from": "hunter", "x": float(robot.pose[0])})
        if robot.sense.bumper.any():
            yield -0.2, robot.rng.uniform(1, 2)
        near = robot.sense.range_finder
        seen = np.nan_to_num(near, posinf=2.0)
        yield 0.3 + 0.05 * len(robot.inbox), float(np.argmin(seen)) - 2 + robot.rng.normal()
