"""Coverage: twenty robots from a corner divide a square, each moving to the centroid of its cell.

Setting: centralised with full information: the add-on Voronoi divides the square by all poses.
Question: how do robots spread so that each place has one nearby, and when do they stop?
Law: each goes to the centroid of its Voronoi cell. Of the way there, `ahead` and `aside` of its
heading, a unicycle takes v = k ahead, w = 2 k atan(aside / ahead); a holonomic robot, k times all.
Source: Cortes, Martinez, Karatas and Bullo, IEEE Trans. on Robotics and Automation 20(2), 2004.
Prediction: H, the integral over all places of the squared distance to the nearest robot, has the
gradient 2 area (p - centroid): it never rises, and in the end all stand at their centroids. No H is
less than that of n regular hexagons, 5 A^2 / (18 sqrt(3) n) (L. Fejes Toth, 1953), nor far above.
The MARS paper (Fig. 4: almost steady at 60 s) gives no gain, size or starts: these are ours.
"""

from functools import partial
from math import atan2, cos, pi, sin, sqrt

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Voronoi

SIDE = 5.0  # m


def cover(k, robot):
    cells = robot.world.addons.voronoi.now
    x, y = cells.centroids[:, robot.index] - robot.position  # the way to go
    if isinstance(robot.drive, Holonomic):
        return k * x, k * y
    c, s = cos(robot.pose[2]), sin(robot.pose[2])
    ahead, aside = c * x + s * y, c * y - s * x
    turn = atan2(aside, ahead) if ahead >= 0 else atan2(-aside, -ahead)  # atan(aside / ahead)
    return k * ahead, 2 * k * turn


def scenario(k: float = 1.0, holonomic: bool = False):  # 1/s
    drive = Holonomic() if holonomic else Unicycle()
    robot = Robot(diameter=0.15, drive=drive, controller=partial(cover, k))
    column, row = np.divmod(np.arange(20), 4)
    x, y = (0.3 + 0.35 * at + 0.05 * np.sin(7 * np.arange(20) + at) for at in (column, row))
    return Scenario(
        title="Coverage of a square",
        robots=[*map(robot.at, x, y, [pi / 4] * 20)],
        workspace=[(0, 0), (0, SIDE), (SIDE, SIDE), (SIDE, 0)],
        sampling_time=0.2,
        stop_time=200.0,
        addons=[Voronoi()],
        animation=Animation(playback_speed=10),
    )


def checks(record):
    cells = [record.scenario.addons[0].of(record.frame(row)) for row in range(len(record.time))]
    cost, last = np.array([each.cost for each in cells]), cells[-1]
    off = np.hypot(*(last.centroids - last.points)).max()
    yield Prediction("largest rise of H", 0.0, max(*np.diff(cost), 0.0), 1e-12 * cost[0], "m^4")
    if record.scenario.stop_time * min(record.scenario.robots[0].controller.args[0], 1) >= 60:
        yield Prediction("farthest from its centroid", 0.0, off, 0.02, "m")
        hexagons = 5 * SIDE**4 / (18 * sqrt(3) * 20)
        yield Prediction.within("H at the end", hexagons, cost[-1], 10, "m^4")
