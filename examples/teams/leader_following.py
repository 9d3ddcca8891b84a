"""Leader following: robots keep their places around one leader (follow_the_leader is a chain).

Setting: distributed, sensors only: each sees range and bearing, and hears what the leader says.
Law: l-psi control. A point D ahead of each axle, at l from the leader and the bearing psi in its
frame, is to come to l_d and psi_d. With c from the heading to the line from the leader to it,
v + i D w = e^(ic) (k (l_d - l) + i l (k (psi_d - psi) + w1) + v1 e^(-i psi)), so l' = k (l_d - l).
The leader tells psi, v1 and w1. Source: Desai, Ostrowski and Kumar, IEEE TRA 17(6), 2001.
Prediction: a leader on a circle, R = v1 / w1, and its followers turn as one body: the points at
r^2 = l_d^2 + R^2 - 2 l_d R sin(psi_d), the axles at sqrt(r^2 - D^2), w1 times that quick.
"""

from cmath import phase, polar, rect
from functools import partial

from mars2d import Prediction, Robot, Scenario, Unicycle
from mars2d.addons import Communication, Theory
from mars2d.sensors import RangeBearing

D, GAIN, VIOLET = 0.1, 0.5, {"stroke": "#7b329460", "width": 6}  # m; k, 1/s
PLACES = [(0.8, 2.4), (0.8, -2.4), (1.4, 1.9), (1.4, -1.9)]  # l_d [m], psi_d [rad]
STARTS = [(0, 0, 0), (-1.1, 0.6, 0.3), (-1.2, -0.7, 0), (-0.3, 1.7, -0.2), (-0.8, -1.7, 0.3)]


def lead(robot, speed, turn):
    for each in robot.sense.range_bearing:
        robot.send([speed, turn, each.bearing], to=each.robot)
    return speed, turn


def follow(robot):
    leader = [each for each in robot.sense.range_bearing if each.robot == 0]
    if not leader or not robot.inbox:
        return 0, 0
    (to_far, to_psi), (v1, w1, bearing) = PLACES[robot.index - 1], robot.inbox[0].content
    back = bearing - leader[0].bearing  # its own heading in the leader's frame, turned round
    far, psi = polar(rect(leader[0].range, bearing) - rect(D, back))
    there = complex(GAIN * (to_far - far), far * (GAIN * phase(rect(1, to_psi - psi)) + w1))
    motion = -rect(1, psi - back) * (there + rect(v1, -psi))
    return motion.real, motion.imag / D


def scenario(speed: float = 0.3, radius: float = 2.5):
    eyes, drive, title = RangeBearing(range=50), Unicycle(max_linear_speed=5), "Leader following"
    body = Robot(drive=drive, sensors=[eyes], sees="sensors", controller=follow)
    leader, *others = [body.at(x, y - radius, theta) for x, y, theta in STARTS]
    team = [leader.replace(controller=partial(lead, speed=speed, turn=speed / radius)), *others]
    draw = Theory(lambda scene, _: [scene.circle((0, 0), r, **VIOLET) for r in orbits(radius)])
    addons = [Communication(), draw]
    return Scenario(title=title, robots=team, on_exit="ignore", stop_time=50, addons=addons)


def orbits(radius):
    return [(abs(rect(far, psi) - 1j * radius) ** 2 - D * D) ** 0.5 for far, psi in PLACES]


def checks(record):
    (v, w), (x, y) = record.command[-1, :, 0], record.pose[-1, :2]
    for i, r in enumerate(orbits(v / w) if w and record.scenario.stop_time > 20 else (), start=1):
        yield Prediction(f"radius of robot{i}", r, abs(complex(x[i], y[i])), 0.01, "m")
        yield Prediction(f"speed of robot{i}", abs(w) * r, record.command[-1, 0, i], 0.002, "m/s")
