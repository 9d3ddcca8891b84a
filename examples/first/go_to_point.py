"""A holonomic robot and a unicycle go to the same point, side by side.

Setting: centralised, full information. With g the goal, d the distance to it and a the angle from
the heading to it, the holonomic robot heads straight for it, u = k (g - p); the unicycle must turn
first, v = min(k d, v_max) cos(a), omega = k_a a. Both take k = 0.5 and start at rest.
"""

from math import atan2, cos

import numpy as np

from mars2d import Animation, Holonomic, Robot, Scenario, Unicycle
from mars2d.geometry import wrap

GOALS = np.array([(4.0, 2.0), (4.0, -2.0)]).T
GAIN, TURN_GAIN, MAX_SPEED = 0.5, 2.0, 0.3

scenario = Scenario(
    title="Go to a point: holonomic and unicycle",
    robots=[
        Robot(name="holonomic", drive=Holonomic(max_linear_speed=MAX_SPEED), pose=(-4, 2, 2)),
        Robot(name="unicycle", drive=Unicycle(), pose=(-4, -2, 2)),
    ],
    sampling_time=0.05,
    stop_time=60.0,
    animation=Animation(playback_speed=2),
)


def control(world):
    dx, dy = GOALS - world.pose[:2]
    distance = np.hypot(dx, dy)
    if distance.max() < 0.02:
        world.stop(f"Both have arrived after {world.time:.1f} s")

    angle = wrap(atan2(dy[1], dx[1]) - world.pose[2, 1])
    speed = min(GAIN * distance[1], MAX_SPEED) * cos(angle)
    return np.array([(GAIN * dx[0], GAIN * dy[0]), (speed, TURN_GAIN * angle)]).T
