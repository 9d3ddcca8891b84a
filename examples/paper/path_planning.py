"""Path planning: a potential field leads three robots through a department, one of them astray.

Setting: centralised, full information: one law knows all poses, the map and the waypoints.
Law: F = F_att + F_rep. The next waypoint g attracts by k_p (g - q), no stronger than k_p d*; edges
of walls, and other robots, nearer than rho_0 to the rim repel by eta (1/rho - 1/rho_0) / rho^2
grad rho. A unicycle turns to F: v = min(v_max, |F|) max(0, cos a), w = k_w a, with
a = wrap(angle(F) - theta). Source:
Khatib, Int. Journal of Robotics Research 5(1), 1986. The paper gives no gains; ours (the defaults
of PotentialField: k_p = 1/s, d* = 0.5 m, eta = 0.01 m^4/s, rho_0 = 0.6 m) pass doors of 1 m.
Prediction: F = -grad U, so U falls until F = 0: at a waypoint, or before it in a local minimum. To
go with F in small steps finds which, Newton's method on F = 0 finds where; neither needs the run,
as long as robots do not meet.
Measured: who gets how far, and where robots stay. ``--set "detour=(22, 9.8)"`` frees the third.
"""

from math import atan2, cos, hypot

import numpy as np

from mars2d import Animation, Prediction, Robot, Scenario
from mars2d.addons import Map, PotentialField, Waypoints
from mars2d.geometry import wrap

SPEED, TURN, STILL = 0.5, 3.0, 1e-3  # v_max [m/s], k_w [1/s]; the force that is none [m/s]
STARTS = [(2.0, 2.5, 0.5), (27.0, 16.5, -2.0), (13.2, 18.5, -1.5)]
WAYS = [
    [(3.7, 5.0), (3.7, 7.3), (10.2, 7.3), (10.2, 9.9), (5.5, 10.4), (4.9, 13.9)],
    [(26.5, 9.7), (26.5, 7.3), (23.7, 7.3), (23.7, 5.0), (21.5, 2.0)],
    [(13.2, 7.3), (16.5, 7.3), (16.5, 9.7), (17.0, 13.0), (26.0, 14.5)],
]


def control(world):
    forces = [world.addons.potential_field.force(i) for i in range(len(world.robots))]
    return np.transpose([*map(follow, forces, world.pose[2])])


def follow(force, theta):
    speed, turn = hypot(*force), float(wrap(atan2(force[1], force[0]) - theta))
    return (min(SPEED, speed) * max(0, cos(turn)), TURN * turn) if speed > STILL else (0, 0)


def scenario(detour=None, map="maps/department.geojson", layers="WALLS, FURNITURE"):  # noqa: A002
    last = WAYS[2] if detour is None else [*WAYS[2][:-1], detour, WAYS[2][-1]]
    return Scenario(
        title="Path planning",
        robots=[Robot(pose=start, diameter=0.4) for start in STARTS],
        workspace=[(0, 0), (0, 20), (30, 20), (30, 0)],
        stop_time=120.0,
        addons=[Map.from_file(map, layers=layers), Waypoints([*WAYS[:2], last]), PotentialField()],
        animation=Animation(playback_speed=5),
    )


def checks(record):
    _, ways, field = record.scenario.addons
    reached, pose, command = ways.of(record.frame(-1)), record.pose[-1], record.command[-1]
    far = field.reach + 2 * max(robot.radius for robot in record.scenario.robots)
    for i, (count, end) in enumerate(field.plan(record.scenario)):
        name, stands = f"waypoints that robot{i} reaches", not command[:, i].any()
        others = np.delete(record.pose[:, :2], i, axis=2) - record.pose[:, :2, [i]]
        if np.hypot(*others.swapaxes(0, 1)).min(initial=far) < far:
            yield Prediction.silent(name, "another robot came so near that they repel each other")
            continue
        if stands or record.scenario.stop_time >= 120:
            yield Prediction(name, count, reached[i], 0)
        for k in (0, 1) if stands and count < len(ways.routes[i]) else ():
            yield Prediction(f"robot{i} is stuck at {'xy'[k]}", end[k], pose[k, i], 0.01, "m")
    yield Prediction("contacts", 0, len(record.contacts), 0)
