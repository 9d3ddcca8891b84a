"""Material pairs: friction between materials, and why starting is harder than sliding on.

Question: a robot drives at the speed v against a wall, at the angle a to it. How quickly does it
slide along? When does it stick, and does it matter whether it slid before?
Prediction: the wall drags with mu times what it bears (Coulomb, 1785), so a robot slides at
v (cos a - mu sin a), as in wall_slide, up to tan a = 1 / mu; one that rests sticks from 1 / mus on,
with static friction mus. Textbooks state both for pairs of materials (R. A. Serway, J. W. Jewett,
Physics for Scientists and Engineers, table 5.1). Others get the product.
Measured: speeds, and drag over press. The first robot starts at the wall, the second comes to it.
"""

from math import cos, radians, sin, tan

import numpy as np

from mars2d import Animation, MaterialPair, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Map

SPEED, LANES, APART = 0.3, (2, 1, 0, -1, -2), (0, 0.15, 0, 0, 0)  # m/s, m, m from the wall
ROBOTS = ("steel", "steel", "rubber", "ice", "wood")
WALLS = ("steel", "steel", "concrete", "ice", "ice")


def scenario(angle: float = 57.0, force: float = 5.0):
    robot = Robot(drive=Unicycle(max_force=force, max_torque=1000))
    starts = [(-1.5, y - 0.1499 - off, radians(angle)) for y, off in zip(LANES, APART, strict=True)]
    walls = [Map([[(-2, y), (3, y)]], name=f"wall{2 - y}", friction=WALLS[2 - y]) for y in LANES]
    return Scenario(
        title="Material pairs",
        robots=[robot.replace(pose=p, friction=of) for p, of in zip(starts, ROBOTS, strict=True)],
        addons=walls,
        material_pairs=[
            MaterialPair("steel", "steel", friction=0.57, static_friction=0.74),
            MaterialPair("rubber", "concrete", friction=0.8, static_friction=1.0),
            MaterialPair("ice", "ice", friction=0.03, static_friction=0.1),
        ],
        workspace=[(-2, -2.6), (-2, 2.2), (3, 2.2), (3, -2.6)],
        stop_time=12.0,
        animation=Animation(forces=True),
    )


def control(world):
    return np.outer([SPEED, 0.0], np.ones(len(world.robots)))


def checks(record):
    last, x = record.frame(-1).contacts, record.pose[len(record) // 2 :, 0]
    table = {pair.names: pair for pair in record.scenario.material_pairs}
    for i, robot in enumerate(record.scenario.robots):
        if abs(record.pose[-1, 2, i] - robot.pose[2]) > 1e-3:
            yield Prediction.silent(f"{ROBOTS[i]} on {WALLS[i]}", "the wall turns the robot")
            continue
        a, pair = robot.pose[2], table.get(frozenset([ROBOTS[i], WALLS[i]]))
        mu = pair.friction if pair else robot.friction * record.scenario.addons[i].friction
        sticks = tan(a) >= 1 / (pair.static_friction if pair and not APART[i] else mu)
        slide, drag = (0.0, 1 / tan(a)) if sticks else (SPEED * (cos(a) - mu * sin(a)), mu)
        touch = last[last["a"] == i]
        ratio = -touch["tangential_impulse"].sum() / max(touch["normal_impulse"].sum(), 1e-9)
        name = f"{ROBOTS[i]} on {WALLS[i]}{', coming' if APART[i] else ''}"
        speed = np.diff(x[:, i]).mean() / record.scenario.sampling_time
        yield Prediction(f"{name}: slides at", slide, speed, 0.002 * SPEED, "m/s")
        yield Prediction(f"{name}: drag / press", drag, ratio, 0.002)
