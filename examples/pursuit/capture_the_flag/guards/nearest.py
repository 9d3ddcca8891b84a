"""Nearest: each guard runs straight at the attacker that is nearest to it."""

from math import dist

CAPTURE = 0.5  # m


def control(robot):
    out = set()
    while True:
        team = {other.name: other.position for other in robot.neighbours}
        blue = {name: team.pop(name) for name in [*team] if name.startswith("blue")}
        guards = [robot.position, *team.values()]
        out |= {b for b in blue if any(dist(blue[b], at) <= CAPTURE for at in guards)}
        free = [at for name, at in blue.items() if name not in out] or [robot.position]
        yield 100 * (min(free, key=lambda at: dist(at, robot.position)) - robot.position)
