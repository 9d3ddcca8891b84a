"""Circle: runs round the middle of the arena, as far from it as he starts."""

from math import cos, hypot, pi, sin


def control(robot):
    radius, way = hypot(*robot.position), robot.drive.max_linear_speed * robot.sampling_time
    while True:
        x, y = robot.position
        far = max(hypot(x, y), 1e-9)
        turn = min(way / max(radius, way), pi / 2)  # rad, until the next control step
        nx, ny = cos(turn) * x - sin(turn) * y, sin(turn) * x + cos(turn) * y
        yield 100 * (nx * radius / far - x), 100 * (ny * radius / far - y)
