"""Pursuit by Voronoi cells: a slower pursuer takes the evader's space, and then catches it.

Setting: centralised, partial information: the team's law knows all positions, and no headings.
Law: the pursuer heads at full speed for the middle m of the edge that its Voronoi cell shares with
the evader's. The evader goes round as in pursuit_corners. Their drives limit both to v_p, v_e.
Source: Huang, Zhang, Ding, Stipanovic and Tomlin, CDC 2011; Casini and Garulli, 2016, 6.2: at 0.8
of its speed the evader is caught after 98 s. All other numbers are ours, chosen for that.
Prediction: by an edge of length L the evader's cell grows, if each goes at x', at the rate
L ((m - x_e) . x_e' - (m - x_p) . x_p') / |x_e - x_p|, which with this law has the bound
L |m - x_e| (v_e - v_p) / |x_e - x_p|: at equal speeds it never grows.
"""

from math import dist

import numpy as np

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Game, Theory, Voronoi

SPEED, VIOLET = 0.2, "#7b3294"  # m/s
POINTS = 4.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def control(world, k=0):
    while True:
        hunter, evader = world.position.T
        if dist(evader, POINTS[k]) < 1e-9:
            k = max((k + 1) % 4, (k - 1) % 4, key=lambda j: dist(POINTS[j], hunter))
        middle = np.mean(world.addons.voronoi.now.edge(0, 1), axis=0)
        yield np.transpose([middle - hunter, POINTS[k] - evader]) / world.sampling_time


def scenario(ratio: float = 0.8):
    def ground(scene, frame):
        cells = frame.scenario.addons[0].of(frame)
        scene.polygon(cells.cells[1].exterior.coords, stroke=VIOLET, width=1.5)
        scene.line(cells.edge(0, 1), stroke=VIOLET, width=3)
        scene.circle(np.mean(cells.edge(0, 1), axis=0), 0, fill=VIOLET, pixels=4)

    red = Robot(name="red", diameter=0.55, drive=Holonomic(max_linear_speed=ratio * SPEED))
    blue = red.replace(name="blue", drive=Holonomic(max_linear_speed=SPEED))
    robots, title = [red.at(1, 2), blue.at(*POINTS[0])], "Pursuit by Voronoi cells"
    addons = [Voronoi(), Game({"pursuer": ["red"], "evader": ["blue"]}), Theory(ground)]
    look = Animation(base_colors=("red", "blue"), playback_speed=10)
    return Scenario(
        title=title, robots=robots, sees="positions", stop_time=500, addons=addons, animation=look
    )


def checks(record):
    (red, blue), step = record.scenario.robots, record.scenario.sampling_time
    lead = blue.drive.max_linear_speed - red.drive.max_linear_speed
    cells = [record.scenario.addons[0].of(record.frame(k)) for k in range(len(record))]
    to = np.array([np.mean(c.edge(0, 1), axis=0)[:, None] - c.points for c in cells])  # m - x
    part, area = np.array([(dist(*c.edge(0, 1)) / dist(*c.points.T), c.areas[1]) for c in cells]).T
    rate = part * ([-1, 1] * to * np.gradient(record.pose[:, :2], step, axis=0)).sum(axis=(1, 2))
    end = area[0] + np.trapezoid(rate, dx=step)
    yield Prediction("evader's cell in the end", end, area[-1], 0.02, "m^2")
    above = (np.gradient(area, step) - part * np.hypot(*to[:, :, 1].T) * lead).max()
    yield Prediction("its growth above the bound", 0, max(above, 0), 0.5 * step**2, "m^2/s")
