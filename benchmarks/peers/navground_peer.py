"""navground: kinematic agents in C++, whose positions are shifted apart.

What it does not do in these scenes:

- Contacts have no forces, no friction and no masses: agents that overlap after a step are moved
  apart along the line between them, several centimetres of overlap remain (see the README), and
  nobody is pushed along or turned.
- It reports which pairs collided, not where, how hard or how long; nothing is recorded.
- It has no polygons: a box is four walls without an inside.
- It counts in 32 bits.

What was set, and how: `World.actuate` moves the agents by their `last_cmd` and shifts them apart;
`World.update`, which would ask behaviours in C++ for commands instead, is not called. The commands
of all agents are set at each control step ("each step"), as MARS2D does, or only at those where the
law changed them ("when changed"), which spares navground the making of Python objects and is its
best case. The kinematics are those of a differential drive without limits; the limits of MARS2D's
robots are not reached either. "Is something near?" is `World.compute_safety_violation`, exact, in
one call an agent. The 180 beams are a `LidarStateEstimation`, updated for each agent at each step,
and its ranges taken as an array.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from navground import core, sim
from peer import Float, Peer, main


class Navground(Peer):
    """A scene in navground."""

    SETTINGS: ClassVar[tuple[str, ...]] = ("each step", "when changed")

    def build(self) -> None:
        scene = self.scene
        self._world = sim.World()
        for outline in [scene.walls, *scene.boxes]:
            corners = np.array(outline)
            for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
                self._world.add_wall(sim.Wall(core.LineSegment(a, b)))
        self._agents = [self._agent(*pose) for pose in scene.poses.tolist()]
        self._world._prepare()  # what `run` does first: the index of who is where
        self._states = [core.SensingState() for _ in self._agents]

    def _agent(self, x: float, y: float, theta: float) -> Any:
        kinematics = core.kinematics.TwoWheelsDifferentialDriveKinematics(
            max_backward_speed=float("inf")
        )
        agent = sim.Agent(radius=self.scene.radius, kinematics=kinematics)
        agent.pose = core.Pose2((x, y), theta)
        beams = self.scene.beams
        if beams:
            lidar = sim.state_estimations.LidarStateEstimation(
                range=self.scene.range,
                start_angle=-np.pi,
                field_of_view=2 * np.pi * (1 - 1 / beams),
                resolution=beams,
            )
            agent.state_estimations = [lidar]
        self._world.add_agent(agent)
        return agent

    def move(self, command: Float) -> None:
        if self.setting == "each step" or not np.array_equal(command, self._set):
            twist, frame = core.Twist2, core.Frame.relative
            for agent, v, omega in zip(self._agents, *command.tolist(), strict=True):
                agent.last_cmd = twist((v, 0.0), omega, frame)
            self._set = command.copy()
        self._world.actuate(self.scene.sampling_time)

    _set: Float = np.empty((2, 0))

    def poses(self) -> Float:
        return np.array([(*agent.position, agent.orientation) for agent in self._agents], float)

    def near(self) -> Sequence[bool]:
        margin = self.scene.proximity - self.scene.radius
        violation = self._world.compute_safety_violation
        return [violation(agent, margin) > 0 for agent in self._agents]

    def ranges(self) -> Sequence[Any]:
        for agent, state in zip(self._agents, self._states, strict=True):
            agent.state_estimation.update(agent, self._world, state)
        return [state.get_buffer("range").data for state in self._states]


if __name__ == "__main__":
    main(Navground)
