"""Tug of war: a rope joins two teams, and the stronger one wins.

Question: two robots pull against a single strong one. Who wins, and when? Which box can one tow?
Prediction: on a taut rope all gather speed together, at a = (sum of forces) / (sum of masses)
(Newton's second law); a team has drawn the middle over its line, d away, after sqrt(2 d / |a|). The
floor holds a box of mass m with up to mu m g (Coulomb, 1785): a robot of mass M and force F tows it
only if F > mu m g, and then with a = (F - mu m g) / (M + m), by a t^2 / 2.
Measured: when the game ends, and the ways of the boxes; one is held with 0.98 F, one with 1.02 F.
"""

from math import inf, pi, sqrt

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.bodies import Box, Rope
from mars2d.core.materials import GRAVITY

LINE = 1.0  # m, from the middle to a team's line
ORANGE, BLUE, GREEN = "#d55e00", "#0072b2", "#009e73"


def control(world):
    middle = world.pose[0, 1:3].mean()
    if abs(middle) >= LINE:
        world.stop(f"{'red' if middle < 0 else 'blue'} wins after {world.time:g} s")
    return [[2.0] * 5, [0.0] * 5]  # ahead, as fast as they can


def scenario(red: float = 3.0, blue: float = 5.9, tow: float = 5.0):
    def robot(force, color):
        return Robot(drive=Unicycle(max_force=force, max_linear_speed=2), color=color)

    left, right, tug = robot(red, ORANGE), robot(blue, BLUE), robot(tow, GREEN)
    light, heavy = (Box(mass=1, ground_friction=k * tow / GRAVITY) for k in (0.98, 1.02))
    ties = [("robot0", "robot1"), ("robot1", "robot2"), ("robot3", "box0"), ("robot4", "box1")]
    return Scenario(
        title="Tug of war",
        robots=[
            *(left.at(-1, 1, pi), left.at(-0.5, 1, pi), right.at(0.5, 1)),
            *(tug.at(-1.5, 0), tug.at(-1.5, -1)),
        ],
        props=[light.at(-2.5, 0), heavy.at(-2.5, -1)],
        joints=[Rope(a=a, b=b) for a, b in ties],
        workspace=[(-3.5, -1.5), (-3.5, 1.5), (3, 1.5), (3, -1.5)],
        sampling_time=0.02,
        stop_time=12.0,
        animation=Animation(playback_speed=0.6),
    )


def checks(record):
    (back, front, rival, *tugs), end = record.scenario.robots, record.time[-1]
    if any(robot.drive.no_load_speed for robot in record.scenario.robots):
        yield Prediction.silent("end and ways", "with a no_load_speed the force falls with speed")
        return
    force, dt = rival.push - back.push - front.push, record.scenario.sampling_time
    soon = sqrt(2 * LINE * (back.mass + front.mass + rival.mass) / abs(force)) if force else inf
    yield Prediction("end of the game", min(soon, record.scenario.stop_time), end, dt + 0.02, "s")
    for tug, box, path in zip(tugs, record.scenario.props, record.prop_pose[:, 0].T, strict=True):
        force = max(tug.push - box.ground_friction * box.mass * GRAVITY, 0)
        way = force / (tug.mass + box.mass) * end**2 / 2
        yield Prediction(f"way of {box.name}", way, path[-1] - path[0], 0.01, "m")
