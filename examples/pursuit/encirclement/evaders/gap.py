"""Gap: runs through the middle of the widest gap that it saw at the start, straight on."""

import numpy as np


def control(robot):
    x, y = np.transpose([other.position - robot.position for other in robot.neighbours])
    bearings = np.sort(np.arctan2(y, x))
    gaps = np.diff(np.append(bearings, bearings[0] + 2 * np.pi))
    way = bearings[gaps.argmax()] + gaps.max() / 2
    while True:
        yield 100 * np.cos(way), 100 * np.sin(way)  # m/s: its drive limits this
