"""Collective circular motion: robots that see a beacon, and some of the others, circle it evenly.

Setting: distributed, sensors only: range and bearing of the beacon and of robots in view, no poses.
Law: w = k_b g(rho, RHO_0) alpha + k_v sum of g(rho_j, D_0) beta_j over those in view, v constant.
g(rho, r) = ln((rho + r) / (2 r)): to what is further than r, from what is nearer. The bearing alpha
of the beacon is from PSI - 2 pi to PSI, so they turn left. In view is who is nearer than D_S, or
than D_L and |beta_j| <= pi / n. Source: Ceccarelli et al., Automatica 44(12), 2008, with c = 2.
Prediction: a circle, v / radius = k_b g(radius, RHO_0) pi / 2, if k_v <= 2 k_b and the least rho g,
-0.1448 RHO_0, is > -2 v / (3 pi k_b); even gaps, or of D_0 at least where that is shorter.
"""

from functools import partial
from math import asin, cos, degrees, log, pi, sin

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, addons, sensors

RHO_0, D_0, D_L, D_S, PSI = 0.42, 1.05, 1.4, 0.35, 7 * pi / 4  # m, m, m, m, rad


def g(rho, r):
    return log((rho + r) / (2 * r))


def circle(radius, k_b, k_v, robot):
    (rho, alpha, _), seen = robot.sense.beacon["lamp"], {*robot.sense.ahead, *robot.sense.near}
    turn = k_b * g(rho, RHO_0) * (alpha if alpha > PSI - 2 * pi else alpha + 2 * pi)
    turn += k_v * sum(g(each.range, D_0) * each.bearing for each in sorted(seen))
    return radius * k_b * g(radius, RHO_0) * pi / 2, turn


def scenario(n=4, radius=0.7, k_b=0.63, k_v=0.75):  # -, m, rad/s, rad/s
    ahead = sensors.RangeBearing(name="ahead", range=D_L, field_of_view=2 * pi / n)
    eyes = sensors.Beacon(through_walls=True), ahead, sensors.RangeBearing(name="near", range=D_S)
    law, turns = partial(circle, radius, k_b, k_v), [2 * pi * k / n for k in range(n)]
    robot = Robot(diameter=0.12, sensors=eyes, controller=law, sees="sensors")
    lamp = addons.Beacon(path=[(3.6, 2.5), (1.3, 1.3)], speed=0.045, closed=False, name="lamp")
    ring = addons.Theory(lambda on, now: on.circle(lamp.where(now.time), radius, stroke="#7b3294"))
    return Scenario(
        title="Circular motion",
        robots=[robot.at(2.5 + 1.9 * cos(a + 0.9), 2.5 + 1.9 * sin(a + 0.9), a) for a in turns],
        workspace=[(0, 0), (0, 5), (5, 5), (5, 0)],
        stop_time=200.0,
        addons=[lamp, addons.FieldOfView(), ring],
        animation=Animation(playback_speed=8),
    )


def round_lamp(record, time):  # distances and gaps [degrees]
    lamp, row = record.scenario.addons[0].where(time), np.searchsorted(record.time, time - 1e-9)
    x, y = record.pose[row, :2] - np.transpose([lamp])
    gaps = np.diff(np.sort(np.degrees(np.arctan2(y, x))))
    return np.hypot(x, y), [*gaps, 360 - gaps.sum()]


def checks(record):
    (radius, k_b, k_v), end = record.scenario.robots[0].controller.args, record.time[-1]
    if k_v > 2 * k_b or radius * g(radius, RHO_0) <= 3 * 0.1448 * RHO_0:
        yield Prediction.silent("radius and gaps", "k_v or the radius is beyond what is proven")
    elif end >= 200:  # else they are not there yet
        (rho, gaps), (_, before) = (round_lamp(record, time) for time in (end, end - 20))
        if abs(max(gaps) - max(before)) > 1:
            yield Prediction.silent("radius and gaps", "gaps have changed in the last 20 s")
            return
        yield Prediction.within("radius", radius, rho.mean(), 3, "m")
        even, near = sin(pi / len(gaps)), D_0 / 2 / radius
        gap = 360 - (len(gaps) - 1) * degrees(2 * asin(min(near, even)))
        bound = "equal" if near >= even else "at most"  # several may lose sight of the next one
        yield Prediction("widest gap", gap, max(gaps), 2, "degrees", bound=bound)
