"""Late: stands until the seeker is nearly where it can see it, and only then runs."""

from math import acos, atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap

BESIDE, EARLY = 0.25, 0.3  # m, of its circle from the pillar; rad


def control(robot):
    radius = round(hypot(*robot.sense.pose[:2]), 3)  # m, of the circle on which it starts
    pillar = radius - BESIDE
    while True:
        (x, y, theta), heard = robot.sense.pose, robot.sense.range_bearing[0]
        angle = theta + heard.bearing
        sx, sy = x + heard.range * cos(angle), y + heard.range * sin(angle)
        ahead = float(wrap(atan2(y, x) - atan2(sy, sx)))
        seen = acos(min(1.0, pillar / hypot(sx, sy))) + acos(min(1.0, pillar / hypot(x, y)))
        way = 1 if ahead > 0 else -1
        heading = atan2(y, x) + way * (pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - radius)))
        speed = 100 if abs(ahead) < seen + EARLY else 0
        yield speed * cos(heading), speed * sin(heading)
