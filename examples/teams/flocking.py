"""A flock: robots that see only each other's distance and direction come to move in one direction.

Setting: distributed, with sensors only: range and bearing of those in view; no headings, no poses.
Question: Reynolds' boids (1987) steer apart, together, and as their neighbours do. Can a flock do
without the third rule, which needs the others' headings?
Law: each is pulled towards those whom it sees with q^3 - q^6, q = SPACING / range: from near ones
away. What of the pull lies ahead makes it quicker, what lies to its left turns it left. Source:
Ferrante et al., Adaptive Behavior 20(6), 2012; with springs Phys. Rev. Lett. 111, 268302, 2013.
Prediction: whoever goes another way is pulled back and turned. In the end all go one way: the
polarisation, the length of the mean of their headings' unit vectors (Vicsek et al. 1995), is near
1, and where pulls cancel out, the flock goes at CRUISE. Nobody touches, nobody is lost. Those
beyond the nearest pull, too: robots stand a little closer than SPACING. (0.05: the sensor's noise.)
"""

from math import cos, pi, sin

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario
from mars2d.sensors import RangeBearing

SPACING, CRUISE = 0.8, 0.15  # m, m/s


def flock(robot):
    ahead = left = 0.0
    for other in robot.sense.range_bearing:
        q = SPACING / other.range
        ahead += (q**3 - q**6) * cos(other.bearing)
        left += (q**3 - q**6) * sin(other.bearing)
    return CRUISE + 0.2 * ahead, left  # m/s, rad/s


def scenario(disorder: float = 0.7, noise: float = 0.01, view: float = 1.8):
    eyes = RangeBearing(range=view, identity=False, noise=noise)  # noise in m and rad
    bird = Robot(diameter=0.25, sensors=[eyes], controller=flock, sees="sensors")
    rows, columns = np.divmod(np.arange(15), 5)
    headings = disorder * (2.4 * np.arange(15) % (2 * pi) - pi)  # 1: any, 0: all go right
    return Scenario(
        title="Flocking",
        robots=[*map(bird.at, (columns - 2 + rows / 2) * SPACING, (rows - 1) * 0.7, headings)],
        workspace=[(-3, -5), (-3, 3), (11, 3), (11, -5)],
        on_exit="ignore",
        stop_time=60.0,
        animation=Animation(playback_speed=3),
    )


def checks(record):
    (x, y, theta), end = record.pose.swapaxes(0, 1), record.time >= record.time[-1] - 10  # s
    heading = np.hypot(np.cos(theta[end]).mean(axis=1), np.sin(theta[end]).mean(axis=1))
    yield Prediction("polarisation in the last 10 s", 1, heading.mean(), 0.05)
    way = np.hypot(*(np.ptp(center[end].mean(axis=1)) for center in (x, y)))
    yield Prediction.within("speed of the flock then", CRUISE, way / 10, 10, "m/s")
    x, y = record.pose[-1, :2]
    apart = np.hypot(x - x[:, None], y - y[:, None]) + np.diag([np.inf] * len(x))
    gap = apart.min(axis=0)
    yield Prediction.within("mean distance to the nearest", SPACING, gap.mean(), 20, "m")
    yield Prediction("of those that lost the flock", 0, (gap > 1.5 * SPACING).sum(), 0)
    yield Prediction("contacts", 0, len(record.contacts), 0)
