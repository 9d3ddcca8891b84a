"""VMAS: a vectorised simulator on torch for learning, run with one environment.

What it does not do in these scenes:

- What it is made for, thousands of environments in one step, perhaps on a GPU: one is run here.
- Contacts are springs without friction: robots and walls overlap by what the spring needs to hold
  the drive, centimetres at these speeds (see the README). A spring that is hard enough for a
  millimetre would need many substeps.
- Walls and boxes begin 6.7 mm before their lines.
- Nothing is recorded, and contacts are not reported. It counts in 32 bits.

What was set, and how: a `World` alone, without an `Environment` around it, so that no observations,
rewards or action spaces cost time. Robots are spheres with `DiffDrive` dynamics, drag 0; walls are
lines, boxes are boxes; `collision_force` (100 N/m), the mass (1 kg) and `substeps` (1) are the
defaults. The commands of all robots are set at each control step, `action.u`; the one of S1, which
lasts a second, is held for ten steps of its world, since its springs throw robots through walls at
steps over 0.14 s. "Is something near?" is `World.get_distance_from_point` for each thing. The 180
beams are its `Lidar`, measured for each robot at each step. Gradients are off. Torch has one
thread, as all others have: two were no quicker, and far slower when the machine did anything else.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from peer import Float, Peer, main
from vmas.simulator.core import Agent, Box, Landmark, Line, Sphere, World
from vmas.simulator.dynamics.diff_drive import DiffDrive
from vmas.simulator.sensors import Lidar

torch.set_grad_enabled(False)
torch.set_num_threads(1)

LONGEST = 0.1
"""The longest step of its world, seconds."""

MARGIN = 4 / 6e2
"""How far before their outlines lines and boxes begin, metres (`LINE_MIN_DIST`)."""


class Vmas(Peer):
    """A scene in VMAS."""

    def build(self) -> None:
        scene = self.scene
        self._hold = max(1, round(scene.sampling_time / LONGEST))
        dt = scene.sampling_time / self._hold
        self._world = World(batch_dim=1, device="cpu", dt=dt, drag=0.0, dim_c=0)
        self._agents = [self._agent(f"robot {i}") for i in range(len(scene.poses))]
        for agent, (x, y, theta) in zip(self._agents, scene.poses, strict=True):
            self._place(agent, (x, y), theta)
        self._add_outline(scene.walls)
        for box in scene.boxes:
            self._add_box(np.array(box))

    def _agent(self, name: str) -> Agent:
        scene = self.scene
        agent = Agent(
            name,
            shape=Sphere(radius=scene.radius),
            u_range=10.0,
            dynamics=DiffDrive(self._world),
            collide=True,
        )
        if scene.beams:
            agent.add_sensor(
                Lidar(
                    self._world,
                    angle_start=-np.pi,
                    angle_end=np.pi,
                    n_rays=scene.beams,
                    max_range=scene.range,
                )
            )
        self._world.add_agent(agent)
        return agent

    def _add_outline(self, corners: Sequence[tuple[float, float]]) -> None:
        ends = np.array(corners)
        for a, b in zip(ends, np.roll(ends, -1, axis=0), strict=True):
            self._add(Line(length=float(np.hypot(*(b - a)))), (a + b) / 2, b - a)

    def _add_box(self, corners: Float) -> None:
        along, across = corners[1] - corners[0], corners[2] - corners[1]
        shape = Box(length=float(np.hypot(*along)), width=float(np.hypot(*across)))
        self._add(shape, corners.mean(axis=0), along)

    def _add(self, shape: Any, center: Float, along: Float) -> None:
        name = f"landmark {len(self._world.landmarks)}"
        landmark = Landmark(name, shape=shape, collide=True, movable=False, rotatable=False)
        self._world.add_landmark(landmark)
        self._place(landmark, center, np.arctan2(along[1], along[0]))

    def _place(self, entity: Any, center: Any, angle: float) -> None:
        entity.set_pos(torch.tensor([list(center)], dtype=torch.float32), batch_index=None)
        entity.set_rot(torch.tensor([[float(angle)]]), batch_index=None)

    def move(self, command: Float) -> None:
        commands = torch.tensor(command.T, dtype=torch.float32)
        for agent, u in zip(self._agents, commands, strict=True):
            agent.action.u = u[None]
        for _ in range(self._hold):
            for agent in self._agents:
                agent.dynamics.check_and_process_action()
            self._world.step()

    def poses(self) -> Float:
        states = [torch.cat([a.state.pos[0], a.state.rot[0]]) for a in self._agents]
        return np.array(torch.stack(states), dtype=np.float64)

    def near(self) -> Sequence[bool]:
        within, distance = self.scene.proximity, self._world.get_distance_from_point
        return [
            any(
                float(distance(other, agent.state.pos)) < within - margin
                for others, margin in ((self._agents, 0.0), (self._world.landmarks, MARGIN))
                for other in others
                if other is not agent
            )
            for agent in self._agents
        ]

    def ranges(self) -> Sequence[Any]:
        return [agent.sensors[0].measure()[0].numpy() for agent in self._agents]


if __name__ == "__main__":
    main(Vmas)
