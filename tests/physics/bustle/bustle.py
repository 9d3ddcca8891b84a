"""A bustle: all kinds of drives, props, joints and sensors, noise, messages, and many contacts.

The tests run it in many ways, which all have to give the same bits. With discs=True there are discs
and walls alone.
"""

import numpy as np

from mars2d import Car, Differential, Holonomic, Omni, Robot, Scenario, Unicycle, load_law
from mars2d.addons import Beacon, Communication, Floor, Game, Map
from mars2d.bodies.joints import Hinge, Rod, Rope, Spring
from mars2d.bodies.props import Ball, Bar, Box, Gate, Puck, Solid
from mars2d.geometry.shapes import Compound, Disc, Polygon
from mars2d.sensors import Beacon as BeaconSensor
from mars2d.sensors import Bumper, Ground, Imu, Odometry, Proximity, RangeBearing, RangeFinder

WEDGE = Polygon([(-0.15, -0.12), (0.2, 0), (-0.15, 0.12)])
ELL = Polygon([(0, 0), (0.3, 0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0, 0.3)])


def wander(robot):
    """Go round and round; what is heard, seen and drawn at random counts."""
    robot.send({"name": robot.name, "near": bool(robot.sense.proximity)})
    heard = sum(message.content.get("near", 0) for message in robot.inbox)
    return 1.0, robot.rng.normal() * (1 + robot.sense.proximity) + 0.1 * heard


def swerve(robot):
    """Wander, and turn meanwhile."""
    ahead, aside = wander(robot)
    return ahead, 0.3 * aside, aside


def slide(robot):
    """Drift about, the less the nearer somebody is; look at the lamp."""
    near = min((seen.range for seen in robot.sense.range_bearing), default=1.0)
    lamp = robot.sense.beacon["lamp"].bearing
    return min(near, 1.0) * robot.rng.normal(size=2) + 0.1 * np.nan_to_num(np.sin(lamp))


def scenario(hunter: str = "hunter.py", prey: str = "prey.py", seed: int = 0, discs: bool = False):
    jitter = np.random.default_rng(seed).uniform(-0.03, 0.03, (3, 8))
    eyes = [
        RangeFinder(beams=5, range=2, noise=0.02, dropouts=0.1),
        Bumper(),
        Odometry(drift=0.01),
    ]
    near = [Proximity(range=0.2), Imu(noise=(0.1, 0.1, 0.01)), Ground()]
    wanderer = Robot(controller=wander, sensors=near)
    slider = Robot(
        drive=Holonomic(noise=0.05),
        controller=slide,
        sensors=[
            RangeBearing(range=3, noise=0.05),
            BeaconSensor(names=["lamp"], noise=0.1, latency=0.2),
        ],
    )
    robots = [
        Robot(name="red", sensors=eyes, controller=load_law(hunter)),
        Robot(name="blue", drive=Holonomic(), controller=load_law(prey)),
        wanderer.replace(name="car", drive=Car(max_steering=0.6), shape=WEDGE),
        wanderer.replace(name="cart", drive=Differential(noise=0.1), diameter=0.4),
        wanderer.replace(name="late", drive=Unicycle(dead_time=0.15, max_acceleration=2.0)),
        wanderer.replace(
            name="heavy", mass=3.0, drive=Omni(noise=0.1, max_acceleration=2.0), controller=swerve
        ),
        slider.replace(name="drifter"),
        slider.replace(name="el", shape=ELL),
    ]
    places = np.array([[-0.9, -0.3, 0.2, 0.8] * 2, [-0.6] * 4 + [0.3] * 4, range(8)])
    robots = [robot.at(*place) for robot, place in zip(robots, (places + jitter).T, strict=True)]
    hook = robots[3].pose[:2]
    bustle = Scenario(
        title="A bustle",
        robots=robots,
        props=[
            Box(pose=(-0.9, -0.15, 0.3), length=0.25, width=0.2, mass=0.5),
            Puck(pose=(-0.4, -0.15, 0), velocity=(0.5, 0.3, 2)),
            Bar(pose=(0.2, -0.15, 0.2), length=0.4, mass=0.5),
            Ball(pose=(1.1, 0.0, 0), velocity=(-0.8, 0.4, 1)),
            Solid(Compound([Disc(0.2), ELL]), pose=(-0.9, 0.7, 0), mass=0.5),
            Gate(pose=(0.9, 0.9, 0), length=0.4),
        ],
        joints=[
            Rope(a="red", b="box0", length=0.9),
            Rod(a="late", b="heavy"),
            Spring(a="bar2", b="puck1"),
            Hinge(a="cart", anchor_b=hook),
        ],
        addons=[
            Map([[(-0.2, 0.9), (0.2, 0.9), (0.0, 1.2)]]),
            Communication(range=1.5, delay=0.1, loss=0.2),
            Beacon(name="lamp", path=[(1.2, 1.2), (-1.2, 1.2)], speed=0.5),
            Floor(patches=[([(-1, -1), (0, -1), (0, 1), (-1, 1)], "#d62728")]),
            Game({"hunter": ["red"], "prey": ["blue"]}, capture=0.001),
        ],
        workspace=[(-1.2, -0.85), (1.3, -0.85), (1.3, 1.3), (-1.2, 1.3)],
        on_exit="wall",
        command_delay=0.03,
        stop_time=1.6,
    )
    if not discs:
        return bustle
    alike = [robot.replace(shape=None) for robot in robots]
    return bustle.replace(title="A bustle of discs", robots=alike, props=[], joints=[])
