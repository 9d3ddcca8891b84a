"""Parts of a user's own with annotations. Not run: mypy checks it, as it checks the package.

The hooks of a base class take Any, so an override may name the class or the Protocol.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mars2d import Addon, Sensor, World
from mars2d.core.interfaces import FrameLike, RobotLike, WorldLike
from mars2d.core.scene import Scene
from mars2d.record.frame import Frame
from mars2d.sensors import Surroundings
from mars2d.world.views import RobotView


class ByClass(Addon):
    def on_step(self, world: World) -> None:
        world.operator.let_go()

    def draw(self, scene: Scene, frame: Frame) -> None: ...


class ByProtocol(Addon):
    def on_step(self, world: WorldLike) -> None: ...

    def draw(self, scene: Scene, frame: FrameLike) -> None: ...


class Compass(Sensor):
    def read(self, robot: RobotView, world: Surroundings, rng: np.random.Generator) -> Any:
        return robot.pose[2]


class Clock(Sensor):
    def read(self, robot: RobotLike, world: Surroundings, rng: np.random.Generator) -> Any:
        return world.time


def control(world: World) -> Any: ...


def use(world: World) -> None:
    ByProtocol().on_step(world)
    ByProtocol().draw(Scene(), world.frame)
    World(world.scenario, control)
