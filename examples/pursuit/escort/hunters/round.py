"""Round: goes for the prey, and slides round the guard on the side where it is further past it."""

from math import asin, atan2, cos, hypot, sin

from mars2d.geometry import wrap

CLEAR = 0.41  # m, between the middles of two robots that just do not touch


def control(robot):
    x, y = robot.position
    (gx, gy), (px, py) = (other.position for other in robot.neighbours)
    prey, guard = atan2(py - y, px - x), atan2(gy - y, gx - x)
    past, apart = float(wrap(prey - guard)), hypot(gx - x, gy - y)
    aside = asin(min(1.0, CLEAR / apart))  # the guard covers this much to both sides
    heading = prey
    if abs(past) < aside and apart < hypot(px - x, py - y):
        heading = guard + (aside if past >= 0 else -aside)
    return 100 * cos(heading), 100 * sin(heading)
