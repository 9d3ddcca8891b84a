"""Pursuit by Voronoi cells: a slower pursuer takes the evader's space, and then catches it.

Setting: distributed, partial information: each knows its own pose and where the others are.
Law: the pursuer turns to the middle m of the edge that its Voronoi cell shares with the evader's,
which goes round as in pursuit_corners: unicycles, v = v_max max(0, cos a), w = k a for an angle a.
Source: Huang et al., CDC 2011; Casini and Garulli, 2016, 6.2: caught after 98 s at 0.8 the speed.
Prediction: by an edge of length L the evader's cell grows, if each goes at x', at the rate
L ((m - x_e) . x_e' - (m - x_p) . x_p') / |x_e - x_p|: if the pursuer points to m, by no more than
L |m - x_e| (v_e - v_p) / |x_e - x_p|, at equal speeds 0.
"""

from math import atan2, cos, dist

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Game, Theory, Voronoi
from mars2d.geometry import Tessellation, wrap

SPEED, TURN, NEAR, VIOLET = 0.2, 4.0, 0.25, "#7b3294"  # m/s; k, 1/s; m, to a point
POINTS = 4.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])  # at 0.9 of the arena's corners


def steer(robot, aim):
    angle = wrap(atan2(*(aim - robot.position)[::-1]) - robot.pose[2])
    return robot.drive.max_linear_speed * max(0, cos(angle)), TURN * angle


def pursue(robot):
    others = [other.position for other in robot.neighbours]  # the evader is the last one
    edge = Tessellation(np.transpose([robot.position, *others]), POINTS / 0.9).edge(0, len(others))
    return steer(robot, np.mean(edge, axis=0) if edge else others[-1])


def evade(robot, k=0):
    while True:
        if dist(robot.position, POINTS[k]) < NEAR:
            far = [min(dist(p, other.position) for other in robot.neighbours) for p in POINTS]
            k = max((k + 1) % 4, (k - 1) % 4, key=far.__getitem__)
        yield steer(robot, POINTS[k])


def scenario(ratio: float = 0.8):
    def ground(scene, frame):
        cells = frame.scenario.addons[0].of(frame)
        scene.polygon(cells.cells[1].exterior.coords, stroke=VIOLET, width=1.5)
        scene.line(cells.edge(0, 1), stroke=VIOLET, width=3)
        scene.circle(np.mean(cells.edge(0, 1), axis=0), 0, fill=VIOLET, pixels=4)

    slow, fast = (Unicycle(max_linear_speed=v, wheel_semiaxis=0.05) for v in (ratio * SPEED, SPEED))
    red = Robot(name="red", diameter=0.55, drive=slow, controller=pursue, sees="positions")
    blue = red.replace(name="blue", drive=fast, controller=evade)
    robots, title = [red.at(1, 2), blue.at(*POINTS[0])], "Pursuit by Voronoi cells"
    addons = [Voronoi(), Game({"pursuer": ["red"], "evader": ["blue"]}), Theory(ground)]
    look = Animation(base_colors=("red", "blue"), playback_speed=10)
    return Scenario(title=title, robots=robots, stop_time=500, addons=addons, animation=look)


def checks(record):
    slow, fast, t = *(robot.drive.max_linear_speed for robot in record.scenario.robots), record.time
    cells = [record.scenario.addons[0].of(record.frame(k)) for k in range(len(t))]
    to = np.array([np.mean(c.edge(0, 1), axis=0)[:, None] - c.points for c in cells])  # m - x
    part, area = np.array([(dist(*c.edge(0, 1)) / dist(*c.points.T), c.areas[1]) for c in cells]).T
    rate = part * ([-1, 1] * to * np.gradient(record.pose[:, :2], t, axis=0)).sum(axis=(1, 2))
    end = area[0] + np.trapezoid(rate, t)
    yield Prediction("evader's cell in the end", end, area[-1], 0.02, "m^2")
    points = record.command[:-1, 0, 0] > 0.99 * slow  # within 8 degrees to m
    most = part * np.hypot(*to[:, :, 1].T) * (fast - 0.98 * slow)
    above = (np.diff(area) / np.diff(t) - np.maximum(most[1:], most[:-1]))[points].max(initial=-1e3)
    yield Prediction("its growth above the bound", 0, above, 0.005, "m^2/s", bound="at most")
