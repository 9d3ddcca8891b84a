"""ir-sim: kinematic robots in Python on shapely, which are shifted apart, or stop.

What it does not do in these scenes:

- "contact" is position-based dynamics: robots that overlap after a step are shifted apart by mass,
  in up to 32 sweeps a step. A robot has no friction with what it touches (what is driven always
  slides), and no contact turns it. Free motion is explicit Euler: straight on for a step, then the
  turn.
- "stop": a robot that touches anything stands still from then on, for ever. So fewer and fewer
  robots move, and it gets quicker the longer it runs; its scenes start again every 100 steps.
- Paths are recorded (`trajectory`); commands, readings and contacts are not. Contacts of the last
  step can be read.

What was set, and how: a world file with the walls as a line string, the boxes as polygons and the
robots as discs with differential drives; `headless=True`, and logs off. `EnvBase.step` gets the
commands of all robots at each control step. Limits of speed are above what the law asks for; in
"contact" its wheels' grip lets a robot reach 0.3 m/s in two steps of 0.05 s. "Is something near?"
is asked of shapely about ir-sim's geometries in one call a robot, since its field of view looks at
centres. The 180 beams are its `lidar2d`, which it casts at each step by itself.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, ClassVar

import irsim
import numpy as np
import shapely
from peer import Float, Peer, main


class IrSim(Peer):
    """A scene in ir-sim."""

    SETTINGS: ClassVar[tuple[str, ...]] = ("contact", "stop")

    def build(self) -> None:
        if self.setting == "stop":
            self.episode = 100
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "world.yaml"
            file.write_text(json.dumps(self._world()), encoding="utf-8")
            self._env = irsim.make(str(file), headless=True, log_level="CRITICAL")
        self._robots = self._env.robot_list
        self._ids = [robot.id for robot in self._robots]
        self._others = [
            [other for other in self._env.objects if other is not robot] for robot in self._robots
        ]

    def _world(self) -> dict[str, Any]:
        scene = self.scene
        half = scene.side / 2
        world = {
            "width": scene.side,
            "height": scene.side,
            "offset": [-half, -half],
            "step_time": scene.sampling_time,
            "collision_mode": self.setting,
        }
        robot: dict[str, Any] = {
            "kinematics": {"name": "diff"},
            "shape": {"name": "circle", "radius": scene.radius},
            "vel_min": [-1.0, -6.0],
            "vel_max": [1.0, 6.0],
        }
        if scene.beams:
            step = 2 * np.pi / scene.beams
            lidar = {
                "name": "lidar2d",
                "range_max": scene.range,
                "angle_range": float(2 * np.pi - step),
                "number": scene.beams,
                "offset": [0.0, 0.0, float(-step / 2)],  # so that the first looks straight back
            }
            robot["sensors"] = [lidar]
        walls = [[float(x), float(y)] for x, y in [*scene.walls, scene.walls[0]]]
        outlines = [{"name": "linestring", "vertices": walls}]
        outlines += [{"name": "polygon", "vertices": [list(c) for c in b]} for b in scene.boxes]
        return {
            "world": world,
            "robot": [{**robot, "state": pose} for pose in scene.poses.tolist()],
            "obstacle": [{"shape": shape, "state": [0.0, 0.0, 0.0]} for shape in outlines],
        }

    def move(self, command: Float) -> None:
        self._env.step(list(command.T[..., None]), self._ids)

    def poses(self) -> Float:
        return np.array([robot.state[:3, 0] for robot in self._robots])

    def near(self) -> Sequence[bool]:
        within = self.scene.proximity
        return [
            bool(
                shapely.dwithin(
                    shapely.Point(robot.state[:2, 0]), [other.geometry for other in others], within
                ).any()
            )
            for robot, others in zip(self._robots, self._others, strict=True)
        ]

    def ranges(self) -> Sequence[Any]:
        return [robot.lidar.range_data for robot in self._robots]


if __name__ == "__main__":
    main(IrSim)
