"""Wall slide: how quickly a robot slides along a wall, and when the wall holds it.

Question: a robot drives against a wall at the speed v, at the angle a to it. The friction between
the two is mu. How quickly does it slide along the wall? When does it stick?
Prediction: a smooth wall stops only the part of the speed across it: v cos a is left. Now let it
slide at u. Its wheels slip at (v cos a - u) along the wall and v sin a across it, and push with
their force F in that direction. The wall bears all across it, but along it only mu times that
(Coulomb, 1785). So v cos a - u = mu v sin a, which gives u = v (cos a - mu sin a). Nothing is left
of it from tan a = 1 / mu on: there the robot sticks. This needs wheels that spin, pushing against
their slip whatever its direction (no grip), and a heading that the wall can't turn (max_torque).
Measured: each robot's speed over the last fifth, and with what the wall presses and drags at the
end. The last two have a friction 2 % below and 2 % above the one at which they stick.
"""

from math import atan, cos, pi, radians, sin, tan

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Map

SPEED, LANES = 0.3, (1.5, 0.5, -0.5, -1.5)  # m/s, m


def scenario(angle: float = 40.0, force: float = 5.0):
    a = radians(angle)
    drive = Unicycle(max_force=force, max_torque=1000)  # the wall can't turn it
    frictions = np.array([0.0, 0.5, 0.98, 1.02]) / tan(a)
    return Scenario(
        title="Wall slide",
        robots=[
            Robot(pose=(-1.5, y - 0.4, a), drive=drive, friction=mu, name=f"friction {mu:.3g}")
            for mu, y in zip(frictions.tolist(), LANES, strict=True)
        ],
        addons=[Map([[(-2, y), (3, y)] for y in LANES])],
        workspace=[(-2, -2.2), (-2, 1.8), (3, 1.8), (3, -2.2)],
        stop_time=15.0,
        animation=Animation(forces=True),
    )


def control(world):
    return np.outer([SPEED, 0.0], np.ones(len(world.robots)))


def checks(record):
    late, dt = len(record) * 4 // 5, record.scenario.sampling_time
    last = record.frame(-1).contacts
    for i, robot in enumerate(record.scenario.robots):
        a, mu, force, wheels = robot.pose[2], robot.friction, robot.push, robot.drive
        touch, turned = last[last["a"] == i], abs(record.pose[-1, 2, i] - a) > 1e-3
        if wheels.grip is not None or wheels.no_load_speed or turned or not len(touch):
            why = "it has to touch a wall that does not turn it, and push with F against any slip"
            yield Prediction.silent(robot.name, why)
            continue
        slide = SPEED * max(cos(a) - mu * sin(a), 0.0)
        lean = min(atan(mu), pi / 2 - a)  # of the force, from the wall's normal
        speed = np.diff(record.pose[late:, 0, i]).mean() / dt
        press, drag = touch["normal_impulse"].sum() / dt, -touch["tangential_impulse"].sum() / dt
        yield Prediction(f"{robot.name}: slides at", slide, speed, 0.001 * SPEED, "m/s")
        yield Prediction(f"{robot.name}: pressed with", force * cos(lean), press, 0.01, "N")
        yield Prediction(f"{robot.name}: dragged with", force * sin(lean), drag, 0.01, "N")
