"""Model answer to the exercises of leader_following.

1. With R = 1.5 m the radii are 1.122, 2.122, 0.475 and 2.859 m, the speeds 0.224, 0.424, 0.095 and
   0.572 m/s: predicted and measured. The nearer to the centre, the slower.
2. To the right, R = -2.5 m: left and right change their parts. robot1 and robot3, on the left, go
   on the outer circles of 3.095 and 3.850 m, which were those of robot2 and robot4.
3. The error fades by exp(-k t), to 0.135 in 4 s. Measured is 0.130 between 2 and 6 s: what the
   leader says of the bearing is one sampling time old, and the bearing still changes.
4. The example's followers stop when they hear nothing. With 10 % of losses the radii hold, but they
   are a tenth too quick when they do hear, to catch up what they have lost; with 50 % they shake,
   robot4 is left behind, and no prediction holds. Those below go by what they heard last. Once all
   turn as one body, v1, w1 and the bearing stay the same: old news are as good as new ones, and
   places are held to a millimetre, with losses of 0.5 and of 0.8.
5. Who takes v1 = w1 = 0 rests where l' and psi' vanish: k (l_d - l) = v1 cos(psi) and
   k l (psi_d - psi) = l w1 - v1 sin(psi). For robot3 that is l = 1.646 m in place of 1.4 m; with
   k = 2/s it is 1.454 m. For robot4 it would be (1.83 m, -2.37), right behind robot2, which would
   hide it from the leader; then nothing holds.
"""

from cmath import phase, polar, rect
from math import cos, exp, sin

import numpy as np

from mars2d import Prediction
from mars2d.addons import Communication
from mars2d.scenario import open_module

base = open_module("leader_following")
UNTOLD = 3  # the robot for which the leader stands still


def follow(robot):
    """Do as in the example, but go by what was heard last."""
    if robot.inbox:
        robot.memory.heard = robot.inbox[0].content
    leader = [each for each in robot.sense.range_bearing if each.robot == 0]
    if not leader or not hasattr(robot.memory, "heard"):
        return 0, 0
    v1, w1, bearing = robot.memory.heard
    if robot.index == UNTOLD:
        v1 = w1 = 0.0
    back = bearing - leader[0].bearing  # its own heading in the leader's frame, turned round
    far, psi = polar(rect(leader[0].range, bearing) - rect(base.D, back))
    (to_far, to_psi), k = base.PLACES[robot.index - 1], base.GAIN
    there = complex(k * (to_far - far), far * (k * phase(rect(1, to_psi - psi)) + w1))
    motion = -rect(1, psi - back) * (there + rect(v1, -psi))
    return motion.real, motion.imag / base.D


def scenario(loss: float = 0.5):
    plain = base.scenario()
    leader, *others = plain.robots
    team = [leader, *(robot.replace(controller=follow) for robot in others)]
    return plain.replace(robots=team, addons=[Communication(loss=loss)], stop_time=100.0)


def rest(place, v1, w1):
    """Return (l, psi) at which the point stays that is to be at a place, and knows no v1, no w1.

    There l' = k (l_d - l) - v1 cos(psi) and l psi' = k l (psi_d - psi) - l w1 + v1 sin(psi) are 0.
    """
    from scipy.optimize import root

    def rates(at):
        far, psi = at
        closer, round_it = base.GAIN * (place - at)
        return closer - v1 * cos(psi), far * (round_it - w1) + v1 * sin(psi)

    return root(rates, place).x


def checks(record):
    v1, w1 = record.command[-1, :, 0]
    x, y, theta = record.pose.swapaxes(0, 1)  # (T, n)
    dx = x + base.D * np.cos(theta) - x[:, :1]  # from the leader to the points
    dy = y + base.D * np.sin(theta) - y[:, :1]
    far, psi = np.hypot(dx, dy), np.arctan2(dy[-1], dx[-1]) - theta[-1, 0]
    for i, place in enumerate(np.array(base.PLACES), start=1):
        to_far, to_psi = rest(place, v1, w1) if i == UNTOLD else place
        off = phase(rect(1, psi[i] - to_psi))
        yield Prediction(f"robot{i}: distance", to_far, far[-1, i], 0.005, "m")
        yield Prediction(f"robot{i}: off the bearing", 0.0, off, 0.01, "rad")
    a, b = np.searchsorted(record.time, [2, 6])
    left = np.abs(far[[a, b], 2] - base.PLACES[1][0])
    yield Prediction("robot2: error after 4 s", exp(-4 * base.GAIN), left[1] / left[0], 0.01)
