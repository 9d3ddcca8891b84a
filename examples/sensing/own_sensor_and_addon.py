"""Your own sensor and add-on: lamps that robots seek, and a count of those found.

Setting: distributed, sensors only. Each robot carries two eyes that feel the light of all lamps,
I = sum of 1 / d^2, and turns towards the brighter side (Braitenberg's vehicle).
"""

import numpy as np

from mars2d import Addon, Robot, Scenario, Sensor
from mars2d.core.description import number
from mars2d.sensors import Quantity


class Eyes(Sensor):
    """The light felt at the left and the right front of the robot; noise is added by `noise`."""

    quantities = (Quantity("light", "1/m^2"),)

    def read(self, robot, world, rng):
        x, y, theta = self.placed(robot.pose)
        sides = theta + np.array([0.8, -0.8])
        dx, dy = LAMPS[:, :1] - x - 0.15 * np.cos(sides), LAMPS[:, 1:] - y - 0.15 * np.sin(sides)
        return (1 / (dx**2 + dy**2)).sum(axis=0)


class Lamps(Addon):
    """Draws the lamps, notes which were reached, and ends the experiment when all were."""

    reach: float = number(default=0.3, above=0, unit="m", doc="how near it must be come to")

    def on_start(self, world):
        self.found = np.zeros(len(LAMPS), dtype=bool)

    def on_step(self, world):
        x, y, _ = world.pose
        self.found |= (np.hypot(LAMPS[:, :1] - x, LAMPS[:, 1:] - y) < self.reach).any(axis=1)
        if self.found.all():
            world.stop(f"All {len(LAMPS)} lamps were found after {world.time:.1f} s")

    def on_draw(self, world, scene):
        for lamp, found in zip(LAMPS, self.found, strict=True):
            scene.circle(lamp, self.reach, fill="#ffd54a" if not found else None, stroke="#c79a00")


LAMPS = np.array([(3.0, 2.0), (-3.0, 2.5), (0.0, -3.0)])


def seek(robot):
    left, right = robot.sense.eyes
    return 0.4, 4.0 * (left - right) / (left + right)


seeker = Robot(sensors=[Eyes(noise=0.01)], controller=seek, sees="sensors")
scenario = Scenario(
    title="Light seekers",
    robots=[seeker.at(-4, -4, 1.0), seeker.at(4, -4, 2.0), seeker.at(0, 4, -2.5)],
    on_exit="wall",
    stop_time=120.0,
    addons=[Lamps()],
)
