"""Sumo: two robots, a ring, and a law each; the one that leaves the ring loses.

Question: both robots are equally heavy (m) and strong (F). Head-on their forces cancel. How can one
win? Try laws of your own: mars2d run sumo --set red=my_law.py --seed 3
Prediction: two that meet at the relative speed s pass on the impulse (1 + e) m s / 2 (Huygens,
1669), and their drives at most F t more or less, in the time t that they touch. So the quicker one
shoves the other along, and who is caught looking away has no force to resist.
Measured: the impulse of the first clash, in its control step.
"""

from math import pi

from mars2d import Animation, Prediction, Robot, Scenario, Unicycle, load_law
from mars2d.addons import Ring

RING = 1.5  # m, its radius; its middle is (0, 0)


def scenario(red: str = "players/pusher.py", blue: str = "players/dodger.py"):
    robot = Robot(drive=Unicycle(max_linear_speed=1), friction="rubber")
    return Scenario(
        title="Sumo",
        robots=[
            robot.replace(name="red", color="red", controller=load_law(red)).at(-0.8, 0, 0),
            robot.replace(name="blue", color="blue", controller=load_law(blue)).at(0.8, 0, pi),
        ],
        workspace=[(-2, -2), (2, -2), (2, 2), (-2, 2)],
        on_exit="ignore",
        sampling_time=0.02,
        stop_time=20.0,
        addons=[Ring({"red": ["red"], "blue": ["blue"]}, radius=RING)],
        animation=Animation(playback_speed=0.3, show_initial_pose=False, forces=True),
    )


def checks(record):
    one, other = record.scenario.robots
    bounce = 1 + record.scenario.restitution_between(0, 1)
    for clash in record.contacts[:1]:
        impulse = bounce * clash["speed"] / (1 / one.mass + 1 / other.mass)
        drives = (one.push + other.push) / 2 * record.scenario.sampling_time
        yield Prediction("first clash: impulse", impulse, clash["normal_impulse"], drives, "N s")
