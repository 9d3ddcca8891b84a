"""Teams to draw with, and what lies near each other."""

import numpy as np

from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario


def team(*poses, **changes):
    return Scenario(robots=[Robot(pose=pose, diameter=0.6) for pose in poses], **changes)


def near(a, b, slack=0.011):
    return np.allclose(np.array(a, dtype=float), np.array(b, dtype=float), atol=slack)
