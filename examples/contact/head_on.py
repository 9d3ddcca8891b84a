"""Head-on: two robots push against each other, and the stronger one wins.

Question: two robots of mass m drive against each other at the speed v. What happens if their
drives have the same force? And if one has a little more?
Prediction: they meet without bouncing, and stop. Then what is left of the forces moves both at
a = (F1 - F2) / (2 m) (Newton's second law), and each presses with F1 - m a = F2 + m a, the mean of
both forces (his third law). Equals stay where they are. Of unequals the stronger one at last goes
at its own v: then it only has to bear the F2 of the other.
Measured: their speed 2 s after they met, the path of the middle between them, the contact's force.
"""

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle

SPEED, MET, LANES = 0.3, 1.0, (0.7, -0.7)  # m/s, s, m


def scenario(force: float = 5.0, extra: float = 0.5, mass: float = 5.0):
    robot = Robot(diameter=0.3, mass=mass, drive=Unicycle(max_force=force), color="#0072b2")
    strong = robot.replace(drive=Unicycle(max_force=force + extra), color="#d55e00")
    start = SPEED * MET + robot.radius
    return Scenario(
        title="Head-on",
        robots=[
            robot.at(-start, LANES[0]).replace(name="left"),
            robot.at(start, LANES[0], np.pi).replace(name="right"),
            strong.at(-start, LANES[1]).replace(name="strong"),
            robot.at(start, LANES[1], np.pi).replace(name="weak"),
        ],
        workspace=[(-1, -1.6), (-1, 1.6), (3.6, 1.6), (3.6, -1.6)],
        sampling_time=0.05,
        stop_time=12.0,
        animation=Animation(forces=True),
    )


def control(world):
    return np.outer([SPEED, 0.0], np.ones(len(world.robots)))


def checks(record):
    time, dt = record.time[-1] - MET, record.scenario.sampling_time
    then, drives = round((MET + 2.0) / dt), [robot.drive for robot in record.scenario.robots]
    if any(drive.no_load_speed or drive.force_limited for drive in drives):
        yield Prediction.silent("way and force", "these robots don't meet at their full speed")
        return
    if time < 2.0 + dt:
        yield Prediction.silent("way and force", "the run ends within 2 s after they met")
        return
    for i, lane in ((0, "equal"), (2, "unequal")):
        one, other = record.scenario.robots[i : i + 2]
        force, less = one.push, other.push
        a, mean = (force - less) / (one.mass + other.mass), (force + less) / 2
        start = min(SPEED / a, time) if a else time  # for so long they gather speed, if they do
        gain, path = min(2 * a, SPEED), a * start * (time - start / 2)
        middle = record.pose[:, 0, i : i + 2].mean(axis=1)
        speed = np.gradient(middle, dt)[then]
        touch = [record.frame(row).contacts for row in (then, -1)]
        press, at_end = (t["normal_impulse"][t["a"] == i].sum() / dt for t in touch)
        press_then, press_last = mean if start > 2 else less, less if start < time else mean
        yield Prediction(f"{lane}: path", path, middle[-1], 0.005 * path + 1e-8, "m")
        if abs(start - 2.0) > 2 * dt:  # else it reaches its speed just then
            yield Prediction(f"{lane}: speed after 2 s", gain, speed, 0.02 * gain + 1e-9, "m/s")
            yield Prediction(f"{lane}: force after 2 s", press_then, press, 0.01, "N")
        yield Prediction(f"{lane}: force", press_last, at_end, 0.01, "N")
