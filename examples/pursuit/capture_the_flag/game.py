"""Capture the flag: guards and attackers in any number: which guard takes which attacker?

Question: how many attackers are sure not to reach the flag? Play with laws of your own:
mars2d run capture_the_flag --set attacker=my_law.py --set attackers=4 --seed 3
Setting: distributed, partial information: each knows its own pose and where all others are. Guards
go 0.5 m/s, attackers mu times that. A distance of 0.5 m is a capture; an attacker is at the flag
when its middle is within 0.5 m. One at the flag wins for all; all go on until none is free.
With carry=True the first one there takes it, and is safe only when it has carried it home.
Law of a guard: to a place that its attacker reaches before it; matched by who can stop whom.
Source: Chen, Zhou and Tomlin, IEEE Trans. Automatic Control 62(3), 2017, for pairs: Isaacs, 1965.
Prediction: a guard stops an attacker alone if the flag is outside the attacker's dominance region.
Of N attackers at most N - m reach the flag, where m is the size of the maximum matching.
"""

from math import cos, pi, sin

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, CAPTURE, REACH, VIOLET = 0.5, 0.5, 0.5, "#7b3294"  # m/s, of guards; m
GUARD, ATTACKER = "guards/match.py", "attackers/region.py"
GOAL = [(REACH * cos(k * pi / 12) - 4, REACH * sin(k * pi / 12)) for k in range(24)]


def scenario(guards=2, attackers=4, mu=1.0, carry=False, guard=GUARD, attacker=ATTACKER, seed=0):
    def pairs(scene, frame):
        now = {leaving.robot: leaving.result for leaving in sorted(game.exits_at(frame))}
        free = [k for k in range(guards, guards + attackers) if not now.get(k)]
        team = [*range(guards), *(k for k in free if k not in now)]  # no carrier of the flag
        path, most = [*frame.path, frame.pose], []
        for pose in (path[max(-11, -len(path))], frame.pose):  # a second ago, and now
            places = pose[:2, team].T
            matched = theory.matching(places, guards, mu)
            most.append(len(free) - len(matched))
        for i, j in matched:
            scene.line([places[i], places[guards + j]], stroke=VIOLET, width=3)
        start = frame.scenario.initial_pose[:2].T
        for i, j in theory.matching(start, guards, mu):  # where both would be at their best
            goal = theory.nearest(start[guards + j], start[i], mu)
            for place, speed in ((start[i], SPEED), (start[guards + j], mu * SPEED)):
                far = min(1, speed * frame.time / np.hypot(*(goal - place)))
                scene.circle(place + far * (goal - place), robot.radius, stroke=VIOLET)
        said = f"at most {most[1]} more, {most[1] - most[0]:+d} in 1 s\n\n"
        scene.text((-4, REACH), said, color=VIOLET, halo="#ffffff")

    rng, robot = np.random.default_rng(seed), Robot(diameter=0.4, sees="positions")
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (mu * SPEED, SPEED))
    red = robot.replace(drive=quick, controller=load_law(guard), color="red")
    blue = robot.replace(drive=slow, controller=load_law(attacker), color="blue")
    y = [np.linspace(-4, 4, k + 2)[1:-1] for k in (guards, attackers)]
    x = [rng.uniform(-2, 0.5, guards), rng.uniform(1, 3, attackers) - rng.uniform(1, 2.5)]
    team = [red.replace(name=f"guard {k + 1}").at(x[0][k], y[0][k]) for k in range(guards)]
    team += [blue.replace(name=f"blue {k + 1}").at(x[1][k], y[1][k]) for k in range(attackers)]
    roles = {"guard": range(guards), "attacker": range(guards, guards + attackers)}
    walls = {"workspace": [(-6, -4), (6, -4), (6, 4), (-6, 4)], "on_exit": "wall"}
    flag = {"goal": GOAL, "home": theory.HOME if carry else None}
    game = Game(roles, capture=CAPTURE, to_the_end=True, **flag)
    plan = {"title": "Capture the flag", "stop_time": 60, "animation": Animation(playback_speed=2)}
    return Scenario(robots=team, addons=[game, Theory(pairs)], **plan, **walls)


def at_the_flag(record):
    """How many reach the flag, or bring it home."""
    return len(theory.safe(record))


checks = theory.checks
