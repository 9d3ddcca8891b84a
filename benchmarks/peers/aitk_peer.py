"""aitk.robots: a simulator for classrooms in plain Python; robots stop at what they would hit.

What it does not do in these scenes:

- No contacts: a robot that would cross a line stays where it is for that step ("stalled"), and
  nobody is pushed. So nothing overlaps, and robots stop up to a step's way before what they meet.
- Robots are boxes, not discs: the squares with the discs' radius as half their side, which turn.
  What a ray sees of another robot is that square.
- It asks each robot against each line of all walls and robots: the time grows with the square of
  their number, and S4 is left out.
- It keeps a trace of the last ten seconds for drawing, which is turned off; nothing is recorded.

What was set, and how: lengths are its centimetres, y is turned over; the walls are lines of its
own kind, since its boundary lies on whole centimetres. `World.steps(1)` without
display, real time and progress. Targets of velocity are set as attributes, since `move` rounds them
to 0.1 cm and 0.1 rad/s; the ramps are made so short that they are reached at once. A robot's
velocity ahead counts per step there, its turning per second. "Is something near?" is not among its
sensors: the distance is worked out from the poses with numpy. The 180 beams are as many
`RangeSensor`s of width 0 a robot, which it casts at each step by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from aitk.robots import RangeSensor, Robot, World
from peer import Float, Geometry, Peer, main

CENTIMETRES = 100.0
"""Its unit of length in a metre."""


class Aitk(Peer):
    """A scene in aitk.robots."""

    ROUND = False

    def build(self) -> None:
        scene = self.scene
        size = int(np.ceil(scene.side * CENTIMETRES))
        self._world = World(size, size, quiet=True, seed=1, scale=1.0, boundary_wall=False)
        self._world._time_decimal_places = 6
        for outline in [scene.walls, *scene.boxes]:
            for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
                self._world.add_wall("grey", *self._there(*a), *self._there(*b), box=False)
        self._robots = [self._robot(*pose) for pose in scene.poses.tolist()]
        self._geometry = Geometry(scene)

    def _there(self, x: float, y: float) -> tuple[float, float]:
        """Return where a point is in its coordinates."""
        half = self.scene.side / 2
        return (float(x) + half) * CENTIMETRES, (half - float(y)) * CENTIMETRES

    def _robot(self, x: float, y: float, theta: float) -> Any:
        r = self.scene.radius * CENTIMETRES
        px, py = self._there(x, y)
        body = [["polygon", "red", [[r, r], [r, -r], [-r, -r], [-r, r]]]]
        robot = Robot(x=px, y=py, a=np.degrees(theta), do_trace=False, body=body)
        robot.vx_max = robot.va_max = 1e9
        beams, reach = self.scene.beams, self.scene.range * CENTIMETRES
        for k in range(beams):  # once it is in the world, each would update all
            angle = -180 + 360 * k / beams
            robot.add_device(RangeSensor(position=(0, 0), a=angle, max=reach, width=0))
        self._world.add_robot(robot)
        return robot

    def move(self, command: Float) -> None:
        step = self.scene.sampling_time
        ways = command[0] * (CENTIMETRES * step)
        for robot, way, omega in zip(self._robots, ways.tolist(), command[1].tolist(), strict=True):
            robot.tvx, robot.tva = way, omega
        self._world.steps(
            1, time_step=step, show=False, real_time=False, show_progress=False, quiet=True
        )

    def poses(self) -> Float:
        half = self.scene.side / 2
        rows = np.array([(robot.x, robot.y, robot.a) for robot in self._robots])
        return np.column_stack(
            [rows[:, 0] / CENTIMETRES - half, half - rows[:, 1] / CENTIMETRES, -rows[:, 2]]
        )

    def near(self) -> Sequence[bool]:
        points = self.poses()[:, :2]
        distance = np.minimum(self._geometry.off(points), self._geometry.apart(points))
        return list(distance < self.scene.proximity)

    def ranges(self) -> Sequence[Any]:
        return [np.array(robot.get_distances()) / CENTIMETRES for robot in self._robots]


if __name__ == "__main__":
    main(Aitk)
