"""Relay: decoys lead the guards away; another takes the flag, and runs home past the guards."""

from math import dist

import numpy as np

FLAG, REACH, CAPTURE, HOME, WALL = np.array([-4.0, 0.0]), 0.45, 0.5, 3.0, 3.7  # m


def control(robot):
    out, carrier = set(), None
    while True:
        team = {other.name: other.position for other in (robot, *robot.neighbours)}
        guards = [at for name, at in team.items() if name.startswith("guard")]
        near = {b: min(dist(team[b], at) for at in guards) for b in team if b.startswith("blue")}
        out |= {b for b in near if near[b] <= CAPTURE or (b == carrier and team[b][0] >= HOME)}
        carrier = None if carrier in out else carrier
        free = sorted(near.keys() - out - {carrier}, key=near.get)
        carrier = carrier or next((b for b in free if dist(team[b], FLAG) < REACH), None)
        here, goal = robot.position, FLAG
        if carrier == robot.name:  # to the height at which it is first by most
            y = np.linspace(-WALL, WALL, 30)
            ways = [np.hypot(HOME - at[0], y - at[1]) for at in (here, *guards)]
            goal = HOME + 1, y[(np.min(ways[1:], axis=0) - ways[0]).argmax()]
        elif robot.name in free[: len(guards)] and (carrier or len(free) > len(guards)):
            goal = 2 * here - min(guards, key=lambda at: dist(at, here))
        yield 100 * (goal - here)
