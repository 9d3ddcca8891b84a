"""A source for the tests of the window: robots on circles, computed beforehand."""

from __future__ import annotations

import numpy as np

from mars2d.addons import Theory
from mars2d.core.errors import LawError
from mars2d.record.contact import CONTACT
from mars2d.record.frame import Frame
from mars2d.record.message import LOST, MESSAGE
from mars2d.scenario.animation import Animation
from mars2d.scenario.robot import Robot
from mars2d.scenario.scenario import Scenario
from mars2d.sensors import Proximity

VIOLET = "#7b3294"


def predicted(scene, frame):
    scene.circle((0, 0), 1.0, fill=VIOLET)


def draw_mark(scene):
    scene.circle((-2, -2), 1.0, fill="#123456")


def circling_scenario(sampling_time=0.1, rows=100, robots=2, animation=None, **changes):
    robot = Robot(diameter=0.6, sensors=[Proximity(range=1.0)])
    return Scenario(
        title="Circling",
        robots=[robot.at(4.0 - 1.5 * i, 0, np.pi / 2) for i in range(robots)],
        sampling_time=sampling_time,
        stop_time=rows * sampling_time,
        animation=animation or Animation(),
        addons=[Theory(predicted)],
        **changes,
    )


class Circling:
    """Robots go round the origin at 0.5 rad/s; frame k is at k sampling times.

    pressed: something pushes robot 0 back all the time, and all drives slip. talking: robot 0 says
    something to robot 1 at each step, which is lost. marked: an add-on draws a disc.
    """

    def __init__(
        self,
        scenario=None,
        rows=100,
        message="the circle is closed",
        fails_at=None,
        pressed=False,
        talking=False,
        marked=False,
    ):
        self.scenario = scenario or circling_scenario(rows=rows)
        self.rows, self.message, self.fails_at = rows, message, fails_at
        self.pressed, self.talking, self.marked = pressed, talking, marked
        self.row = self.restarts = self.reached = 0
        angle = 0.5 * self.scenario.sampling_time * np.arange(rows + 1)[:, None]
        radius = np.array([robot.pose[0] for robot in self.scenario.robots])
        heading = angle + np.pi / 2 + 0 * radius
        self.path = np.stack([radius * np.cos(angle), radius * np.sin(angle), heading], axis=1)

    @property
    def frame(self):
        k = self.row
        readings = {"proximity": [(i, False) for i in range(len(self.scenario.robots))]}
        return Frame(
            scenario=self.scenario,
            time=k * self.scenario.sampling_time,
            iteration=k,
            pose=self.path[k],
            path=self.path[:k],
            readings=readings,
            over_message=self.message if self.over else "",
            contacts=self.touches(k, k),
            effort=np.full(len(self.scenario.robots), 1.0 if self.pressed and k else 0.0),
            contact_log=lambda: self.touches(1, k),
            messages=self.messages(k),
            draw_addons=draw_mark if self.marked else None,
        )

    def touches(self, first, last):
        """Return a contact of robot 0 a control step: an obstacle pushes it back with 5 N."""
        steps = np.arange(max(first, 1), last + 1 if self.pressed else 0)
        rows = np.zeros(len(steps), dtype=CONTACT)
        dt = self.scenario.sampling_time
        rows["time"], rows["b"], rows["normal"] = dt * (steps - 0.5), -1, (1.0, 0.0)
        rows["point"] = self.path[steps, :2, 0] + (0.3, 0.0)
        rows["began"] = steps == 1
        rows["impulse"] = rows["normal_impulse"] = 5.0 * dt
        return rows

    @property
    def contacts(self):
        return self.touches(1, self.reached)

    def messages(self, row):
        """Return the message of the step that led to a row."""
        rows = np.zeros(1 if self.talking and row else 0, dtype=MESSAGE)
        rows["time"], rows["arrival"] = self.scenario.sampling_time * (row - 1), np.nan
        rows["receiver"], rows["status"] = 1, LOST
        return rows

    @property
    def over(self):
        return self.row == self.rows

    def advance(self):
        if self.row == self.fails_at:
            raise LawError("the law of robot0 returned nan")
        self.row = min(self.row + 1, self.rows)
        self.reached = max(self.reached, self.row)

    @property
    def newest(self):
        return self.reached

    def go(self, row):
        self.row = min(max(row, 0), self.reached)

    def restart(self):
        self.reached = 0
        self.row = 0
        self.restarts += 1
