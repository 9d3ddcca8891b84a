"""The names by which parts annotate a scenario, a frame, a robot and a world that they are given.

Sensors and add-ons lie below the scenario and the world, so these classes are known to checkers of
types alone. A base class whose methods users override takes `Any` instead: so an override may name
the class itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from mars2d.record.frame import Frame
    from mars2d.scenario.scenario import Scenario
    from mars2d.world.team_view import WorldView
    from mars2d.world.views import RobotView

    FrameLike: TypeAlias = Frame
    RobotLike: TypeAlias = RobotView
    ScenarioLike: TypeAlias = Scenario
    WorldLike: TypeAlias = WorldView
else:
    FrameLike = RobotLike = ScenarioLike = WorldLike = Any
