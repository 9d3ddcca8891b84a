"""Model answer to the exercises of random_walk.

1. The digest, the paths and the number of turns change (105 to 130 with seeds 0 to 5), and so does
   how far both go, by 1 %: 374 to 379 m. The mean turn stays within four standard errors of 180.
2. A straight line that is put down anywhere passes within r of a point with a chance that grows
   with 2 r; of lines of length L in all on the free area A, so many miss it that exp(-2 r L / A)
   is left. L is the way ahead less what was gone back, A where robots can be: 74.5 m^2, 0.3 m from
   all walls. For r = 0.1 m and the paper's law: predicted 0.58 to 0.60, measured 0.52 to 0.57 with
   seeds 0 to 5. It is less since lines that start at the same wall lie close together.
3. pi A / P = 3.69 m, with the perimeter P = 63.4 m (walls and obstacles, 0.3 m off). Measured:
   3.16 m, the mean of seeds 0 to 11. Too many robots leave a wall at a flat angle and soon meet it
   again.
4. The law below turns by 180 degrees + arcsin(U(-1, 1)): flat angles are rarer. So runs are longer,
   3.30 m, the mean of the same seeds; not 3.69 m, since "straight back" is not at right angles to
   the wall. Turns even in (0, 360) degrees make them shorter: 2.30 m.
5. It goes back for as long as it senses something, whatever that is: in the gap it backs into the
   other wall and stays there, since it senses both for good. Cure: after five steps back in a row
   it turns all the same, and so finds its way out.
"""

from math import asin, pi, sqrt

import numpy as np

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("random_walk")
REACH, NEAR, PATIENCE = 0.3, 0.1, 5  # m, of the sensor; m, what counts as visited; steps back


def wander(robot):
    back = getattr(robot.memory, "back", 0)
    robot.memory.back = 0
    if robot.sense.proximity and back < PATIENCE:
        robot.memory.back = back + 1
        return -0.2, 0.0
    if robot.command[0] < 0:
        return 0.0, pi + asin(robot.rng.uniform(-1, 1))
    return 0.2, 0.0


scenario = base.scenario.replace(
    title="Random movements, model answer",
    robots=[robot.replace(controller=wander) for robot in base.scenario.robots],
)


def checks(record):
    import shapely

    solid = [shapely.Polygon(o) for o in record.scenario.addons[0].outlines if len(o) > 2]
    room = shapely.Polygon(record.scenario.workspace)
    free = room.buffer(-REACH).difference(shapely.union_all(solid).buffer(REACH))
    v, omega = record.command[:-1, 0], record.command[:-1, 1]
    turns, spread = omega[v == 0], sqrt(pi**2 / 4 - 2)  # of arcsin(U(-1, 1))
    sure = 2.2 / sqrt(len(turns))  # four standard errors, by its fourth moment
    yield Prediction("turn, mean", pi, turns.mean(), 4 * spread / sqrt(len(turns)), "rad")
    yield Prediction("turn, spread", spread, turns.std(), sure * spread, "rad")
    points = np.random.default_rng(1).uniform(0, 10, (10_000, 2))
    points = points[shapely.contains_xy(free, points)]
    paths = shapely.MultiLineString(list(record.pose[:, :2].transpose(2, 0, 1)))
    visited = np.mean(shapely.distance(shapely.points(points), paths) < NEAR)
    way = 0.2 * (np.count_nonzero(v > 0) - np.count_nonzero(v < 0))
    predicted = 1 - np.exp(-2 * NEAR * way / free.area)
    yield Prediction.within("share that is visited", predicted, visited, percent=20)
