"""Coverage of a square, model answer: each knows its neighbours only, and some robots break down.

1. H is within 1 % of its last value after 92, 41 and 17 s with k = 0.5, 1 and 2; after 41 s with
   holonomic robots at k = 1. Early on the bound of the speed decides, 0.5 m/s, and not k.
2. The bound goes with 1 / n, and so does H, nearly: 22.0, 10.6, 5.26, 2.61 and 1.29 m^4 are left
   with 5, 10, 20, 40 and 80 robots (points under the law alone, from random starts): 10, 6, 5, 4
   and 3 % above the bound. The rest is due to the cells at the edge, which can be no hexagons.
3. Below: a cell depends on its neighbours in Delaunay's triangulation alone, so each robot computes
   its own from its and their positions. The first check says that the commands are those of the law
   that knows all poses, to rounding.
4. Robots go where it is dense. With 10 robots and `hill` (`--set failing=0 --set dense=True`) one
   ends near the top. With many, areas go with phi to the power -1/2 (P. Zador, 1982; A. Gersho,
   1979): areas of 200 points under the law alone fitted a power of -0.44; cells at the edge differ.
5. Three of ten robots break down after 20 s: H ends at 10.81 m^4, without that it is 10.66; with
   five it is 11.10. H never rises all the same, and those that work end at their centroids.
"""

from functools import partial

import numpy as np

from mars2d import Animation, Delaunay, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Density, Voronoi
from mars2d.geometry import Tessellation

SIDE, BREAKDOWN = 5.0, 20.0  # m; s, when some robots break down
SQUARE = [(0, 0), (0, SIDE), (SIDE, SIDE), (SIDE, 0)]


def hill(x, y):
    return 0.1 + 1 / (1 + (x - 3.5) ** 2 + (y - 3.5) ** 2) ** 2


def cover(k, failing, phi, robot):
    if robot.index < failing and robot.time >= BREAKDOWN:
        return 0.0, 0.0
    near = [robot.position, *(other.position for other in robot.neighbours)]
    mine = Tessellation(np.transpose(near), SQUARE, phi).centroids[:, 0]
    return k * (mine - robot.position)


def scenario(failing: int = 3, dense: bool = False, k: float = 0.5, n: int = 10):
    law = partial(cover, k, failing, hill if dense else None)
    robot = Robot(diameter=0.2, drive=Holonomic(), controller=law, sees="positions")
    row, column = np.divmod(np.arange(n), 4)
    starts = zip(0.3 + 0.5 * column + 0.05 * row, 0.3 + 0.5 * row, strict=True)
    return Scenario(
        title="Coverage by neighbours",
        robots=[robot.at(*start) for start in starts],
        neighbours=Delaunay(),
        workspace=SQUARE,
        sampling_time=0.5,
        stop_time=100.0,
        addons=[Voronoi(), *([Density(hill)] if dense else [])],
        animation=Animation(playback_speed=10),
    )


def checks(record):
    k, failing, _ = record.scenario.robots[0].controller.args
    cells = [record.scenario.addons[0].of(record.frame(row)) for row in range(len(record.time))]
    cost, last = np.array([each.cost for each in cells]), cells[-1]
    ways = np.array([each.centroids - each.points for each in cells])  # (T, 2, n)
    slow = np.hypot(*ways.swapaxes(0, 1)) < 0.5 / k  # the speed is not bounded
    working = (np.arange(len(last.areas)) >= failing) | (record.time[:, None] < BREAKDOWN)
    wrong = np.abs(k * ways - record.command).max(axis=1)[slow & working].max()
    off = np.hypot(*ways[-1])[failing:].max()
    rise = max(*np.diff(cost), 0.0)
    yield Prediction("off the law of all poses", 0.0, wrong, 1e-9, "m/s")
    yield Prediction("largest rise of H", 0.0, rise, 1e-7 * cost[0], "m^4")  # 1e-7: of the sums
    yield Prediction("farthest from its centroid", 0.0, off, 0.02, "m")
