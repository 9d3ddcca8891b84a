"""Late: stands until the seeker is nearly where it can see it, and only then runs."""

from math import acos, atan2, cos, hypot, pi, sin

from mars2d.geometry import wrap

PILLAR, RADIUS, EARLY = 1.5, 1.75, 0.3  # m, of the pillar and of its circle; rad


def control(robot):
    (x, y, theta), heard = robot.sense.pose, robot.sense.range_bearing[0]
    angle = theta + heard.bearing
    sx, sy = x + heard.range * cos(angle), y + heard.range * sin(angle)
    ahead = float(wrap(atan2(y, x) - atan2(sy, sx)))
    seen = acos(min(1.0, PILLAR / hypot(sx, sy))) + acos(min(1.0, PILLAR / hypot(x, y)))
    way = 1 if ahead > 0 else -1
    heading = atan2(y, x) + way * (pi / 2 + 2 * min(0.7, max(-0.5, hypot(x, y) - RADIUS)))
    speed = 100 if abs(ahead) < seen + EARLY else 0
    return speed * cos(heading), speed * sin(heading)
