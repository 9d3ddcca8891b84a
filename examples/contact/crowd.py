"""A crowd at a door: fifty robots push through it at once.

Question: how quickly can they come through, and is the physics still sound in such a crush?
Prediction: discs of diameter d do not fit side by side into a doorway of width w < 2 d: one lies at
least g = sqrt(d^2 - (w - d)^2) behind the other (Pythagoras). At the speed v none comes out sooner
than g / v after another. That is only a bound: arches form before the door, and break, as robots
are unsure of their way. Bodies overlap by at most the 1 mm that the solver is allowed, so nobody
goes through a wall: who is in the hall has come by the doorway. (0.01 s: g, with such overlaps.)
"""

from math import atan2, sqrt

import numpy as np
from scipy.spatial.distance import pdist

from mars2d import Animation, Holonomic, Prediction, Robot, Scenario
from mars2d.addons import Map

LENGTH, HALL = 0.6, 2.5  # m, of the doorway from x = 0 on, and half the rooms' width


def control(world):
    """Head for the doorway, off by angles drawn again every half second, then go straight on."""
    while True:
        error = world.rng.normal(scale=1.2, size=len(world.robots))
        for _ in range(5):
            x, y, _ = world.pose
            if x.min() > LENGTH:
                world.stop(f"all are through after {world.time:.1f} s")
            ahead = [atan2(-b, LENGTH / 2 - a) for a, b in zip(x, y, strict=True)]
            heading = np.where(x < 0, ahead + error, 0)
            yield np.array([np.cos(heading), np.sin(heading)])  # drives slow it to their top speed


def scenario(door: float = 0.58, speed: float = 0.5):
    robot = Robot(friction=0.1, drive=Holonomic(max_linear_speed=speed))
    wall = [(0, door / 2), (0, HALL), (LENGTH, HALL), (LENGTH, door / 2)]
    blues = ["#0072b2", "#59a3cd", "#00507d"]
    return Scenario(
        title="A crowd at a door",
        robots=[robot.at(-0.5 - k // 10 * 0.45, (k % 10 - 4.5) * 0.45) for k in range(50)],
        workspace=[(-3, -HALL), (-3, HALL), (6, HALL), (6, -HALL)],
        on_exit="wall",
        stop_time=60.0,
        addons=[Map([wall, [(x, -y) for x, y in wall]])],
        animation=Animation(
            playback_speed=3, wake=False, show_initial_pose=False, base_colors=blues
        ),
    )


def checks(record):
    d, v = record.scenario.robots[0].diameter, record.scenario.robots[0].drive.max_linear_speed
    (x, y), half = record.pose.swapaxes(0, 1)[:2], record.scenario.obstacles[0][0][1]  # of the door
    steps = np.argwhere((x[:-1] <= LENGTH) & (x[1:] > LENGTH))  # in which some robot comes out
    out = [np.interp(LENGTH, x[k : k + 2, i], record.time[k : k + 2]) for k, i in steps]
    gap = sqrt(max(d**2 - (2 * half - d) ** 2, 0))
    if len(out) > 1:
        least = np.diff(sorted(out)).min()
        yield Prediction("one after another", gap / v, least, 0.01, "s", bound="at least")
    overlap = max(0.0, *(d - pdist(pose[:2].T).min() for pose in record.pose))
    allowed = record.scenario.max_overlap
    yield Prediction("deepest overlap", allowed, overlap, 1e-5, "m", bound="at most")
    by_door = sum(abs(y[k, i]) < half for k, i in steps)
    yield Prediction("robots in the hall", by_door, (x[-1] > LENGTH).sum(), 0)
