"""Check an add-on: its hooks, its drawings, and whether its runs are repeatable."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from mars2d.addons.base import Addon
from mars2d.core import checks
from mars2d.core.deadline import Deadline
from mars2d.core.plane import rectangle
from mars2d.core.scene import Scene
from mars2d.core.usercode import called
from mars2d.scenario.scenario import Scenario
from mars2d.sensors.base import Sensor
from mars2d.testing.subject import KEEP, Subject, own_methods
from mars2d.testing.trial import ControlLaw, Placed, looker, small_world
from mars2d.world.world import World


def check_addon(
    addon: Addon,
    *,
    sensors: Sequence[Sensor] = (),
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> None:
    """Try an add-on; raise CheckError, which lists all that is wrong with it.

    The add-on runs for 50 control steps in a small world with robots that carry `sensors`, or in a
    `scenario`, whose team has the law `control`. The check reports exceptions in its hooks, random
    numbers from shared generators, and runs that differ with the same seed. deadline: the limit of
    each control step.

    >>> from mars2d.addons import Map
    >>> check_addon(Map([[(0, 0), (0, 1)]]))
    """
    checks.instance(Addon, "Map([...])")("check_addon(addon)", addon)
    subject = Subject("add-on", addon, "self.rng, the add-on's own stream", KEEP)
    if subject.check_part(addon, Addon):
        subject.check_runs(
            lambda: _placed(addon, sensors, scenario, control),
            deadline,
            small=scenario is None,
            looker=looker("on_sensed", partial(_look, addon, subject)),
            own=(f"add-on {addon.key}.",),
        )
    subject.conclude()


def _placed(
    addon: Addon, sensors: Sequence[Sensor], scenario: Scenario | None, control: ControlLaw | None
) -> Placed:
    """Return the scenario for the trial, and the law of its team.

    The robots of the small world are 3 m to the right of the add-on's obstacles.
    """
    if scenario is not None:
        others = [each for each in scenario.addons if each.key != addon.key]
        return scenario.replace(addons=[*others, addon]), control
    outlines = checks.outlines(f"{type(addon).__name__}.obstacles()", addon.obstacles())
    x = 3 + max((x for outline in outlines for x, _ in outline), default=-3.0)
    return small_world(sensors, [addon], x=x), None


def _look(addon: Addon, subject: Subject, world: World) -> None:
    """Let an add-on draw after its hooks of a control step."""
    area, own = world.workspace or rectangle(*world.bounds), own_methods(addon, Addon)
    live = getattr(world.addons, addon.key)
    for method in {"on_draw", "paint", "draw", "theory"}.intersection(own):
        # of the frozen one, as a replay does, but for the hook
        function = getattr(live if method == "on_draw" else addon, method)
        with called(f"{subject.name}.{method}", function):
            if method == "on_draw":
                function(world, Scene())
            else:
                function(Scene(), area if method == "paint" else world.frame)
