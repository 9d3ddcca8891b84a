"""Pinned, a model answer: one hunter holds an evader of 0.7 of its force, and no equal one.

1. At 45 degrees a hunter holds cos 45 = 0.71 of its force along each wall.
2. Along the walls each holds all of its force along one and nothing along the other: 1. Side by
   side they hold cos 15 + cos 75 = 1.22 along both: more, since each helps the other.
3. Straight out of the corner the evader pushes only 0.71 of its force along each wall, and needs
   1.22 / 0.71 = 1.73: of all ways it is the worst.
4. Below, one hunter on the diagonal against an evader of 0.65 of its force.
"""

from math import cos, pi, sin

from mars2d.scenario import open_module

base = open_module("pinned")


def push(robot):
    return 100 * (robot.neighbours[0].position - robot.position)


def scenario(strength: float = 0.65):
    plain = base.scenario(strength)
    red, _, blue = plain.robots
    x, y = (base.SIZE / 2 + base.NEAR * way(pi / 4) for way in (cos, sin))
    game = plain.addons[0].replace(roles={"hunters": ["red 1"], "evader": ["blue"]})
    robots = [red.at(x, y).replace(controller=push), blue]
    return plain.replace(robots=robots, addons=[game, *plain.addons[1:]])


checks = base.checks
