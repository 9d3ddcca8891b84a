"""Sumo: two robots, a ring, and a law a robot; who leaves the ring has lost.

Question: both robots are equally heavy (m) and strong (F). Head-on their forces cancel. How can one
win? Try laws of your own: mars2d run sumo --set red=my_law.py --seed 3
Prediction: two that meet at the relative speed s and do not bounce share their momentum, by a blow
m s / 2 (Huygens, 1669), to which the drives add at most F times how long they touch. So who runs up
pushes on, at half the speed, against one that stands and pushes back as hard. Who is caught with
its heading away has nothing to push back with.
Measured: the blow of each clash less m s / 2, over F times its duration, and who is in the ring.
"""

from math import atan2, hypot

import numpy as np

from mars2d import Addon, Animation, Robot, Scenario, Unicycle, load_law
from mars2d.prediction import Prediction

RING = 1.5  # m, its radius; the middle is (0, 0)


class Referee(Addon):
    """Draws the ring, and ends the bout when a robot's middle has left it, or time is over."""

    def on_step(self, world):
        inside = [robot.name for robot in world.robots if hypot(*robot.pose[:2]) < RING]
        if len(inside) == 1:
            world.stop(f"{inside[0]} wins after {world.time:.2f} s")
        elif not inside or world.time >= world.scenario.stop_time - 1e-9:
            world.stop("a draw")

    def on_draw(self, world, scene):
        scene.circle((0, 0), RING, fill="#f3e2c0", stroke="#8a5a2b", width=4)


def scenario(red: str = "sumo_players/pusher.py", blue: str = "sumo_players/flanker.py"):
    wrestler = Robot(diameter=0.3, drive=Unicycle(max_linear_speed=1), friction="rubber")
    square = [(-2, -2), (-2, 2), (2, 2), (2, -2)]
    return Scenario(
        title="Sumo",
        robots=[
            wrestler.replace(name="red", pose=(-0.8, 0, 0), controller=load_law(red), color="red"),
            wrestler.replace(name="blue", pose=(0.8, 0, np.pi), controller=load_law(blue), color="blue"),
        ],
        workspace=square,
        on_exit="ignore",
        sampling_time=0.02,
        stop_time=20.0,
        addons=[Referee()],
    )


def checks(record):
    red, blue = record.scenario.robots
    clashes = record.contacts[record.contacts["began"]]
    blow = red.mass / 2 * clashes["speed"]
    drives = red.drive.max_force * clashes["duration"]
    excess = np.abs(clashes["normal_impulse"] - blow) / drives
    yield Prediction("clashes", 0.5, excess.max(initial=0), 0.5)
    inside = np.hypot(*record.pose[-1, :2]) < RING
    yield Prediction("robots in the ring", 2 if "draw" in record.over_message else 1, inside.sum(), 0)
