"""Coverage of a circle: one start is moved by 0.1 m, and all end elsewhere.

Setting: centralised with full information: the add-on Voronoi divides the circle by all poses.
Question: eight robots share out a circle. Do they always end in the same way?
Law: v = k ahead, w = 2 k atan(aside / ahead), of the way to the centroid (Cortes et al., 2004).
Prediction: H never rises, so all end at their centroids, but in one of several ways. One robot in
the middle and m round it at the distance 2 a are at centroids if, with h = pi / m and the radius R,
2 a A = 2/3 (R^3 sin h - a^3 tan h) with A = R^2 h - a^2 tan h; then H = pi R^4 / 2 - 4 m a^2 A.
The MARS paper (Fig. 5, A and B: 1 and 50 s) gives no radius, gain or starts: these are ours.
"""

from cmath import phase, rect
from functools import partial
from math import pi, sin, tan

import numpy as np

from mars2d import Prediction, Robot, Scenario
from mars2d.addons import Theory, Voronoi

R, ANGLES = 2.5, np.arange(60) * pi / 30  # m; of the corners of the polygon that it is
STARTS = [(-0.6, 0.3), (-1.3, 0.3), (-1.0, -0.8), (0.1, -0.8), (-0.5, -1.5), (-0.1, -0.5)]
STARTS += [(-1.2, -1.1), (-0.9, 0.0)]


def cover(k, robot):
    x, y = robot.world.addons.voronoi.now.centroids[:, robot.index] - robot.position
    way = complex(x, y) * rect(1, -robot.pose[2])  # ahead + i aside
    return k * way.real, 2 * k * phase(way if way.real >= 0 else -way)


def ring(m, a=0.0):  # half the distance of m robots from the middle [m], and H [m^4]
    for _ in range(50):
        area = R**2 * pi / m - a**2 * tan(pi / m)
        a = (R**3 * sin(pi / m) - a**3 * tan(pi / m)) / (3 * area)
    return a, pi * R**4 / 2 - 4 * m * a**2 * area


def scenario(moved: float = 0.0, k: float = 1.0):  # m; 1/s. A, and B: --set moved=0.1
    starts = np.add(STARTS, [(0, 0)] * 7 + [(moved, 0)])
    return Scenario(
        title=f"Coverage of a circle, {'B' if moved else 'A'}",
        robots=[Robot(diameter=0.2, controller=partial(cover, k)).at(*xy) for xy in starts],
        workspace=R * np.column_stack([np.cos(ANGLES), np.sin(ANGLES)]),
        sampling_time=0.2,
        stop_time=50.0,
        addons=[Voronoi(), Theory(lambda s, _: s.circle((0, 0), 2 * ring(7)[0], stroke="#7b3294"))],
    )


def checks(record):
    cells = [record.scenario.addons[0].of(record.frame(row)) for row in range(len(record.time))]
    cost, last = np.array([each.cost for each in cells]), cells[-1]
    off, away = np.hypot(*(last.centroids - last.points)).max(), np.sort(np.hypot(*last.points))
    yield Prediction("largest rise of H", 0.0, max(*np.diff(cost), 0.0), 1e-12 * cost[0], "m^4")
    if record.scenario.stop_time * min(record.scenario.robots[0].controller.args[0], 1) >= 25:
        yield Prediction("farthest from its centroid", 0.0, off, 0.02, "m")
        if away[0] < R / 3 < away[1]:
            yield Prediction.within("nearest of the ring", 2 * ring(7)[0], away[1], 1, "m")
            yield Prediction.within("H at the end", ring(7)[1], cost[-1], 1, "m^4")
