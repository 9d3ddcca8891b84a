"""Coverage of a circle, model answer: which arrangements last, and a workspace that is no circle.

1. H is 23.9 m^4 after a second in both; in the end it is 8.09 in A and 8.67 in B, 7 % more. Both
   are at rest: from B no small step leads to A.
2. Moved by 0.05 m it ends as A, by 0.06 m as B; by -0.1 m as A.
3. With nobody in the middle cells are sectors, their centroids d = 2 R sin(h) / (3 h) from the
   middle, h = pi / n, and H = pi R^4 / 2 - pi R^2 d^2. For n = 5, 6, 7 and 8 that is 13.63, 11.62,
   10.38 and 9.56 m^4; with one in the middle it is 15.12, 11.49, 9.41 and 8.12: from six on it
   pays to have one there. Below robots start in either way, but for up to 0.02 m. Both ways last
   for 5, 6 and 7 robots. A ring of 8 does not: one goes to the middle, or two.
4. `--set hook=True`: robot5 makes for a cell in two pieces, whose centroid lies beyond the wall. It
   runs into the wall, slides along it, since here robots have no friction, and is free once others
   have taken the lower arm; H does not rise. A robot alone (`--set n=1`) stays at the wall for
   good: the centroid of the hook is not in the hook. Of all places that it can get to, H is least
   where it stands.
"""

from functools import partial
from math import cos, pi, sin

import numpy as np

from mars2d import Holonomic, Prediction, Robot
from mars2d.addons import Voronoi
from mars2d.scenario import open_module

base = open_module("coverage_circle")
HOOK = [(0, 0), (5, 0), (5, 2), (2, 2), (2, 3), (5, 3), (5, 5), (0, 5)]


def cover(k, robot):
    return k * (robot.world.addons.voronoi.now.centroids[:, robot.index] - robot.position)


def hollow(n):  # the distance of n robots from the middle, where nobody is, and H
    away = 2 * base.R * sin(pi / n) * n / (3 * pi)
    return away, pi * base.R**4 / 2 - pi * base.R**2 * away**2


def scenario(n: int = 6, middle: bool = False, hook: bool = False, k: float = 0.5):
    away = 2 * base.ring(n - 1)[0] if middle else hollow(n)[0]
    angles = 2 * pi / (n - middle) * np.arange(n - middle) + 0.1
    starts = [
        (away * cos(a) + 0.02 * sin(9 * a), away * sin(a) + 0.02 * sin(20 * a)) for a in angles
    ]
    starts += [(0, 0)] * middle
    if hook:
        starts = [(0.4 + 0.5 * (i % 3), 4.6 - 0.5 * (i // 3)) for i in range(n)]
    robot = Robot(diameter=0.2, drive=Holonomic(), controller=partial(cover, k), friction=0.0)
    circle = base.scenario()
    return circle.replace(
        title=f"Coverage of a {'hook' if hook else 'circle'}, {n} robots",
        robots=[robot.at(*start) for start in starts],
        workspace=HOOK if hook else circle.workspace,
        on_exit="wall",
        stop_time=150.0,
        addons=[Voronoi()],
    )


def checks(record):
    n, voronoi = len(record.scenario.robots), record.scenario.addons[0]
    cost = [voronoi.of(record.frame(row)).cost for row in range(0, len(record.time), 5)]
    yield Prediction("largest rise of H", 0.0, max(*np.diff(cost), 0.0), 1e-9 * cost[0], "m^4")
    inside = (np.hypot(*record.pose[-1, :2]) < base.R / 3).sum()
    if record.scenario.workspace[0][0] == base.R and inside < 2:
        least = base.ring(n - 1)[1] if inside else hollow(n)[1]
        yield Prediction.within("H at the end", least, cost[-1], 1.2, "m^4")
