"""Many push one: the forces of several robots add up.

Question: a load that the floor holds too firmly for one robot. How many must push?
Prediction: the floor holds the load of mass m with up to mu m g (Coulomb, 1785). Forces add up, so
k robots of mass M and force F move it if k F > mu m g. Then it gathers speed at
a = (k F - mu m g) / (k M + m) until it goes at their speed v (Newton's second law), and from then
on they press with mu m g together. Those that are too few press with k F.
Measured: each load's speed after 1 s and its path, and the sum of the contacts' forces at the end,
for one to four robots.
"""

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.bodies import Box
from mars2d.core.materials import GRAVITY

SPEED = 0.2  # m/s
TEAMS, LANES = (1, 2, 3, 4), (2.4, 0.8, -0.8, -2.4)  # robots, m


def scenario(mu: float = 0.2, force: float = 7.0):
    pusher = Robot(diameter=0.2, mass=2.0, drive=Unicycle(max_force=force), color="#0072b2")
    load = Box(length=0.4, width=1.2, mass=10.0, ground_friction=mu, color="#e69f00")
    return Scenario(
        title="Many push one",
        robots=[
            pusher.at(-0.2999, y + 0.3 * (i - (team - 1) / 2))  # they touch the loads
            for team, y in zip(TEAMS, LANES, strict=True)
            for i in range(team)
        ],
        props=[load.at(0, y) for y in LANES],
        workspace=[(-1.5, -3.4), (-1.5, 3.4), (3.5, 3.4), (3.5, -3.4)],
        stop_time=12.0,
        animation=Animation(forces=True),
    )


def control(world):
    return np.outer([SPEED, 0.0], np.ones(len(world.robots)))


def checks(record):
    if any(robot.drive.no_load_speed for robot in record.scenario.robots):
        yield Prediction.silent("way and force", "with a no_load_speed the force falls with speed")
        return
    time, dt = record.time[-1], record.scenario.sampling_time
    last = record.frame(-1).contacts
    robot, robots = record.scenario.robots[0], len(record.scenario.robots)
    for i, (team, load) in enumerate(zip(TEAMS, record.scenario.props, strict=True)):
        force, friction = team * robot.push, load.ground_friction * load.mass * GRAVITY
        a = max(force - friction, 0.0) / (team * robot.mass + load.mass)
        start = min(SPEED / a, time) if a else time  # for so long it gathers speed, if it does
        gain, path = min(a, SPEED), a * start * (time - start / 2)
        press = friction if start < time else force - team * robot.mass * a
        x = record.prop_pose[:, 0, i]
        speed = np.interp(1.0, record.time, np.gradient(x, dt))
        pressed = last[last["b"] == robots + i]["normal_impulse"].sum() / dt
        yield Prediction(f"{team} pushing: speed after 1 s", gain, speed, 0.02 * gain + 1e-6, "m/s")
        yield Prediction(f"{team} pushing: path", path, x[-1] - x[0], 0.005 * path + 1e-4, "m")
        yield Prediction(f"{team} pushing: force", press, pressed, 0.01, "N")
