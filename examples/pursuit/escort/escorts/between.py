"""Between: keeps close to the prey, on the side from which the hunter comes."""

from math import atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap

NEAR = 0.42  # m, from the prey's middle: its robots have a diameter of 0.4 m


def control(robot):
    (hx, hy), (px, py) = (other.position for other in robot.neighbours)
    x, y = robot.position - (px, py)
    angle = atan2(y, x)
    behind = float(wrap(atan2(hy - py, hx - px) - angle))  # by so much it has to go round
    aside = 20 * NEAR * behind * min(1.0, NEAR / hypot(x, y))
    inwards = 10 * (hypot(x, y) - NEAR)
    return aside * cos(angle + pi / 2) - inwards * cos(angle), (
        aside * sin(angle + pi / 2) - inwards * sin(angle)
    )
