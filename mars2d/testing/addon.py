"""Check an add-on: its hooks, obstacles, beacons and seeds, and that drawing changes nothing."""

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
from mars2d.testing.finding import Finding
from mars2d.testing.subject import KEEP, Subject, own_methods
from mars2d.testing.trial import (
    ControlLaw,
    Placed,
    contents,
    looker,
    small_world,
)
from mars2d.world.world import World


def check_addon(
    addon: Addon,
    *,
    sensors: Sequence[Sensor] = (),
    scenario: Scenario | None = None,
    control: ControlLaw | None = None,
    deadline: Deadline | None = None,
) -> tuple[Finding, ...]:
    """Try an add-on; return hints, and raise CheckError, which lists all that is wrong with it.

    The add-on runs for 50 control steps in a small world with robots that carry `sensors`, or in a
    `scenario`, whose team has the law `control`. The check reports exceptions in its hooks, random
    numbers from shared generators, drawing that changes the run, and runs that differ with the same
    seed. deadline: the limit of each control step.

    >>> from mars2d.addons import Map
    >>> check_addon(Map([[(0, 0), (0, 1)]]))
    ()
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
            besides=addon.key,
        )
    return subject.hints()


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
    """Check an add-on's obstacles, beacons and drawings after its hooks of a control step."""
    key, name, own = addon.key, subject.name, own_methods(addon, Addon)
    live = getattr(world.addons, key)
    if contents(live.obstacles()) != contents(addon.obstacles()):
        subject.wrong(
            f"{name}.obstacles() returns other outlines than before (at {world.time:g} s): they "
            "are put into the world once; what moves is a prop or a robot"
        )
    with called(f"{name}.beacons", live.beacons):
        for beacon, point in live.beacons().items():
            checks.point(f"{name}.beacons()[{beacon!r}]", point)
    if "on_draw" in own:
        scene = Scene()
        with subject.looking(live, "on_draw", world, key):
            live.on_draw(world, scene)
        subject.check_finite(scene, "on_draw")
    area = world.workspace or rectangle(*world.bounds)
    for method in {"paint", "draw", "theory"}.intersection(own):
        scene, function = Scene(), getattr(addon, method)  # of the frozen one, as a replay does
        with called(f"{name}.{method}", function):
            function(scene, area if method == "paint" else world.frame)
        subject.check_finite(scene, method)
