"""Guard the line: a guard keeps an attacker off a line that is nearer to the attacker.

Question: from where does the attacker get to the line, and where is it caught if it does not?
mars2d run guard_the_line --set attacker=my_law.py --set mu=0.9 --seed 3
Setting: distributed, partial information: each knows its own pose and where the other is. The guard
goes 0.5 m/s, the attacker mu times that, both in any direction. If mu is 0, it is drawn: the lowest
point is up to 0.3 m above or below the line. The referee counts a distance of 0.5 m as a capture,
and the line as reached when the attacker's middle is on it.
Law of both: head for the lowest point that the attacker reaches before the guard is 0.5 m away.
Source: Isaacs, Differential Games, Wiley, 1965: guarding a target; Dorothy, Maity, Shishika and Von
Moll, 2021, arXiv:2111.09205: a quicker guard can keep the attacker in its first Apollonius circle.
Prediction: if all of its region lies above the line, the attacker is caught at the lowest point. A
guard that keeps this law lets nobody lower, and no guard stops who keeps it higher: a saddle point.
"""

import numpy as np
import theory

from mars2d import Animation, Holonomic, Robot, Scenario, load_law
from mars2d.addons import Game, Theory

SPEED, CAPTURE, LINE, VIOLET = 0.5, 0.5, -1.8, "#7b3294"  # m/s, of the guard; m; m, its y
GUARD, ATTACKER = "guards/lowest.py", "attackers/lowest.py"
FIELD, WALL = [(-7, -3), (7, -3), (7, 4), (-7, 4)], 6.8  # m; m, in x
GOAL = [(-7, -3), (7, -3), (7, LINE), (-7, LINE)]


def scenario(mu: float = 0.0, guard: str = GUARD, attacker: str = ATTACKER, seed: int = 0):
    def region(scene, frame):
        start, path = frame.scenario.initial_pose, [*frame.path, frame.pose]
        low = []
        for width, pose in ((3, start), (0, path[max(-11, -len(path))]), (1, frame.pose)):
            edge = theory.region(*pose[:2].T, mu, CAPTURE, WALL)
            low.append(edge[:, edge[1].argmin()])
            if width:  # of the start, and of now; those of a second ago are compared
                scene.line(edge[:, 180:].T, stroke=VIOLET, width=width)  # all ways down
        for robot, place in zip(frame.scenario.robots, start[:2].T, strict=True):  # at its best
            far = robot.drive.max_linear_speed * frame.time / np.hypot(*(low[0] - place))
            scene.circle(place + min(far, 1) * (low[0] - place), robot.radius, stroke=VIOLET)
        said = f"\n\n{low[2][1] - LINE:.2f} m, {low[2][1] - low[1][1]:+.2f} m in 1 s"
        scene.circle(low[2], 0, fill=VIOLET, pixels=5)
        scene.text(low[2], said, color=VIOLET, halo="#ffffff")

    rng, robot = np.random.default_rng(seed), Robot(diameter=0.4, sees="positions")
    x, y, *at = rng.uniform((-3, 1, -3, -1), (3, 3, 3, 1))  # of blue, and of red
    ends, miss = np.reshape((*at, x, y), (2, 2)), rng.uniform(-0.3, 0.3)
    grid = np.arange(30, 100) / 100
    low = {g: theory.region(*ends, g, CAPTURE, WALL)[1].min() for g in grid.tolist()}
    mu = mu or min(low, key=lambda g: abs(low[g] - LINE - miss))
    slow, quick = (Holonomic(max_linear_speed=speed) for speed in (mu * SPEED, SPEED))
    red = robot.replace(name="red", drive=quick, controller=load_law(guard))
    blue = robot.replace(name="blue", drive=slow, controller=load_law(attacker))
    game = Game({"guard": ["red"], "attacker": ["blue"]}, capture=CAPTURE, goal=GOAL)
    return Scenario(
        title="Guard the line",
        robots=[red.at(*at), blue.at(x, y)],
        workspace=FIELD,
        on_exit="wall",
        stop_time=40.0,
        addons=[game, Theory(region)],
        animation=Animation(base_colors=("red", "blue"), playback_speed=2),
    )


checks = theory.checks


def miss(record):
    return -np.subtract(*theory.heights(record))
