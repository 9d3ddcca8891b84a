"""Round a pillar, a model answer: two equal pursuers catch who runs round for ever before one.

1. The way that the pursuer has to gain is the arc less that of the capture: 32 s, 16 s, 8 s.
2. With l = 1.4 m the arc of the capture is 2 h asin(l / 2 h) = 1.44 m instead of 0.70 m: sooner by
   0.74 m / 0.125 m/s = 6 s. At equal speeds it changes nothing, up to l = 2 h, the pillar's width.
3. `straight` is stopped by the pillar or slides along it: in 60 s it catches nobody at mu = 1.25.
4. Below, two pursuers at mu = 1 go round both ways. One who stands opposite is caught by both at
   t = (pi h - 2 h asin(l / 2 h)) / v, and one who runs meets one of them sooner.
"""

from functools import partial
from math import asin, atan2, cos, hypot, pi, sin

from mars2d import Prediction
from mars2d.scenario import open_module

base = open_module("round_a_pillar")
H = 1.75  # m, of the circle on which all run


def run(way, robot):
    x, y = robot.position
    heading = atan2(y, x) + way * (pi / 2 + 2 * (hypot(x, y) - H))
    return 100 * cos(heading), 100 * sin(heading)


def stand(_):
    return 0.0, 0.0


def scenario():
    plain = base.scenario(mu=1.0)
    red, blue = plain.robots
    near = 0.3  # rad, between the pursuers: they start side by side
    team = [
        red.replace(name=name, controller=partial(run, way)).at(*base.circle(way * near, H))
        for name, way in (("red", 1), ("orange", -1))
    ]
    game = plain.addons[1].replace(roles={"pursuer": ["red", "orange"], "evader": ["blue"]})
    blue = blue.replace(controller=stand).at(-H, 0)
    return plain.replace(robots=[*team, blue], addons=[plain.addons[0], game])


def checks(record):
    way = H * (pi - 0.3 - 2 * asin(base.CAPTURE / 2 / H))
    yield Prediction("the evader is free for", way / base.SPEED, record.time[-1], 0.2, "s")
